// Everything that the user has chosen. It is also the address of the page: what differs from the defaults stands behind its #.

export const modes = ['split-sum', 'stretched', 'phong', 'mirror', 'refract', 'monte-carlo'] as const;
export type Mode = (typeof modes)[number];
/// What a mode is compared with: another, a picture from a file, or one that the program renders.
export const others = [...modes, 'picture', 'truth'] as const;
export type Other = (typeof others)[number];
/// Whether it is a picture, and not drawn by the page.
export const isPicture = (other: Other): other is 'picture' | 'truth' => other === 'picture' || other === 'truth';
export const tonemaps = ['none', 'reinhard', 'aces', 'agx', 'neutral'] as const;
export const lookups = ['environment', 'cube', 'latlong', 'sphere-map', 'dual-paraboloid'] as const;
/// What an environment file is, where it does not say it: words of the library.
export const projections = ['auto', 'latlong', 'cube', 'cube-cross', 'cube-strip', 'sphere-map', 'mirror-ball', 'angular', 'dual-paraboloid', 'octahedral', 'equal-area-octahedral'] as const;
export const backgrounds = ['environment', 'blurred', 'colour'] as const;
export const views = ['one', 'other', 'split', 'difference', 'flip'] as const;
export const strategies = ['mis', 'env', 'brdf'] as const;
export const tables = ['walk', 'guided'] as const;

export interface State {
    mode: Mode;
    /// The right pane, and what the left one is compared with.
    other: Other;
    view: (typeof views)[number];
    divider: number;
    model: string;
    environment: string;
    projection: (typeof projections)[number];
    exposure: number;
    tonemap: (typeof tonemaps)[number];
    /// On a screen that shows more than white: whether it does, and how many times white the brightest is.
    hdr: boolean;
    peak: number;
    background: (typeof backgrounds)[number];
    blur: number;
    turn: number;
    size: number;
    multipleScattering: boolean;
    irradiance: 'cube' | 'sh';
    occlusion: boolean;
    bentLookup: boolean;
    diffuseWeight: 'energy' | 'fresnel';
    lookup: (typeof lookups)[number];
    ior: number;
    iorOutside: number;
    /// Whether `ior` takes the place of the material's.
    iorOverride: boolean;
    override: boolean;
    color: string;
    metalness: number;
    roughness: number;
    /// Base 2 logarithm of the Phong exponent.
    exponentLog2: number;
    furnace: boolean;
    /// Whether lights of the model shine.
    lights: boolean;
    /// Objects see their neighbours, and not the environment alone.
    live: boolean;
    motion: boolean;
    strategy: (typeof strategies)[number];
    tables: (typeof tables)[number];
    samples: number;
    /// Rows of the map that is sampled.
    rows: number;
    lookupSize: number;
    /// Of the path tracer: samples as a power of two.
    truthSamples: number;
    bounces: number;
    shadows: boolean;
    eye: [number, number, number];
    target: [number, number, number];
    fov: number;
    /// Of a set of probes, where there is one: whether it lights the methods that can be lit by it, and how.
    probes: boolean;
    probeBlend: number;
    probeParallax: boolean;
    probeVisibility: boolean;
    /// Balls where the probes stand.
    probeBalls: boolean;
    panel: boolean;
    /// Every pixel of the screen, however slow that is.
    fullResolution: boolean;
}

export const defaults: State = {
    mode: 'split-sum', other: 'monte-carlo', view: 'one', divider: 0.5,
    model: 'spheres', environment: 'studio', projection: 'auto',
    exposure: 0, tonemap: 'agx', hdr: true, peak: 4, background: 'environment', blur: 0.35, turn: 0, size: 256,
    multipleScattering: false, irradiance: 'cube', occlusion: true, bentLookup: false, diffuseWeight: 'energy',
    lookup: 'environment', ior: 1.5, iorOutside: 1, iorOverride: false,
    override: false, color: '#ffffff', metalness: 1, roughness: 0.3, exponentLog2: 6,
    furnace: false, lights: true, live: false, motion: false, strategy: 'mis', tables: 'guided', samples: 1, rows: 256, lookupSize: 512, truthSamples: 8, bounces: 0, shadows: false,
    probes: true, probeBlend: 8, probeParallax: true, probeVisibility: true, probeBalls: false,
    eye: [0, 0, 0], target: [0, 0, 0], fov: 35, panel: true, fullResolution: false,
};

