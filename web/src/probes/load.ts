// Opens a set of probes, of files that were dropped or that the program serves.

import {k_record_name, readRecord, type ProbeRecord} from './record';
import type {ProbeFiles, ProbeMaps} from './worker';

export interface ProbeSet {
    record: ProbeRecord;
    maps: ProbeMaps;
}

/// The files of a set among others: those of the folder of probes.json that it may name.
export function splitFiles(files: File[]): {set: File[]; rest: File[]} {
    const record = files.find(({name}) => name === k_record_name);
    if (!record) return {set: [], rest: files};
    const isOfSet = (file: File) => file === record || /^(specular|irradiance|distance)\.ktx2$/.test(file.name);
    return {set: files.filter(isOfSet), rest: files.filter(file => !isOfSet(file))};
}

/// Reads and checks a set. Rejects with a sentence that says what is wrong with it.
export async function loadProbes(files: File[]): Promise<ProbeSet> {
    const byName = new Map(files.map(file => [file.name, file]));
    const record = readRecord(await byName.get(k_record_name)!.text());
    const bytesOf = async (name: string) => {
        const file = byName.get(name);
        if (!file) throw new Error(`${k_record_name} names ${name}, which is missing: drop the folder, or all of its files together.`);
        return file.arrayBuffer();
    };
    const [specular, irradiance, distance] = await Promise.all([bytesOf(record.specular.file), bytesOf(record.irradiance.file), record.distance ? bytesOf(record.distance.file) : null]);
    return {record, maps: await readMaps({record, specular, irradiance, distance})};
}

function readMaps(files: ProbeFiles): Promise<ProbeMaps> {
    const worker = new Worker(new URL('./worker.ts', import.meta.url), {type: 'module'});
    return new Promise<ProbeMaps>((resolve, reject) => {
        worker.addEventListener('message', ({data}: MessageEvent<{maps: ProbeMaps} | {error: string}>) => ('error' in data ? reject(new Error(data.error)) : resolve(data.maps)));
        worker.addEventListener('error', event => reject(new Error(`The worker that reads probes stopped: ${event.message || 'it could not be loaded'}.`)));
        worker.postMessage(files, [files.specular, files.irradiance, ...(files.distance ? [files.distance] : [])]);
    }).finally(() => worker.terminate());
}
