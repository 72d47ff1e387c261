// The text of the code that runs, beside its equation.

import {element} from '../../src/ui/controls';

/// A function or struct of a text, with the comment above it. GLSL and TypeScript close it by a brace at the start of a line.
export function excerpt(text: string, name: string): string {
    const lines = text.split('\n');
    const head = lines.findIndex(line => new RegExp(`^[A-Za-z][^;(]*\\b${name}\\b`).test(line) && !line.endsWith(';'));
    if (head < 0) throw new Error(`there is no ${name} in this text`);
    let from = head;
    while (from > 0 && lines[from - 1]!.startsWith('//')) --from;
    const to = lines.findIndex((line, k) => k > head && /^}/.test(line));
    return lines.slice(from, to + 1).join('\n');
}

/// A line whose rest, where it is too long, is indented more than its beginning.
function lineOf(text: string): HTMLElement {
    const line = element('span', {}, `${text}\n`), indent = text.search(/\S|$/) + 4;
    line.style.paddingLeft = `${indent}ch`;
    line.style.textIndent = `-${indent}ch`;
    return line;
}

/// Shows functions of a file in the element that has this id.
export function showCode(id: string, file: string, text: string, ...names: string[]): void {
    const code = element('code', {}, ...names.map(name => excerpt(text, name)).join('\n\n').split('\n').map(lineOf));
    const pre = element('pre', {tabIndex: 0, role: 'region', ariaLabel: `Code of ${file}: ${names.join(', ')}`}, code);
    document.getElementById(id)!.append(pre, element('figcaption', {}, 'This text is what runs here: ', element('code', {}, file)));
}
