// Keys, and what the help says of them.

import {isPicture, modes, type Store} from '../state';
import {orbit, turnLight} from './pointer';

interface Key {
    /// As KeyboardEvent.key has it, in lower case.
    keys: string[];
    shown: string[];
    what: string;
    act: (event: KeyboardEvent) => void;
}

export interface Actions {
    open: () => void;
    help: () => void;
    screenshot: () => void;
    resetView: () => void;
    /// factor: of the distance.
    zoom: (factor: number) => void;
    nextEnvironment: (step: number) => void;
    /// Puts the path tracer's picture beside the method.
    truth: () => void;
}

export function keyTable(store: Store, actions: Actions): Key[] {
    const toggleView = (view: 'split' | 'difference' | 'flip') => store.set({view: store.state.view === view ? 'one' : view});
    const step = 0.12;
    return [
        {keys: modes.map((_, k) => `${k + 1}`), shown: ['1', '…', `${modes.length}`], what: 'the methods of shading', act: e => store.set({mode: modes[Number(e.key) - 1]!})},
        {keys: ['s'], shown: ['S'], what: 'split screen, with a divider to drag', act: () => toggleView('split')},
        {keys: ['a', 'b', ' '], shown: ['A', 'Space'], what: 'flip between the two methods', act: () => flipSides(store)},
        {keys: ['d'], shown: ['D'], what: 'difference of the displayed values', act: () => toggleView('difference')},
        {keys: ['e'], shown: ['E'], what: 'FLIP, the visible difference', act: () => toggleView('flip')},
        {keys: ['['], shown: ['[', ']'], what: 'exposure, by a third of a stop', act: () => store.set({exposure: limit(store.state.exposure - 1 / 3, 12)})},
        {keys: [']'], shown: [], what: '', act: () => store.set({exposure: limit(store.state.exposure + 1 / 3, 12)})},
        {keys: ['arrowleft', 'arrowright'], shown: ['←', '→'], what: 'orbit; with Shift, turn the light', act: e => {
            const side = e.key === 'ArrowLeft' ? -1 : 1;
            if (e.shiftKey) turnLight(store, -5 * side);
            else orbit(store, -step * side, 0);
        }},
        {keys: ['arrowup', 'arrowdown'], shown: ['↑', '↓'], what: 'look from higher or lower', act: e => orbit(store, 0, e.key === 'ArrowUp' ? step : -step)},
        {keys: ['+', '='], shown: ['+', '−'], what: 'nearer, farther', act: () => actions.zoom(0.9)},
        {keys: ['-'], shown: [], what: '', act: () => actions.zoom(1 / 0.9)},
        {keys: ['r'], shown: ['R'], what: 'show the whole model', act: actions.resetView},
        {keys: ['w'], shown: ['W'], what: 'white furnace: light of 1 from everywhere', act: () => store.set({furnace: !store.state.furnace})},
        {keys: ['l'], shown: ['L'], what: 'objects see their neighbours, by live cubes', act: () => store.set({live: !store.state.live})},
        {keys: ['m'], shown: ['M'], what: 'let the model move', act: () => store.set({motion: !store.state.motion})},
        {keys: ['i'], shown: ['I'], what: 'light by the probes, where a set is open, or by the environment', act: () => store.set({probes: !store.state.probes})},
        {keys: ['g'], shown: ['G'], what: 'show where the probes stand', act: () => store.set({probeBalls: !store.state.probeBalls})},
        {keys: ['t'], shown: ['T'], what: 'the path-traced truth beside it, then over the whole picture, where domelight view serves the page', act: actions.truth},
        {keys: ['n'], shown: ['N'], what: 'the next environment, with Shift the one before: every one that was opened is kept', act: e => actions.nextEnvironment(e.shiftKey ? -1 : 1)},
        {keys: ['o'], shown: ['O'], what: 'open files', act: actions.open},
        {keys: ['p'], shown: ['P'], what: 'save a screenshot', act: actions.screenshot},
        {keys: ['h'], shown: ['H'], what: 'fold the panel away', act: () => store.set({panel: !store.state.panel})},
        {keys: ['?'], shown: ['?'], what: 'this help', act: actions.help},
    ];
}

const limit = (v: number, most: number) => Math.round(Math.min(most, Math.max(-most, v)) * 1000) / 1000;

/// A becomes B: the other method takes the place of this one. A picture stays what this one is compared with: it is shown over the whole pane, or not.
function flipSides(store: Store): void {
    const {mode, other} = store.state;
    if (isPicture(other)) store.set({view: store.state.view === 'other' ? 'one' : 'other'});
    else store.set({mode: other, other: mode});
}

/// Whether a key belongs to the control that has the focus.
function takes(target: HTMLElement, key: string): boolean {
    if (target.closest('button, summary')) return key === ' ' || key === 'Enter';
    const field = target.closest('input, select, textarea, [role="slider"]') as HTMLInputElement | null;
    if (!field) return false;
    return !['radio', 'checkbox', 'range'].includes(field.type) || /^(Arrow|Home|End|Page| |Tab)/.test(key);
}

export function bindKeys(table: Key[]): void {
    addEventListener('keydown', event => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
        const target = event.target as HTMLElement;
        if (target.closest('dialog[open]') || takes(target, event.key)) return;
        const key = table.find(({keys}) => keys.includes(event.key.toLowerCase()));
        if (!key) return;
        event.preventDefault();
        key.act(event);
    });
}
