// The worker that reads the files of a set of probes, so that the page keeps moving.

import {makeAtlas, type Atlas} from './atlas';
import {makeCells, type CellTexels} from './cells';
import {readCubeArray} from './cube_array';
import {makeDistances, type Distances} from './distances';
import type {ProbeRecord} from './record';

export interface ProbeFiles {
    record: ProbeRecord;
    specular: ArrayBuffer;
    irradiance: ArrayBuffer;
    distance: ArrayBuffer | null;
}
export interface ProbeMaps {
    specular: Atlas;
    irradiance: Atlas;
    distances: Distances | null;
    /// Null where the places are a grid.
    cells: CellTexels | null;
}

function read({record, specular, irradiance, distance}: ProbeFiles): ProbeMaps {
    const cubes = record.probes.length;
    return {
        specular: makeAtlas(readCubeArray(record.specular.file, specular, {size: record.specular.size, cubes, levels: record.roughness.length, channels: 3})),
        irradiance: makeAtlas(readCubeArray(record.irradiance.file, irradiance, {size: record.irradiance.size, cubes, levels: 1, channels: 3})),
        distances: distance && makeDistances(readCubeArray(record.distance!.file, distance, {size: record.distance!.size, cubes, levels: 1, channels: 2})),
        cells: makeCells(record),
    };
}

addEventListener('message', ({data}: MessageEvent<ProbeFiles>) => {
    try {
        const maps = read(data), arrays = [maps.specular.texels, maps.irradiance.texels, ...[maps.distances, maps.cells].flatMap(part => (part ? [part.texels] : []))];
        postMessage({maps}, {transfer: arrays.map(array => array.buffer as ArrayBuffer)});
    } catch (error) {
        postMessage({error: (error as Error).message});
    }
});
