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
        void filesOf(event.dataTransfer).then(files => files.length && dropped(files));
    });
}

/// What was dropped, with the files of the folders among it.
async function filesOf(transfer: DataTransfer | null): Promise<File[]> {
    const entries = [...(transfer?.items ?? [])].map(item => item.webkitGetAsEntry?.() ?? null);
    if (!entries.some(entry => entry?.isDirectory)) return [...(transfer?.files ?? [])];
    return (await Promise.all(entries.map(entry => (entry ? filesBelow(entry) : [])))).flat();
}
async function filesBelow(entry: FileSystemEntry): Promise<File[]> {
    if (entry.isFile) return [await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject))];
    const reader = (entry as FileSystemDirectoryEntry).createReader(), found: FileSystemEntry[] = [];
    // A reader gives some entries at a time, and none at the end.
    for (;;) {
        const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
        if (some.length === 0) break;
        found.push(...some);
    }
    return (await Promise.all(found.map(filesBelow))).flat();
}
