// Units and shapes: radiance is linear Rec. 709, finite and >= 0. Directions are in the world, right-handed, +Y up, and point away from the surface. Rows run from
// the top. A cube's faces are +X -X +Y -Y +Z -Z, each with OpenGL's orientation, so that a lookup by direction d gives the light from d. A lat-long map shows +X in
// its centre, +Z to the right of that and +Y at the top.

/** What the library refuses: one sentence, the option or file that it is about, and what to do. */
export class DomelightError extends Error {
    /** The option, in the form of this package ("irradianceSize"), or the file; empty: neither. */
    readonly field: string;
    /** The message alone. */
    readonly what: string;
    readonly hint: string;
}

/** Sets what the next worker is started with. */
export function configure(settings?: {
    /** The WebAssembly module: a URL, its bytes, or a compiled one. Default: domelight.wasm beside index.js. */
    module?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module;
    /** The same of the module that read() uses, which has the decoders. Default: domelight-files.wasm beside index.js. */
    files?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module;
    /** The same of the module that bakeFiles() and write() use, which also writes files. Default: domelight-bake.wasm beside index.js. */
    bake?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module;
    /** The URL of worker.js. Default: beside index.js. */
    worker?: string | URL;
}): void;

/** Ends the worker and frees its memory. The next call starts another; environments are opened again when they are used. */
export function terminate(): void;

/** Options of calls that take long. */
export interface Work {
    /** Called now and then with the part that is done, 0 to 1, and the name of the stage. What it throws ends the work. */
    progress?: (done: number, stage: string) => void;
    /** Ends the work. The promise is rejected with the signal's reason. */
    signal?: AbortSignal;
}

/** Float32Array: floats. Uint16Array: the bits of half floats. */
export type Floats = Float32Array | Uint16Array;

/** `faces` times `height` rows of `width` pixels of `channels` numbers. */
export interface Pixels<Data extends Floats = Floats> {
    data: Data;
    width: number;
    height: number;
    /** 1 (default): a lat-long map. 6: a cube, whose faces follow each other. */
    faces?: 1 | 6;
    /** 3 (default), or 4 of which the last is ignored. */
    channels?: number;
}
export type Image = Required<Pixels<Float32Array>>;

/** What a file does not say itself; the words are those of `domelight bake --help`. */
export interface ReadOptions {
    /** What errors call the file. */
    name?: string;
    projection?: string;
    latlong?: string;
    layer?: string;
    faces?: string;
    faceOrientation?: 'opengl' | 'directx' | 'openexr';
    decode?: string;
    negatives?: 'balance' | 'clamp' | 'keep';
    up?: string;
    /** Degrees: turns the light about +Y, +X towards +Z. */
    rotateYDeg?: number;
    /** Stops: radiance is multiplied by 2^exposure. */
    exposure?: number;
    /** Images whose decoding needs more memory are refused; 2^30. */
    maxBytes?: number;
    signal?: AbortSignal;
}

/** Light from every direction, held in the worker. */
export class Environment {
    private constructor();
    readonly width: number;
    readonly height: number;
    readonly format: string;
    readonly projection: string;
    readonly convention: string;
    readonly latlongWidth: number;
    readonly latlongHeight: number;
    /** 3 x 3 by rows: the light from world direction d is where the pixels have the direction worldToSource d. */
    readonly worldToSource: number[];
    /** Radiance from a direction, bilinear between texels. */
    radiance(direction: ArrayLike<number>): Promise<[number, number, number]>;
    /** A lat-long map in its own frame. */
    latlong(): Promise<Image>;
    /** Warnings about the file, and what was repaired. */
    warnings(): Promise<string[]>;
    /** Frees its memory. */
    close(): void;
}

/** Reads Radiance .hdr, OpenEXR, Ultra HDR and other JPEG, PNG, KTX2, KTX, DDS or .env: a URL, in Node and Deno also a path, a File or Blob, a Response, or its bytes. */
export function read(source: string | URL | Blob | Response | ArrayBuffer | ArrayBufferView, options?: ReadOptions): Promise<Environment>;
/** Makes an environment of radiance in memory, which is copied. NaN, infinite and negative values are errors. */
export function fromPixels(pixels: Pixels, options?: {worldToSource?: ArrayLike<number>; signal?: AbortSignal}): Promise<Environment>;

export type Lobe = 'ggx' | 'charlie' | 'phong' | 'phong-plain';

export interface LevelSpec {
    /** Width of a face, or height of a lat-long map; 1 to 16384. */
    size: number;
    /** ggx and charlie: 0 to 1, alpha = roughness². 0: the environment itself. */
    roughness?: number;
    /** phong: 0 or more. */
    exponent?: number;
    lobe?: Lobe;
}

