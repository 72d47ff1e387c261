// KTX 2.0 files of half floats: the header, the index of levels, a data format descriptor and the levels, the smallest first.

import type {CubeLevel} from './types';

const identifier = [0xab, 0x4b, 0x54, 0x58, 0x20, 0x32, 0x30, 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];
const k_vk_r16g16b16a16_sfloat = 97;
const k_header = 80, k_level = 24, k_descriptor = 4 + 24 + 4 * 16;

/// faces: 6 of a cube, or 1. Each level: RGBA half floats of its faces.
export function writeKtx2(levels: {size: number; texels: CubeLevel['texels']}[], faces: number): ArrayBuffer {
    const align = (v: number) => Math.ceil(v / 8) * 8, start = align(k_header + k_level * levels.length + k_descriptor);
    const offsets: number[] = [];
    let end = start;
    for (let l = levels.length - 1; l >= 0; --l) {
        offsets[l] = end;
        end = align(end + levels[l]!.texels.byteLength);
    }
    const bytes = new Uint8Array(end), view = new DataView(bytes.buffer);
    bytes.set(identifier);
    const header = [k_vk_r16g16b16a16_sfloat, 2, levels[0]!.size, levels[0]!.size, 0, 0, faces, levels.length, 0, k_header + k_level * levels.length, k_descriptor, 0, 0];
    header.forEach((v, k) => view.setUint32(12 + 4 * k, v, true));
    levels.forEach(({texels}, l) => {
        const at = k_header + k_level * l;
        for (const [k, v] of [offsets[l]!, texels.byteLength, texels.byteLength].entries()) view.setBigUint64(at + 8 * k, BigInt(v), true);
        bytes.set(new Uint8Array(texels.buffer, texels.byteOffset, texels.byteLength), offsets[l]!);
    });
    describe(view, k_header + k_level * levels.length);
    return bytes.buffer;
}

/// The basic data format descriptor of four signed floats of 16 bits, linear Rec. 709 (Khronos Data Format 1.3, 5).
function describe(view: DataView, at: number): void {
    const words = [k_descriptor, 0, 2 | ((24 + 64) << 16), 1 | (1 << 8) | (1 << 16), 0, 8, 0];
    words.forEach((v, k) => view.setUint32(at + 4 * k, v, true));
    [0, 1, 2, 15].forEach((channel, k) => {
        const sample = at + 28 + 16 * k;
        view.setUint16(sample, 16 * k, true);
        view.setUint8(sample + 2, 15);
        view.setUint8(sample + 3, channel | 0xc0);  // a signed float
        view.setUint32(sample + 8, 0xbf800000, true);
        view.setUint32(sample + 12, 0x3f800000, true);
    });
}
