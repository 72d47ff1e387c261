// What options may be: each mistake is an error that names the option.

import {DomelightError} from './errors.js';

/// Names that an options object may have; any other is a mistake, and is named.
export function check(options, ...names) {
    if (options === undefined || options === null) return {};
    if (typeof options !== 'object') throw new DomelightError('The options are not an object');
    for (const name of Object.keys(options))
        if (!names.includes(name)) throw new DomelightError('is not an option', name, `Options: ${names.join(', ')}.`);
    return options;
}

export function number(value, field) {
    if (value === undefined) return undefined;
    if (typeof value !== 'number') throw new DomelightError(`is ${typeof value === 'object' ? 'an object' : JSON.stringify(value)}, not a number`, field);
    return value;
}

export function integer(value, field) {
    if (value !== undefined && !(Number.isInteger(value) && Math.abs(value) < 2 ** 31)) throw new DomelightError(`${value} is not a whole number`, field);
    return value;
}

export function integer64(value, field) {
    if (value !== undefined && !Number.isSafeInteger(value)) throw new DomelightError(`${value} is not a whole number`, field);
    return value;
}

/// An error for the encodings that the module does not have. `uastc`: it has this one.
export function checkEncoding(encoding, uastc) {
    if (/^astc/.test(encoding ?? '') || (/^uastc/.test(encoding ?? '') && !uastc))
        throw new DomelightError(`${encoding} is not in the WebAssembly module`, 'encoding', 'The command line encodes it; here use bc6h or rgba16f.');
}
