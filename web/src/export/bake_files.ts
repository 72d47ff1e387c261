// The page's side of that worker.

import type {BakedFiles, ExportReply, ExportRequest} from './export_worker';

/// Bakes for an engine. progress: from 0 to 1. Rejects with a sentence.
export function bakeFiles(request: ExportRequest, progress: (part: number) => void): Promise<BakedFiles> {
    const worker = new Worker(new URL('./export_worker.ts', import.meta.url), {type: 'module'});
    return new Promise<BakedFiles>((resolve, reject) => {
        worker.addEventListener('message', ({data}: MessageEvent<ExportReply>) => {
            if ('progress' in data) progress(data.progress);
            else if ('error' in data) reject(new Error(data.error));
            else resolve(data);
        });
        worker.addEventListener('error', event => reject(new Error(`The worker that bakes files stopped: ${event.message || 'it could not be loaded'}.`)));
        worker.postMessage(request);
    }).finally(() => worker.terminate());
}
