// The decoders that three.js' loaders of models bring along, for a page that may not make code of text (its content security policy has no unsafe-eval).

import fs from 'node:fs';
import type {Plugin} from 'vite';

/// Of Draco's six files the app needs the two for glTF; the others are left out of the build.
const unused = /new URL\( '\.\.\/libs\/draco\/(?:draco_decoder\.wasm|draco_wasm_wrapper\.js|draco_decoder\.js|gltf\/draco_decoder\.js)', import\.meta\.url \)/g;

const transcoderUrl = "new URL( '../libs/basis/basis_transcoder.js', import.meta.url ).toString()";

// Emscripten's bindings put functions together as text. These do the same without: they are what its option DYNAMIC_EXECUTION=0 makes.
const invoker = 'newFunc(Function,args)(...closureArgs)';
const plainInvoker = `function(...given) {
    var destructors = needsDestructorStack ? [] : null, self = isClassMethodFunc ? argTypes[1].toWireType(destructors, this) : undefined;
    var wired = argTypes.slice(2).map((type, i) => type.toWireType(destructors, given[i]));
    var result = cppInvokerFunc(cppTargetFunc, ...(isClassMethodFunc ? [self] : []), ...wired);
    if (needsDestructorStack) runDestructors(destructors);
    else for (var i = isClassMethodFunc ? 1 : 2; i < argTypes.length; ++i)
        if (argTypes[i].destructorFunction !== null) argTypes[i].destructorFunction(i === 1 ? self : wired[i - 2]);
    if (returns) return argTypes[0].fromWireType(result);
}`;
const methodCaller = 'newFunc(Function,params)(...args)';
const plainMethodCaller = `function(obj, func, destructorsRef, args) {
    var offset = 0, given = types.map(type => { var value = type.readValueFromPointer(args + offset); offset += type.argPackAdvance; return value; });
    var result = kind === 1 ? Reflect.construct(func, given) : func.call(obj, ...given);
    if (!retType.isVoid) return emval_returnValue(retType, destructorsRef, result);
}`;

function replaced(text: string, from: string, to: string, file: string): string {
    if (text.split(from).length !== 2) throw new Error(`${file} has another text than expected where "${from}" should be`);
    return text.replace(from, () => to);
}

/// Writes Basis Universal's transcoder as the page may run it.
export function makeBasisTranscoder(source: string, file: string): void {
    const text = replaced(replaced(fs.readFileSync(source, 'utf8'), invoker, plainInvoker, source), methodCaller, plainMethodCaller, source);
    // createJsInvoker() made the text that is not needed any more.
    fs.writeFileSync(file, replaced(text, 'let[args,invokerFnBody]=createJsInvoker(argTypes,isClassMethodFunc,returns,isAsync);args.push(invokerFnBody);', '', source));
}

export function fewerDecoders(): Plugin {
    return {
        name: 'fewer-decoders',
        enforce: 'pre',
        transform(code, id) {
            if (/DRACOLoader\.js$/.test(id)) return code.replace(unused, "''").replaceAll("''.toString()", "''");
            if (/KTX2Loader\.js$/.test(id)) return `import transcoder from 'basis_transcoder.js?url';\n${replaced(code, transcoderUrl, 'transcoder', id)}`;
            return undefined;
        },
    };
}
