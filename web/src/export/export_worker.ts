// The worker that bakes the files of an engine, by the library with everything that writes, which is fetched for this alone. It ends with its bake.

import {load} from '../../../npm/library.js';
import type {Source} from '../bake/types';
import {zip, type NamedBytes} from './zip';
import moduleUrl from 'domelight-bake.wasm?url';

export interface ExportRequest {
    source: Source;
    engine: string;
    /// Of level 0; 0: the engine's own.
    size: number;
}
export interface BakedFiles {
    files: NamedBytes[];
    archive: Blob;
}
export type ExportReply = {progress: number} | {error: string} | BakedFiles;

const reply = (message: ExportReply, transfer: Transferable[] = []) => postMessage(message, {transfer});

async function bake({source, engine, size}: ExportRequest): Promise<BakedFiles> {
    const library = await load({module: new URL(moduleUrl, location.href)});
    const environment = 'latlong' in source ? library.fromPixels({data: source.latlong.pixels, width: source.latlong.width, height: source.latlong.height})
                                            : library.read(source.bytes, {name: source.name, projection: source.projection || 'auto'});
    const files = library.bakeFiles(environment, {engines: engine, size: size || undefined, progress: progress => reply({progress})}) as NamedBytes[];
    return {files, archive: new Blob(zip(files), {type: 'application/zip'})};
}

addEventListener('message', async ({data}: MessageEvent<ExportRequest>) => {
    try {
        const baked = await bake(data);
        reply(baked, baked.files.map(({data}) => data.buffer));
    } catch (error) {
        reply({error: (error as Error).message});
    }
});
