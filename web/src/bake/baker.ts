// The page's side of the worker: promises in place of messages.

import type {Bake, Chain, EnvironmentInfo, Latlong, Lobe, Replies, Request, Survey, Tables} from './types';

type Waiting = {resolve: (reply: never) => void; reject: (error: Error) => void};

export class Baker {
    private worker: Worker;
    private waiting = new Map<number, Waiting>();
    private next = 0;

    constructor() {
        this.worker = this.start();
    }

    /// Reads the bytes of a file, which are handed over. Rejects with a sentence that says what is wrong with them.
    /// projection: what the file is, where it does not say it; empty: what it says or shows.
    open(name: string, bytes: ArrayBuffer, projection = ''): Promise<EnvironmentInfo> {
        return this.ask({kind: 'open', name, bytes, projection}, [bytes]);
    }
    /// Takes an environment that the page has computed.
    use(name: string, latlong: Latlong): Promise<EnvironmentInfo> {
        return this.ask({kind: 'use', name, latlong}, [latlong.pixels.buffer as ArrayBuffer]);
    }
    /// Filters the environment that was opened last. size: of a face of level 0.
    bake(size: number): Promise<Bake> {
        return this.ask({kind: 'bake', size});
    }
    phong(size: number): Promise<Chain> {
        return this.ask({kind: 'phong', size});
    }

    /// What shaders draw light directions with. rows: at most, of the map.
    tables(rows: number): Promise<Tables> {
        return this.ask({kind: 'tables', rows});
    }

    /// The light in some directions (three numbers each), exactly. parameter: the roughness, or the exponent.
    filtered(lobe: Lobe, parameter: number, directions: Float64Array): Promise<Float32Array> {
        return this.ask({kind: 'filtered', lobe, parameter, directions});
    }
    survey(rows: number): Promise<Survey> {
        return this.ask({kind: 'survey', rows});
    }
    /// Where light directions fall: pairs (u, v).
    samples(count: number): Promise<Float32Array> {
        return this.ask({kind: 'samples', count});
    }
    /// Filters a cube that was drawn in the scene (Stage.drawCube): RGBA floats, of which the environment shows through where alpha is below 1.
    live(size: number, texels: Float32Array): Promise<Bake> {
        return this.ask({kind: 'live', size, texels}, [texels.buffer as ArrayBuffer]);
    }
    /// A picture of any shape, RGB floats.
    picture(name: string, bytes: ArrayBuffer): Promise<Latlong> {
        return this.ask({kind: 'picture', name, bytes}, [bytes]);
    }

    private ask<R extends Request>(request: R, transfer: Transferable[] = []): Promise<Replies[R['kind']]> {
        const id = this.next++;
        return new Promise((resolve, reject) => {
            this.waiting.set(id, {resolve, reject});
            this.worker.postMessage({id, request}, transfer);
        });
    }

    private start(): Worker {
        const worker = new Worker(new URL('./worker.ts', import.meta.url), {type: 'module'});
        worker.addEventListener('message', ({data}) => {
            const waiting = this.waiting.get(data.id);
            this.waiting.delete(data.id);
            if ('error' in data) waiting?.reject(new Error(data.error));
            else waiting?.resolve(data.reply as never);
        });
        worker.addEventListener('error', event => this.fail(event.message || 'it could not be loaded'));
        return worker;
    }

    /// A worker that died answers nothing more: all that wait are told, and a new one is started.
    private fail(reason: string): void {
        for (const {reject} of this.waiting.values()) reject(new Error(`The worker that filters environments stopped: ${reason}.`));
        this.waiting.clear();
        this.worker.terminate();
        this.worker = this.start();
    }
}
