// The library on this thread: the functions of index.d.ts without promises. For workers of your own, and for scripts.
import type {
    Baked, BakeFilesOptions, BakeOptions, Encoding, Filtered, Image, Light, Pixels, PrefilterOptions, ReadOptions, Samples, Sequence, Texture, WriteOptions,
} from './index.js';

/** Starts an instance of the module. `module`: a URL, its bytes, or a compiled one; default: domelight.wasm beside this file. */
export function load(options?: {module?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module}): Promise<Library>;

export class LibraryEnvironment {
    private constructor();
    readonly info: {
        format: string; projection: string; convention: string; width: number; height: number; latlongWidth: number; latlongHeight: number;
        worldToSource: number[];
    };
    readonly warnings: string[];
    radiance(direction: ArrayLike<number>): [number, number, number];
    latlong(): Image;
    close(): void;
}

export class LibraryProbeFilter {
    private constructor();
    bake(cube: Pixels): Baked;
    close(): void;
}

export class LibrarySampler {
    private constructor();
    sample(points: Sequence | Uint32Array): Samples;
    lookUp(directions: Float32Array): Omit<Samples, 'x' | 'y' | 'z'>;
    close(): void;
}

export class Library {
    private constructor();
    readonly version: string;
    /** True after a fault or a lack of memory: load() another. */
    readonly broken: boolean;
    /** Bytes of the instance's memory. */
    readonly memoryBytes: number;
    read(bytes: ArrayBuffer | ArrayBufferView, options?: Omit<ReadOptions, 'signal'>): LibraryEnvironment;
    fromPixels(pixels: Pixels, options?: {worldToSource?: ArrayLike<number>}): LibraryEnvironment;
    prefilter(environment: LibraryEnvironment, options?: PrefilterOptions): Filtered;
    bake(environment: LibraryEnvironment, options?: BakeOptions): Baked;
    /** Only of domelight-bake.wasm, as write(). */
    bakeFiles(environment: LibraryEnvironment, options?: BakeFilesOptions): {name: string; data: Uint8Array}[];
    write(what: Texture | Filtered | Pixels | Pixels[] | LibraryEnvironment, options?: Omit<WriteOptions, 'signal'>): Uint8Array;
    probeFilter(options?: Omit<BakeOptions, 'progress' | 'signal'> & {cubeSize?: number}): LibraryProbeFilter;
    irradiance(environment: LibraryEnvironment, options?: {size?: number; layout?: 'cube' | 'latlong'}): Image;
    sphericalHarmonics(environment: LibraryEnvironment, options?: {bands?: number; quantity?: string; window?: string}): Float64Array;
    brdfTable(options?: {size?: number; masking?: string}): Image;
    lights(environment: LibraryEnvironment, options?: {
        leastShare?: number; leastContrast?: number; largestDiameterDeg?: number; mergeDeg?: number; maxLights?: number;
    }): Light[];
    encode(levels: Pixels | Pixels[], options?: {encoding?: Encoding; quality?: string}): Texture;
    sampler(environment: LibraryEnvironment, options?: {method?: string; weight?: string; uniformShare?: number; compensate?: boolean}): LibrarySampler;
}
