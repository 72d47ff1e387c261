// The package in Deno, as npm installs it there: the same levels as in Node.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {test} from 'node:test';
import {load} from 'domelight/library';

const deno = path.join(path.dirname(import.meta.dirname), 'node_modules/.bin/deno');

test('in Deno the worker gives what it gives in Node', {skip: !fs.existsSync(deno) && 'there is no Deno'}, async () => {
    const script = path.join(import.meta.dirname, 'deno_page.mjs');
    const found = JSON.parse(execFileSync(deno, ['run', '--allow-read', '--no-prompt', script], {encoding: 'utf8', timeout: 60_000}));
    const dl = await load(), data = Float32Array.from({length: 3 * 64 * 32}, (_, k) => 0.1 + (k * 2654435761 % 1024) / 1024);
    const {levels} = dl.prefilter(dl.fromPixels({data, width: 64, height: 32}), {size: 16, levels: 2});
    assert.deepEqual(found.level, [...levels[1].data]);
    assert.deepEqual([found.file.length, found.ended], [24, 'AbortError']);
});
