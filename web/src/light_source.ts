// Environments: those that are computed in the page, and what the user opened.

import type {Baker} from './bake/baker';
import type {EnvironmentInfo, Latlong} from './bake/types';
import {fetchFile, type NamedFile} from './served';
import {studio, sunset, whiteFurnace} from './scene/environments';

export const builtInEnvironments: Record<string, () => Latlong> = {studio, sunset, furnace: whiteFurnace};

/// Where an environment comes from, so that it can be opened again after the white furnace. projection: of files that do not say theirs.
export type LightSource = (baker: Baker, projection: string) => Promise<EnvironmentInfo>;

export const builtIn = (name: string): LightSource => baker => baker.use(name, (builtInEnvironments[name] ?? studio)());
export const fromFile = (file: File): LightSource => async (baker, projection) => baker.open(file.name, await file.arrayBuffer(), projection === 'auto' ? '' : projection);
export const fromServed = (named: NamedFile): LightSource => async (baker, projection) => fromFile(await fetchFile(named))(baker, projection);
