// Lays the page out, and has its program come when that is on the screen: it takes a moment.

import {Baker} from './bake/baker';
import {readSession} from './served';
import {Store} from './state';
import {bindDrops} from './ui/files';
import {layOut} from './ui/layout';

const store = new Store(location.hash);
if (innerWidth < 700 && !location.hash.includes('panel')) store.state.panel = false;
const layout = layOut(store);
performance.mark('laid out');
const baker = new Baker();  // its module is compiled meanwhile
const session = readSession();

/// Files that are dropped before the program is there wait for it.
const waiting: File[] = [];
let open: (files: File[]) => void = files => void waiting.push(...files);
bindDrops(layout.drop, files => open(files));

async function begin(): Promise<void> {
    const {start} = await import('./start'), openFiles = await start({store, layout, baker, session});
    document.body.classList.add('started');
    if (openFiles) open = openFiles;
    if (openFiles && waiting.length > 0) openFiles(waiting);
}
requestAnimationFrame(() => setTimeout(() => void begin()));
