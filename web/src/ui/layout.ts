// The parts of the page.

import {modes, type State, type Store} from '../state';
import {button, ChoiceControl, element} from './controls';
import type {keyTable} from './keys';
import {modeNames, modeNotes, otherNames} from './labels';

/// A hint that can be read again in the panel stays so long.
const k_hint_ms = 10_000;

export interface Layout {
    canvas: HTMLCanvasElement;
    caption: HTMLElement;
    status: HTMLElement;
    panel: HTMLElement;
    tools: HTMLElement;
    divider: HTMLElement;
    /// Says what is being worked on; empty text hides it.
    work: (what: string) => void;
    /// Shows a sentence on what went wrong until it is closed.
    complain: (sentence: string) => void;
    /// Shows a sentence for a while.
    tell: (sentence: string) => void;
    /// Takes all sentences away.
    clear: () => void;
    drop: HTMLElement;
    /// Says what stands where. progress: of a picture that is on its way; mapped: whether FLIP is known.
    name: (state: State, progress: string, mapped: boolean) => void;
}

export function layOut(store: Store): Layout {
    const canvas = element('canvas', {tabIndex: 0});
    canvas.setAttribute('role', 'img');
    canvas.setAttribute('aria-label', 'The lit model. Arrow keys orbit, plus and minus come nearer and go farther, the question mark lists all keys.');
    const view = element('main', {id: 'view'}, canvas);
    const header = document.querySelector('header')!, caption = header.querySelector('p')!;  // in the page's own text, which is shown first
    const status = element('div', {id: 'status', className: 'surface'});
    const tags: [HTMLElement, HTMLElement] = [element('div', {className: 'tag surface', hidden: true}), element('div', {className: 'tag surface', hidden: true})];

    const choice = new ChoiceControl(store, 'mode', 'Method of shading', modes.map(mode => [mode, modeNames[mode], modeNotes[mode]] as const));
    choice.querySelector('legend')!.className = 'sr';
    choice.querySelectorAll('label span').forEach((span, k) => span.prepend(element('kbd', {ariaHidden: 'true'}, `${k + 1}`)));
    const bar = element('nav', {id: 'modes', className: 'surface', ariaLabel: 'Methods'}, choice);

    const tools = element('div', {id: 'tools'});
    const panel = element('div', {tabIndex: -1});
    const aside = element('aside', {id: 'panel', className: 'surface', ariaLabel: 'Settings'}, tools, panel);
    const unfold = button('☰', () => store.set({panel: true}), 'Show the panel (H)');
    unfold.id = 'unfold';
    unfold.className = 'surface';
    unfold.setAttribute('aria-label', 'Show the panel');
    const divider = dividerOf(store);
    const progress = element('div', {id: 'progress', hidden: true});
    const busy = element('div', {className: 'tag surface', id: 'busy', hidden: true});
    const spoken = element('div', {className: 'sr', role: 'status'});
    const notes = element('div', {id: 'notes', role: 'alert'});
    const drop = element('div', {id: 'drop', hidden: true}, element('p', {}, 'Drop environments and models anywhere'));
    view.append(divider, ...tags, status);
    document.body.prepend(view);
    document.body.append(bar, unfold, aside, notes, drop, progress, busy, spoken);

    const say = (sentence: string, className: string) => {
        const note = element('div', {className}, element('p', {}, sentence), button('Close', () => note.remove()));
        notes.append(note);
        while (notes.children.length > 3) notes.firstElementChild!.remove();
        return note;
    };
    const fold = () => document.body.classList.toggle('folded', !store.state.panel);
    fold();
    store.listen(changed => changed.has('panel') && fold());
    return {
        canvas, caption, status, panel, tools, divider, drop,
        name: ({view, mode, other, divider}, progress, mapped) => {
            const [left, right] = tags;
            left.hidden = view !== 'split';
            right.hidden = view === 'one';
            left.textContent = modeNames[mode];
            right.textContent = (view === 'difference' || (view === 'flip' && !mapped) ? `Difference: ${modeNames[mode]}, ` : view === 'flip' ? `FLIP: ${modeNames[mode]}, ` : '') + otherNames[other] + (progress && ` · ${progress}`);
            left.style.right = `${100 - 100 * divider}%`;
            right.style.left = view === 'split' ? `${100 * divider}%` : 'var(--gap)';
        },
        work: what => {
            progress.hidden = busy.hidden = what === '';
            busy.textContent = what && `${what} …`;
            spoken.textContent = what;
        },
        complain: sentence => say(sentence, 'surface'),
        tell: sentence => {
            const note = say(sentence, 'surface hint'), leave = () => (note.matches(':hover, :focus-within') ? setTimeout(leave, k_hint_ms) : note.remove());
            setTimeout(leave, k_hint_ms);
        },
        clear: () => notes.replaceChildren(),
    };
}

/// The line between two panes, to be dragged or moved by arrow keys.
function dividerOf(store: Store): HTMLElement {
    const divider = element('div', {id: 'divider', tabIndex: 0, role: 'slider', ariaLabel: 'Divider between the two methods', ariaValueMin: '0', ariaValueMax: '100'});
    const place = () => {
        divider.hidden = store.state.view !== 'split';
        divider.style.left = `${100 * store.state.divider}%`;
        divider.ariaValueNow = String(Math.round(100 * store.state.divider));
    };
    place();
    store.listen(place);
    const to = (x: number) => store.set({divider: Math.min(1, Math.max(0, x))});
    divider.addEventListener('pointerdown', event => divider.setPointerCapture(event.pointerId));
    divider.addEventListener('pointermove', event => divider.hasPointerCapture(event.pointerId) && to(event.clientX / innerWidth));
    divider.addEventListener('keydown', event => {
        const step = {ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1}[event.key];
        if (step === undefined) return;
        event.preventDefault();
        to(store.state.divider + step);
    });
    return divider;
}

export function helpDialog(keys: ReturnType<typeof keyTable>): HTMLDialogElement {
    const list = element('dl');
    const line = (shown: (Node | string)[], what: string) => list.append(element('dt', {}, ...shown), element('dd', {}, what));
    line(['Drag'], 'orbit; with Shift, turn the light; with the right button or two fingers, move');
    line(['Wheel, pinch'], 'nearer, farther');
    line(['Double click'], 'look closer at that point; beside the model, at all of it');
    for (const {shown, what} of keys)
        if (what) line(shown.flatMap(key => (key === '…' ? [' … '] : [element('kbd', {}, key), ' '])), what);
    const dialog = element('dialog', {ariaLabel: 'Help'}, element('h2', {tabIndex: -1, autofocus: true}, 'Domelight'),
        element('p', {}, 'See a model lit by a photograph, by every method of image-based lighting, and the error of each. Drop an environment and a model ' +
                         '(.glb, .gltf with its files) anywhere. Everything is computed in this page: nothing is uploaded.'),
        element('p', {}, 'How it works: ', element('a', {href: 'learn/index.html'}, 'short interactive pages'), ', each with its equation and its code.'),
        list, element('form', {method: 'dialog'}, element('button', {}, 'Close')));
    dialog.addEventListener('close', () => (document.activeElement as HTMLElement | null)?.blur());
    document.body.append(dialog);
    return dialog;
}
