// Several files as one, in the ZIP format (PKWARE's APPNOTE 6.3.3), not compressed: most of them are already.

export interface NamedBytes {
    name: string;
    data: Uint8Array<ArrayBuffer>;
}

const crcTable = Uint32Array.from({length: 256}, (_, n) => {
    for (let k = 0; k < 8; ++k) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n;
});
/// CRC-32 of ISO 3309.
function crc32(bytes: Uint8Array): number {
    let crc = 0xffffffff;
    for (let k = 0; k < bytes.length; ++k) crc = crcTable[(crc ^ bytes[k]!) & 255]! ^ (crc >>> 8);
    return ~crc >>> 0;
}

/// 1 January 1980, the first day of the format: the same files give the same bytes.
const k_date = 0x21;
const k_utf8 = 0x800;

type Field = readonly [width: 2 | 4, value: number];

function packed(fields: readonly Field[]): Uint8Array<ArrayBuffer> {
    const view = new DataView(new ArrayBuffer(fields.reduce((sum, [width]) => sum + width, 0)));
    let at = 0;
    for (const [width, value] of fields) {
        if (width === 2) view.setUint16(at, value, true);
        else view.setUint32(at, value, true);
        at += width;
    }
    return new Uint8Array(view.buffer);
}

/// The parts of the archive, one after the other. Less than 4 GB together.
export function zip(files: NamedBytes[]): Uint8Array<ArrayBuffer>[] {
    const parts: Uint8Array<ArrayBuffer>[] = [], directory: Uint8Array<ArrayBuffer>[] = [], sizeOf = (list: Uint8Array[]) => list.reduce((sum, part) => sum + part.length, 0);
    for (const {name, data} of files) {
        const text = new TextEncoder().encode(name), offset = sizeOf(parts);
        // Version 2.0, UTF-8 names, stored; the time and the date; the CRC, both sizes, the length of the name, no extra field.
        const facts: Field[] = [[2, 20], [2, k_utf8], [2, 0], [2, 0], [2, k_date], [4, crc32(data)], [4, data.length], [4, data.length], [2, text.length], [2, 0]];
        parts.push(packed([[4, 0x04034b50], ...facts]), text, data);
        directory.push(packed([[4, 0x02014b50], [2, 20], ...facts, [2, 0], [2, 0], [2, 0], [4, 0], [4, offset]]), text);
    }
    const end = packed([[4, 0x06054b50], [2, 0], [2, 0], [2, files.length], [2, files.length], [4, sizeOf(directory)], [4, sizeOf(parts)], [2, 0]]);
    return [...parts, ...directory, end];
}
