import path from 'node:path';

const {readHdr: read} = await import(path.join(process.env.DOMELIGHT_ROOT, 'tests/engines/browser/files.mjs'));

/// A Radiance picture, decoded without our code, as fromPixels() takes it.
export function readHdr(file) {
    const {rgb, ...size} = read(file);
    return {data: rgb, ...size};
}
