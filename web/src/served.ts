// What `domelight view` adds to the page: the files of its command line, and path-traced pictures as they converge (docs/view.md). On a static
// host there is none of it.

import type {Latlong} from './bake/types';

export interface NamedFile {
    name: string;
    url: string;
}
export interface Session {
    scene: NamedFile | null;
    environment: NamedFile[];
    /// probes.json of a set, and the files that it names.
    probes: NamedFile[];
    truth: boolean;
}

/// The session of the program that serves the page, or null. The program listens on this machine only, so that no other host is asked.
export async function readSession(): Promise<Session | null> {
    if (!['127.0.0.1', 'localhost'].includes(location.hostname)) return null;
    try {
        const answer = await fetch('./api/session');
        return answer.ok ? ((await answer.json()) as Session) : null;
    } catch {
        return null;
    }
}

export async function fetchFile({name, url}: NamedFile): Promise<File> {
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(`${name}: the program does not serve it any more.`);
    return new File([await answer.arrayBuffer()], name);
}

export interface TruthRequest {
    position: number[];
    target: number[];
    fov_y_deg: number;
    width: number;
    height: number;
    /// The part of it, in the upper left corner, in whose middle the target is.
    view_width: number;
    view_height: number;
    samples: number;
    bounces: number;
    occlusion: boolean;
    rotate_y_deg: number;
}
export interface TruthFrame {
    picture: Latlong;
    samples: number;
    noise: number;
}

/// Asks for a picture and shows each frame of it, until the last has come or `signal` ends it.
export async function askTruth(request: TruthRequest, signal: AbortSignal, show: (frame: TruthFrame) => void): Promise<void> {
    const answer = await fetch('./api/truth', {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(request), signal});
    if (!answer.ok || !answer.body) throw new Error(`The path tracer refuses the picture: ${(await answer.text()) || answer.statusText}`);
    const reader = new ByteReader(answer.body.getReader());
    for (;;) {
        const head = await reader.read(16);
        if (!head) return;
        const view = new DataView(head.buffer), width = view.getUint32(0, true), height = view.getUint32(4, true);
        if (width === 0) throw new Error(`The path tracer stopped: ${new TextDecoder().decode((await reader.read(view.getUint32(8, true))) ?? undefined)}.`);
        const bytes = await reader.read(12 * width * height);
        if (!bytes) return;
        show({picture: {width, height, pixels: new Float32Array(bytes.buffer)}, samples: view.getFloat32(8, true), noise: view.getFloat32(12, true)});
    }
}

/// A stream in pieces of the lengths that are asked for.
class ByteReader {
    private rest = new Uint8Array(0);
    constructor(private readonly source: ReadableStreamDefaultReader<Uint8Array>) {}

    /// So many bytes in a buffer of their own; null where the stream ends before.
    async read(count: number): Promise<Uint8Array<ArrayBuffer> | null> {
        const out = new Uint8Array(count);
        for (let at = 0; ; ) {
            const part = this.rest.subarray(0, count - at);
            out.set(part, at);
            at += part.length;
            this.rest = this.rest.subarray(part.length);
            if (at === count) return out;
            const {value, done} = await this.source.read();
            if (done) return null;
            this.rest = new Uint8Array(value);
        }
    }
}
