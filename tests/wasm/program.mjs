// The program and the photographs that the module is compared with, and why a test may have to do without them.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {after} from 'node:test';

export const {DOMELIGHT_PROGRAM: program, DOMELIGHT_DATA: data} = process.env;
export const without = !program || !fs.existsSync(program) ? 'the program has not been built' : !data ? 'DOMELIGHT_DATA names no folder' : false;
export const photograph = data && path.join(data, 'env_latlong/noon_grass_1k.hdr');

/// A folder that is removed after the tests of the file.
export function temporaryFolder() {
    const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'domelight-'));
    after(() => fs.rmSync(folder, {recursive: true}));
    return folder;
}
