// Environments: those that are computed in the page, and what the user opened.

import type {Baker} from './bake/baker';
import type {EnvironmentInfo, Latlong, Source} from './bake/types';
import {fetchFile, type NamedFile} from './served';
import {studio, sunset, whiteFurnace} from './scene/environments';

export const builtInEnvironments: Record<string, () => Latlong> = {studio, sunset, furnace: whiteFurnace};

/// The mean radiance of a picture that is well exposed.
const k_mean = 0.5;

/// Where an environment comes from, so that it can be opened again. projection: of files that do not say theirs.
export type LightSource = (projection: string) => Promise<Source>;

/// The exposure that brings the mean radiance to k_mean, in thirds of a stop. sh: coefficients of E.
export function exposureFor(sh: Float32Array): number {
    const mean = (0.2126 * sh[0]! + 0.7152 * sh[1]! + 0.0722 * sh[2]!) * 0.282095 / Math.PI;
    return mean > 0 ? Math.round(3 * Math.min(12, Math.max(-12, Math.log2(k_mean / mean)))) / 3 : 0;
}

export const builtIn = (name: string): LightSource => async () => ({name, latlong: (builtInEnvironments[name] ?? studio)()});
export const fromFile = (file: File): LightSource => async projection => ({name: file.name, bytes: await file.arrayBuffer(), projection: projection === 'auto' ? '' : projection});
export const fromServed = (named: NamedFile): LightSource => async projection => fromFile(await fetchFile(named))(projection);

export const openSource = (baker: Baker, source: Source): Promise<EnvironmentInfo> =>
    'latlong' in source ? baker.use(source.name, source.latlong) : baker.open(source.name, source.bytes, source.projection);