interface Filtering extends Work {
    size?: number;
    lobe?: Lobe;
    layout?: 'cube' | 'latlong';
    /** centre: the light in the direction of each texel's centre. read: the values whose interpolation is nearest to the light. */
    texels?: 'centre' | 'read';
    /** Of each level, or a function of the level, their number, and the size of level 0. */
    roughness?: number[] | ((level: number, count: number, size: number) => number);
    /** Also a map of irradiance / π: width of a face, to 4096. */
    irradianceSize?: number;
    /** Also spherical harmonics of the radiance: 1 to 64 bands. */
    shBands?: number;
}

export interface PrefilterOptions extends Filtering {
    /** How many, each half the size of the one before (default 5, from size 256, roughness linear); or each by itself. */
    levels?: number | LevelSpec[];
    /** Directions in the world, three numbers each: each level is then one row of a pixel for each of them, whatever its size. No level may have roughness 0. */
    directions?: ArrayLike<number>;
    /** 3 x 3 by rows: a turn of the light. */
    worldToSource?: ArrayLike<number>;
}

interface Extras {
    irradianceOverPi?: Image;
    /** shBands² coefficients of the radiance, RGB each, in the order l² + l + m. */
    sh?: Float64Array;
    /** Mean radiance over the sphere. */
    mean: [number, number, number];
}

export interface Filtered extends Extras {
    levels: (LevelSpec & Image)[];
}

/** The environment convolved with the lobe of each level. */
export function prefilter(environment: Environment, options?: PrefilterOptions): Promise<Filtered>;

export type Encoding = 'rgba16f' | 'rgba32f' | 'rgb9e5' | 'r11g11b10f' | 'bc6h' | 'rgbm' | 'rgbd' | 'rgbp' | 'rg16f' | 'rg32f' | 'r32f';
export type Engine = 'generic' | 'three' | 'babylon' | 'playcanvas' | 'khronos';

export interface BakeOptions extends Filtering {
    /** Whose sizes, levels and orientation; default: generic. */
    engine?: Engine;
    levels?: number;
    /** Whether x is mirrored; default: as the engine looks cubes up. */
    mirror?: boolean;
    encoding?: Encoding;
    /** Of bc6h. */
    quality?: 'fast' | 'default' | 'high' | 'exhaustive';
}

export interface Texture {
    encoding: Encoding;
    /** Texels of a face of level 0. */
    width: number;
    height: number;
    faces: number;
    /** Texels along a side of a block, and bytes of a block; of single texels 1, and bytes of a texel. */
    block: number;
    blockBytes: number;
    /** The faces of each level one after the other, in tightly packed rows. */
    levels: {data: Uint8Array; width: number; height: number; clippedTexels: number; clippedEnergy: number; rmsError: number}[];
}

export interface Baked extends Texture, Extras {
    engine: Engine;
    /** What each level holds. */
    specs: LevelSpec[];
    /** Whether the cube is looked up by (-x, y, z) for the light from direction (x, y, z). `sh` is then that of the mirrored light. */
    mirrored: boolean;
}

/** What an engine loads: the levels that it reads, encoded. */
export function bake(environment: Environment, options?: BakeOptions): Promise<Baked>;

/** Bakes many cubes of one size, such as the probes of a scene that moves: what depends on the size alone is computed once. */
export class ProbeFilter {
    private constructor();
    /** Options of bake(), and cubeSize: the width of the cubes' faces, 16 to 256; default: that of level 0. */
    static make(options?: Omit<BakeOptions, 'progress' | 'signal'> & {cubeSize?: number; signal?: AbortSignal}): Promise<ProbeFilter>;
    /** What bake() gives of a cube's pixels, six faces of floats or half floats; they are copied. */
    bake(cube: Pixels, options?: {signal?: AbortSignal}): Promise<Baked>;
    /** Frees its memory. */
    close(): void;
}

/** The options of `domelight bake`, by the same words; what is left out is the engine's own. */
export interface BakeFilesOptions extends Work {
    /** generic (default), three, three-latlong, babylon, playcanvas, filament, khronos, bevy, gltf, godot, unity, unreal, blender, mitsuba, pbrt, usd, materialx. Several: each in a folder. */
    engines?: string | string[];
    /** Of level 0: width of a cube's face, or height of a lat-long map; 1 to 16384. */
    size?: number;
    levels?: number;
    layout?: 'cube' | 'latlong';
    lobe?: Lobe;
    texels?: 'centre' | 'read';
    /** Of each level, 0 to 1. */
    roughness?: ArrayLike<number>;
    /** Of each level of a Phong lobe; Infinity: the environment itself. */
    exponents?: ArrayLike<number>;
    encoding?: Encoding | 'uastc-hdr';
    encodingQuality?: 'fast' | 'default' | 'high' | 'exhaustive';
    format?: 'ktx2' | 'ktx1' | 'dds' | 'dds9' | 'exr' | 'exr-mip' | 'hdr';
    /** The convention of lat-long maps: default, usd, mitsuba, openexr, ... */
    latlongOut?: string;
    irradianceQuantity?: 'irradiance' | 'irradiance_over_pi';
    /** Width of a face, to 4096. */
    irradianceSize?: number;
    /** 1 to 64; 3. */
    shBands?: number;
    shWindow?: 'none' | 'hann' | 'lanczos';
    brdfMasking?: 'correlated' | 'smith' | 'karis';
    brdfSize?: number;
    /** preview.png; true. */
    preview?: boolean;
    /** SHA-256 of the source and of the files in manifest.json; true. */
    hashes?: boolean;
}

