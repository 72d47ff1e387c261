// The chunks of the app's program are fetched while the page is laid out, and run afterwards.

import type {Plugin, Rollup} from 'vite';

function withImports(bundle: Rollup.OutputBundle, file: string, found = new Set<string>()): Set<string> {
    const chunk = bundle[file];
    if (chunk?.type !== 'chunk' || found.has(file)) return found;
    found.add(file);
    for (const name of chunk.imports) withImports(bundle, name, found);
    return found;
}

/// Adds links to index.html that fetch a chunk, by its name, and what it imports.
export function preload(name: string): Plugin {
    return {
        name: 'preload',
        transformIndexHtml: {
            order: 'post',
            handler(_, {bundle, path}) {
                const chunk = path === '/index.html' && bundle && Object.values(bundle).find(file => file.type === 'chunk' && file.name === name);
                if (!chunk) return [];
                return [...withImports(bundle, chunk.fileName)].map(file => ({tag: 'link', attrs: {rel: 'modulepreload', crossorigin: true, href: `./${file}`}, injectTo: 'head' as const}));
            },
        },
    };
}
