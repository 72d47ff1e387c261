// How the noise of live Monte Carlo falls with the number of samples.

import type {App} from '../app';
import {readPixels} from '../render/read_back';
import {onlyWhere} from './controls';
import {note, section} from './panel';

const k_width = 288, k_height = 110, k_most_doublings = 14, k_decades = 3;

export class NoiseSection {
    readonly root: HTMLElement;
    private readonly plot = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    private readonly text = note();
    private points: [samples: number, error: number][] = [];
    private last?: {count: number; pixels: Float32Array};
    private asked = 0;
    /// Grows with each new picture: what is read of an earlier one does not count.
    private series = 0;

    constructor(private readonly app: App) {
        this.plot.setAttribute('class', 'plot');
        this.plot.setAttribute('role', 'img');
        this.plot.setAttribute('viewBox', `0 0 ${k_width} ${k_height}`);
        this.root = onlyWhere(app.store, section('Noise', true, this.plot as unknown as HTMLElement, this.text), s => s.mode === 'monte-carlo');
        this.draw();
    }

    /// Called after each frame. With 2, 4, 8, ... frames the mean is compared with that of its first half: the two halves are independent, so
    /// that the standard deviation of (first - second) / 2, which is first - mean, is the standard error of the mean.
    update(): void {
        const {state, stage} = this.app, pane = stage.panes[0];
        if (state.mode !== 'monte-carlo') return;
        if (pane.count <= 1) {
            this.points = [];
            this.last = undefined;
            ++this.series;
        }
        if (pane.count > 1 && (pane.count & (pane.count - 1)) === 0 && pane.count !== this.asked) void this.measure(pane.count, state.samples);
        this.asked = pane.count;
    }
    private async measure(count: number, samples: number): Promise<void> {
        const {series} = this, pixels = await readPixels(this.app.stage, 0).catch(() => null);
        if (!pixels || series !== this.series) return;
        if (this.last && count === 2 * this.last.count && pixels.length === this.last.pixels.length) this.points.push([count * samples, relativeError(this.last.pixels, pixels)]);
        this.last = {count, pixels};
        this.draw();
    }

    private draw(): void {
        const x = (samples: number) => 34 + (Math.log2(samples) / k_most_doublings) * (k_width - 42), y = (error: number) => 6 + (-Math.log10(error) / k_decades) * (k_height - 26);
        const path = (points: [number, number][]) => points.map(([n, e], k) => `${k ? 'L' : 'M'}${x(n).toFixed(1)} ${y(Math.min(1, e)).toFixed(1)}`).join('');
        const labels = [1, 0.1, 0.01, 0.001].map(e => `<text x="30" y="${(y(e) + 3).toFixed(0)}" text-anchor="end">${e}</text>`);
        for (let k = 0; k < k_most_doublings; k += 2) labels.push(`<text x="${x(2 ** k).toFixed(0)}" y="${k_height - 6}" text-anchor="middle">${2 ** k}</text>`);
        const [n, e] = this.points.at(-1) ?? [0, 0];
        const ideal = this.points.length > 1 ? path(this.points.map(([m]) => [m, e * Math.sqrt(n / m)])) : '';
        this.plot.innerHTML = `<path class="axis" d="M34 6V${k_height - 20}H${k_width - 8}"/>${labels.join('')}<path class="ideal" d="${ideal}"/><path class="line" d="${path(this.points)}"/>`;
        this.text.textContent = n ? `After ${n} samples a pixel: relative error ${(100 * e).toPrecision(2)} % (RMS of L / (1 + L)). Dashed: 1 / √n.` : 'The error by the number of samples, as they come in.';
        this.plot.setAttribute('aria-label', `Noise by samples. ${this.text.textContent}`);
    }
}

/// The standard error of the second mean, from the mean of its first half: RMS of L / (1 + L).
function relativeError(half: Float32Array, all: Float32Array): number {
    let sum = 0;
    for (let k = 0; k < all.length; ++k) sum += (half[k]! / (1 + half[k]!) - all[k]! / (1 + all[k]!)) ** 2;
    return Math.sqrt(sum / all.length);
}
