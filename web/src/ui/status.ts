// The line below the picture: samples, and what is under the pointer.

import type {App} from '../app';
import {element} from './controls';

export class Status {
    private readonly left = element('span');
    private readonly value = element('span');
    private readonly range = element('span', {title: 'Whether highlights are brighter than white: see Light and picture'});

    constructor(
        private readonly app: App,
        root: HTMLElement,
    ) {
        root.append(this.left, this.value, this.range);
    }

    /// Called after each frame.
    update(): void {
        const {state, stage} = this.app, {count} = stage.panes[0];
        this.range.textContent = this.app.dynamicRange;
        const noisy = state.mode === 'monte-carlo';
        const n = noisy ? count * state.samples : count;
        this.left.replaceChildren(element('b', {}, `${n}`), noisy ? ' samples a pixel' : count === 1 ? ' frame averaged' : count < 64 ? ' frames averaged' : ' frames averaged: done', this.app.reduced < 1 ? `, at ${this.app.reduced} of the resolution while it moves` : '');
    }

    /// The radiance of a pixel, in device pixels from the upper left corner; null: of none.
    showPixel(pixel: {x: number; y: number; rgb: [number, number, number]} | null): void {
        if (!pixel) return this.value.replaceChildren();
        const {x, y, rgb} = pixel;
        const luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        const stop = luminance > 0 ? `${Math.log2(luminance).toFixed(1)} EV` : 'black';
        this.value.replaceChildren(`(${x}, ${y})  `, element('b', {}, rgb.map(v => v.toPrecision(3)).join('  ')), `  ${stop}`);
    }
}