/** Everything that `domelight bake` writes: specular.ktx2, manifest.json, preview.png and so on, by the names that they have in its folder. */
export function bakeFiles(environment: Environment, options?: BakeFilesOptions): Promise<{name: string; data: Uint8Array}[]>;

export interface WriteOptions {
    /** Textures: ktx2 (default), ktx1, dds, dds9 (the header from before DX10), env (Babylon.js; rgbd, every level down to 1). Pictures: exr (half floats where they suffice), hdr. */
    format?: 'ktx2' | 'ktx1' | 'dds' | 'dds9' | 'env' | 'exr' | 'hdr';
    /** Of pixels that become a texture; rgba16f, in env rgbd. */
    encoding?: Encoding | 'uastc-hdr';
    /** Of bc6h and uastc-hdr. */
    quality?: 'fast' | 'default' | 'high' | 'exhaustive';
    /** Keys and values of ktx2 and ktx1. */
    metadata?: Record<string, string>;
    /** Of ktx2. */
    supercompression?: 'none' | 'zstd';
    signal?: AbortSignal;
}

/** The bytes of one file, of what bake(), encode() or prefilter() gave, of pixels (levels, each half the size of the one before), or of an environment as a lat-long map. */
export function write(what: Texture | Filtered | Pixels | Pixels[] | Environment, options?: WriteOptions): Promise<Uint8Array>;

/** Irradiance E divided by π. size: width of a face, or height; default 32. */
export function irradiance(environment: Environment, options?: {size?: number; layout?: 'cube' | 'latlong'} & Work): Promise<Image>;

/** bands² coefficients, RGB each; default: 3 bands of the radiance. */
export function sphericalHarmonics(environment: Environment, options?: {
    bands?: number;
    quantity?: 'radiance' | 'irradiance' | 'irradiance_over_pi';
    window?: 'none' | 'hann' | 'lanczos';
} & Work): Promise<Float64Array>;

/** Scale, bias and the sheen's albedo over NdotV (to the right) and roughness (down); default: 128 x 128. */
export function brdfTable(options?: {size?: number; masking?: 'correlated' | 'smith' | 'karis'; signal?: AbortSignal}): Promise<Image>;

/** Encodes levels, each half the size of the one before. */
export function encode(levels: Pixels | Pixels[], options?: {encoding?: Encoding; quality?: string; signal?: AbortSignal}): Promise<Texture>;

export interface Light {
    /** Towards the light, unit length. */
    direction: [number, number, number];
    u: number;
    v: number;
    angularDiameterDeg: number;
    /** On a surface that faces the light. */
    irradiance: [number, number, number];
    meanRadiance: [number, number, number];
    colour: [number, number, number];
    /** Of the environment's luminance, 0 to 1. */
    share: number;
    contrast: number;
    texels: number;
    /** Wider than a texel; otherwise the diameter is an upper bound. */
    resolved: boolean;
}
/** The sun and other small sources, the strongest first. */
export function lights(environment: Environment, options?: {
    leastShare?: number; leastContrast?: number; largestDiameterDeg?: number; mergeDeg?: number; maxLights?: number;
} & Work): Promise<Light[]>;

export interface Samples {
    /** On the sampler's lat-long map, [0, 1). */
    u: Float32Array;
    v: Float32Array;
    /** Unit directions. */
    x: Float32Array;
    y: Float32Array;
    z: Float32Array;
    /** Radiance from there. */
    r: Float32Array;
    g: Float32Array;
    b: Float32Array;
    /** Density per steradian. */
    pdf: Float32Array;
}
export interface Sequence {
    count: number;
    sequence?: 'sobol' | 'halton' | 'hammersley' | 'stratified' | 'r2' | 'random';
    seed?: number | bigint;
    first?: number;
    total?: number;
}

/** Draws light directions in proportion to the radiance. */
export class Sampler {
    private constructor();
    static build(environment: Environment, options?: {
        method?: 'bilinear' | 'guided' | 'alias' | 'hierarchical' | 'binary' | 'linear' | 'walk' | 'bilinear-plain';
        weight?: 'radiant-power' | 'grayscale';
        /** The share of samples that is uniform over the sphere, 0 to 1. */
        uniformShare?: number;
        /** Leaves the dim part of the sky to another strategy. */
        compensate?: boolean;
        signal?: AbortSignal;
    }): Promise<Sampler>;
    /** For points of a sequence, or pairs of x 2^32 and y 2^32 in the unit square. */
    sample(points: Sequence | Uint32Array): Promise<Samples>;
    /** Radiance and density in directions of three numbers each. */
    lookUp(directions: Float32Array): Promise<Omit<Samples, 'x' | 'y' | 'z'>>;
    close(): void;
}
