// probes.json, as docs/probes.md describes it.

export type Triple = [number, number, number];
export interface Box {
    low: Triple;
    high: Triple;
}
export interface Probe {
    position: Triple;
    valid: boolean;
    moved: boolean;
    influence: {shape: 'everywhere' | 'box' | 'sphere'; box?: Box; radius: number; fade: number};
    /// The walls around it, for lookups that correct parallax.
    proxy?: Box;
    /// Nine coefficients of the radiance, RGB.
    harmonics: Triple[];
}
export interface Grid {
    origin: Triple;
    spacing: Triple;
    counts: Triple;
}
export interface MapRecord {
    file: string;
    /// Texels along a side of a face of level 0.
    size: number;
}
export interface ProbeRecord {
    /// The file that was captured.
    scene: string;
    bounces: number;
    grid: Grid | null;
    probes: Probe[];
    specular: MapRecord;
    /// Of each level of `specular`.
    roughness: number[];
    irradiance: MapRecord;
    distance: MapRecord | null;
}

export const k_record_name = 'probes.json';

/// Checks the text of probes.json. Throws a sentence that names the member that is wrong.
export function readRecord(text: string): ProbeRecord {
    let json: Json;
    try {
        json = JSON.parse(text) as Json;
    } catch {
        throw wrong('', 'it is no JSON');
    }
    if (json === null || typeof json !== 'object' || !Array.isArray(json.probes)) throw wrong('probes', 'there are none');
    if (json.format !== 1) throw wrong('format', `${String(json.format)} is not 1, the only one known here`);
    const specular = mapOf(json.specular, 'specular'), levels = json.specular.levels, probes = (json.probes as Json[]).map(probeOf);
    if (!Array.isArray(levels)) throw wrong('specular.levels', 'there are none');
    const roughness = (levels as Json[]).map((level, l) => numberOf(level?.roughness, `specular.levels[${l}].roughness`));
    if (roughness[0] !== 0 || roughness.some((r, l) => l > 0 && !(r > roughness[l - 1]! && r <= 1))) throw wrong('specular.levels', `the roughness ${roughness.join(', ')} does not rise from 0 to at most 1`);
    return {
        scene: String(json.scene?.file ?? ''), bounces: Number(json.options?.bounces ?? 0), grid: json.grid ? gridOf(json.grid, probes.length) : null, probes, specular, roughness,
        irradiance: mapOf(json.irradiance, 'irradiance'), distance: json.distance ? mapOf(json.distance, 'distance') : null,
    };
}

/// Of any shape: each member is checked where it is read.
type Json = any;

const wrong = (member: string, what: string) => new Error(`${k_record_name}: ${member ? `${member}: ` : ''}${what}.`);

function numberOf(value: unknown, member: string): number {
    if (typeof value !== 'number' || !Number.isFinite(value)) throw wrong(member, `${JSON.stringify(value) ?? 'nothing'} is not a number`);
    return value;
}
function tripleOf(value: unknown, member: string): Triple {
    if (!Array.isArray(value) || value.length !== 3) throw wrong(member, `${JSON.stringify(value) ?? 'nothing'} is not three numbers`);
    return value.map((v, k) => numberOf(v, `${member}[${k}]`)) as Triple;
}
function boxOf(value: Json, member: string): Box {
    const box = {low: tripleOf(value.low, `${member}.low`), high: tripleOf(value.high, `${member}.high`)};
    if (box.low.some((v, k) => v > box.high[k]!)) throw wrong(`${member}.high`, 'is below `low`');
    return box;
}
function mapOf(value: Json, member: string): MapRecord {
    if (typeof value?.file !== 'string') throw wrong(`${member}.file`, 'it is missing');
    const size = numberOf(value.size, `${member}.size`);
    if (!(size >= 1 && size <= 4096 && Number.isInteger(size))) throw wrong(`${member}.size`, `${size} is not a size of 1 to 4096 texels`);
    return {file: value.file, size};
}
function gridOf(value: Json, probes: number): Grid {
    const grid = {origin: tripleOf(value.origin, 'grid.origin'), spacing: tripleOf(value.spacing, 'grid.spacing'), counts: tripleOf(value.counts, 'grid.counts')};
    if (grid.counts.some(n => n < 1 || !Number.isInteger(n)) || grid.counts[0] * grid.counts[1] * grid.counts[2] !== probes)
        throw wrong('grid.counts', `there are ${grid.counts.join(' x ')} places, but ${probes} probes`);
    if (grid.spacing.some(s => s <= 0)) throw wrong('grid.spacing', `${grid.spacing.join(', ')} is not above 0`);
    return grid;
}
function influenceOf(value: Json, member: string): Probe['influence'] {
    const shape = value?.shape ?? 'everywhere', fade = value?.fade === undefined ? 0 : numberOf(value.fade, `${member}.fade`);
    if (shape === 'everywhere') return {shape, radius: 0, fade};
    if (shape === 'box') return {shape, box: boxOf(value, member), radius: 0, fade};
    if (shape === 'sphere') return {shape, radius: numberOf(value.radius, `${member}.radius`), fade};
    throw wrong(`${member}.shape`, `"${String(shape)}" is none of everywhere, box, sphere`);
}
function probeOf(value: Json, number: number): Probe {
    const member = `probes[${number}]`, harmonics = value?.harmonics;
    if (!Array.isArray(harmonics) || harmonics.length !== 9) throw wrong(`${member}.harmonics`, 'are not nine coefficients of three numbers');
    return {
        position: tripleOf(value.position, `${member}.position`), valid: value.valid !== false, moved: value.moved === true, influence: influenceOf(value.influence, `${member}.influence`),
        ...(value.proxy ? {proxy: boxOf(value.proxy, `${member}.proxy`)} : {}), harmonics: harmonics.map((c, k) => tripleOf(c, `${member}.harmonics[${k}]`)),
    };
}
