// Files, dropped anywhere or chosen.

import {element} from './controls';

/// A hidden input of files; the function that opens its dialog.
export function chooser(label: string, endings: string[], chosen: (files: File[]) => void): () => void {
    const input = element('input', {type: 'file', multiple: true, accept: endings.join(), hidden: true, ariaLabel: label});
    input.addEventListener('change', () => {
        chosen([...(input.files ?? [])]);
        input.value = '';
    });
    document.body.append(input);
    return () => input.click();
}

/// Shows `sign` while files are dragged over the page.
export function bindDrops(sign: HTMLElement, dropped: (files: File[]) => void): void {
    let depth = 0;
    addEventListener('dragenter', () => (sign.hidden = ++depth === 0));
    addEventListener('dragleave', () => (sign.hidden = --depth <= 0));
    addEventListener('dragover', event => event.preventDefault());
    addEventListener('drop', event => {
        event.preventDefault();
        depth = 0;
        sign.hidden = true;
        const files = [...(event.dataTransfer?.files ?? [])];
        if (files.length) dropped(files);
    });
}
