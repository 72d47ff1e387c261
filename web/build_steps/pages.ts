// What the pages have in common: of all of them the head, and of those that teach the title, the header and the footer too. The file of such a page holds only what
// its own <main> shows below the title.

import type {Plugin} from 'vite';
import {lessons, listTitle, type LessonEntry} from '../learn/common/lessons';

const shared = `
        <meta charset="utf-8" />
        <meta name="viewport" content="width=device-width, initial-scale=1, viewport-fit=cover" />
        <meta name="color-scheme" content="light dark" />
        <link rel="icon" href="/icon.svg" type="image/svg+xml" />`;

const escaped = (text: string) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/"/g, '&quot;');
const link = (href: string, text: string, rel = '') => `<a href="${href}"${rel && ` rel="${rel}"`}>${escaped(text)}</a>`;

/// Puts a page that teaches around its own part. up: from its folder to learn/.
function framed(main: string, {title, about}: Omit<LessonEntry, 'name'>, up: string, {script = '', header = '', footer = ''}): string {
    return `<!doctype html>
<html lang="en">
    <head>${shared}
        <meta name="description" content="${escaped(about)}" />
        <title>${escaped(title)} – Domelight</title>
        <link rel="stylesheet" href="/learn/common/lesson.css" />
        ${script && `<script type="module" src="${script}"></script>`}
    </head>
    <body>
        <header><nav aria-label="Domelight">${link(`${up}../index.html`, 'Domelight')}${header}</nav></header>
        <main>
            <h1>${escaped(title)}</h1>
            ${main}
        </main>
        ${footer && `<footer><nav aria-label="Neighbouring pages">${footer}</nav></footer>`}
    </body>
</html>
`;
}

function lessonPage(main: string, at: number): string {
    const lesson = lessons[at]!, neighbour = (k: number, word: string, rel: string) => (lessons[k] ? link(`../${lessons[k].name}/index.html`, `${word}: ${lessons[k].title}`, rel) : '');
    return framed(main, lesson, '../', {
        script: `/learn/${lesson.name}/page.ts`, header: `${link('../index.html', 'All pages')}<span>${at + 1} of ${lessons.length}</span>`,
        footer: [neighbour(at - 1, 'Previous', 'prev'), link('../index.html', 'All pages'), neighbour(at + 1, 'Next', 'next')].join(''),
    });
}

function listPage(main: string): string {
    const list = lessons.map(({name, title, about}) => `<li>${link(`${name}/index.html`, title)}<p>${escaped(about)}</p></li>`).join('');
    return framed(`${main}<ol id="pages">${list}</ol>`, listTitle, '', {});
}

export function commonParts(): Plugin {
    return {
        name: 'common-parts',
        transformIndexHtml: {
            order: 'pre',
            handler(html, {path}) {
                const folder = /^\/learn\/(?:([^/]+)\/)?(?:index\.html)?$/.exec(path);
                if (!folder) return html.replace('<head>', `<head>${shared}`);
                if (!folder[1]) return listPage(html);
                const at = lessons.findIndex(({name}) => name === folder[1]);
                if (at < 0) throw new Error(`learn/common/lessons.ts does not list the page ${folder[1]}`);
                return lessonPage(html, at);
            },
        },
    };
}