/// Of values that are words, those that there are.
export type Words<T> = Partial<Record<keyof T, readonly string[]>>;
const accepted: Words<State> = {
    mode: modes, other: others, view: views, tonemap: tonemaps, background: backgrounds, lookup: lookups, strategy: strategies, projection: projections,
    tables, irradiance: ['cube', 'sh'], diffuseWeight: ['energy', 'fresnel'],
};

type Listener<T> = (changed: Set<keyof T>) => void;

/// Values that the user chooses, and who wants to know of their changes. Changes are told once a frame.
export class Values<T extends object> {
    readonly state: T;
    private readonly listeners: Listener<T>[] = [];
    private changed = new Set<keyof T>();

    constructor(initial: T, private readonly usual: T) {
        this.state = initial;
    }

    set(changes: Partial<T>): void {
        for (const [key, value] of Object.entries(changes) as [keyof T, never][]) {
            if (same(this.state[key], value)) continue;
            this.state[key] = value;
            if (this.changed.size === 0) requestAnimationFrame(() => this.tell());
            this.changed.add(key);
        }
    }
    reset(key: keyof T): void {
        this.set({[key]: this.usual[key]} as unknown as Partial<T>);
    }
    /// Tells the listeners once, as if a value had changed.
    touch(key: keyof T): void {
        this.changed = new Set([key]);
        requestAnimationFrame(() => this.tell());
    }
    listen(listener: Listener<T>): void {
        this.listeners.push(listener);
    }
    private tell(): void {
        const changed = this.changed;
        this.changed = new Set();
        for (const listener of this.listeners) listener(changed);
    }
}

/// Those of the app, as its address has them.
export class Store extends Values<State> {
    constructor(hash: string) {
        super({...defaults, ...readHash(hash)}, defaults);
    }
}

const same = (a: unknown, b: unknown) => (Array.isArray(a) ? String(a) === String(b) : a === b);

/// `#mode=phong&eye=0,0,5`, without what is the default.
export function writeHash<T extends object = State>(state: T, usual: T = defaults as never): string {
    const parts = Object.entries(state)
        .filter(([key, value]) => !same(value, usual[key as keyof T]))
        .map(([key, value]) => `${key}=${Array.isArray(value) ? value.map(v => +v.toFixed(4)).join() : encodeURIComponent(value)}`);
    return parts.length ? `#${parts.join('&')}` : '';
}

/// What of an address is understood. The rest is left out, because an address may come from another version.
export function readHash<T extends object = State>(hash: string, usual: T = defaults as never, words: Words<T> = accepted as never): Partial<T> {
    const read: Record<string, unknown> = {};
    for (const [key, text] of new URLSearchParams(hash.replace(/^#/, ''))) {
        const value = key in usual ? parse(text, usual[key as keyof T], words[key as keyof T]) : undefined;
        if (value !== undefined) read[key] = value;
    }
    return read as Partial<T>;
}

function parse(text: string, usual: unknown, words?: readonly string[]): unknown {
    if (typeof usual === 'boolean') return text === 'true' ? true : text === 'false' ? false : undefined;
    if (typeof usual === 'number') return text !== '' && Number.isFinite(+text) ? +text : undefined;
    if (Array.isArray(usual)) {
        const numbers = text.split(',').map(Number);
        return numbers.length === usual.length && numbers.every(Number.isFinite) ? numbers : undefined;
    }
    return words && !words.includes(text) ? undefined : text;
}
