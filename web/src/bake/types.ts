// What the worker and the page exchange. Directions, faces and units are those of docs/conventions.md.

/// A lat-long map of radiance: RGB floats, the top row first.
export interface Latlong {
    width: number;
    height: number;
    pixels: Float32Array;
}

/// An environment as it was opened: a file, whose projection is empty where it says it, or pixels that the page has computed.
export type Source = {name: string; bytes: ArrayBuffer; projection: string} | {name: string; latlong: Latlong};

/// A cube of half floats, RGBA, its faces +X -X +Y -Y +Z -Z one after the other.
export interface CubeLevel {
    size: number;
    texels: Uint16Array;
}

/// Those of `domelight bake --lobe`, and the one without the BRDF's cosine: phong-plain of exponent 1 is E / pi.
export type Lobe = 'ggx' | 'phong' | 'phong-plain';

/// A chain of levels that is read by roughness, or by the exponent of a modified Phong lobe.
export interface Chain {
    lobe: 'ggx' | 'phong';
    levels: CubeLevel[];
    /// Of each level: the roughness, or the exponent, which is infinite for level 0.
    parameters: number[];
}

/// The maps of one environment.
export interface Bake {
    specular: Chain;
    /// The cosine integral E.
    irradiance: CubeLevel;
    /// 9 x RGB: the coefficients of E, real, orthonormal, polar axis +Z.
    sh: Float32Array;
    /// Wall-clock time of the filter.
    milliseconds: number;
}

/// What an opened file is.
export interface EnvironmentInfo {
    name: string;
    format: string;
    width: number;
    height: number;
    /// RGBA half floats of the lat-long map. (The worker keeps the floats.)
    texels: Uint16Array;
    /// Sentences about repaired texels and the like.
    warnings: string[];
    milliseconds: number;
}

export interface BrdfTable {
    size: number;
    /// RGBA half floats: scale and bias in the first two channels; row 0 is the smoothest.
    texels: Uint16Array;
}

/// The environment for sampling in a shader (shading/monte_carlo.glsl), `width` x `height`.
export interface Tables {
    width: number;
    height: number;
    /// RGBA floats of the map.
    texels: Float32Array;
    /// Of each row the average of luminance times sin(theta), and the average of all rows.
    rowAverages: Float32Array;
    totalAverage: number;
    /// Pairs (cumulative weight, guide) of each column of each row, and of each row.
    columns: Float32Array;
    rows: Float32Array;
}

/// What the page shows of an environment.
export interface Survey {
    /// A small lat-long map: RGB floats.
    thumbnail: Latlong;
    /// The part of the sphere whose luminance lies in each third of a stop from 2^k_least_ev on.
    histogram: Float32Array;
    meanLuminance: number;
    peakLuminance: number;
}
export const k_least_ev = -12;
export const k_bins_per_ev = 3;

/// A request to the worker. Each has a number that its reply carries.
export type Request =
    | {kind: 'open'; name: string; bytes: ArrayBuffer; projection: string}
    | {kind: 'use'; name: string; latlong: Latlong}
    | {kind: 'bake'; size: number}
    | {kind: 'phong'; size: number}
    | {kind: 'tables'; rows: number}
    | {kind: 'survey'; rows: number}
    | {kind: 'samples'; count: number}
    | {kind: 'filtered'; lobe: Lobe; parameter: number; directions: Float64Array}
    | {kind: 'live'; size: number; texels: Float32Array}
    | {kind: 'picture'; name: string; bytes: ArrayBuffer};

export interface Replies {
    open: EnvironmentInfo;
    use: EnvironmentInfo;
    bake: Bake;
    phong: Chain;
    tables: Tables;
    survey: Survey;
    /// Pairs u, v.
    samples: Float32Array;
    /// RGB of each direction.
    filtered: Float32Array;
    live: Bake;
    picture: Latlong;
}
