// Asks the worker for comparisons, one at a time; while it works, only the newest request waits.

import type {Comparison, Pictures} from './compare_worker';

export class Comparer {
    private readonly worker = new Worker(new URL('./compare_worker.ts', import.meta.url), {type: 'module'});
    private busy = false;
    private next: (() => Promise<Pictures>) | null = null;

    constructor(done: (result: Comparison) => void) {
        this.worker.addEventListener('message', ({data}: MessageEvent<Comparison>) => {
            this.busy = false;
            done(data);
            if (this.next) void this.ask(this.next);
        });
    }

    /// read: called when the worker is free, to read the pictures as they are then.
    async ask(read: () => Promise<Pictures>): Promise<void> {
        this.next = null;
        if (this.busy) {
            this.next = read;
            return;
        }
        this.busy = true;
        const pictures = await read().catch(() => null);  // the graphics card may be lost
        this.busy = pictures !== null;
        if (pictures) this.worker.postMessage(pictures, [pictures.test.buffer, pictures.reference.buffer, pictures.objects.buffer]);
    }
}
