// The list of the pages.

import {element} from '../src/ui/controls';
import {lessons} from './common/lessons';

const list = document.getElementById('pages')!;
for (const {name, title, about} of lessons) list.append(element('li', {}, element('a', {href: `${name}/index.html`}, title), element('p', {}, about)));
