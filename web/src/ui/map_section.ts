// The environment as a lat-long picture, with what the methods do on it: sample positions, density, the lobe under the pointer.

import * as THREE from 'three';
import type {App} from '../app';
import {harmonicsError, type HarmonicsError} from '../bake/harmonics';
import {k_bins_per_ev, k_least_ev, type Survey} from '../bake/types';
import {heatColour} from '../compare/heat';
import {radians} from '../scene/framing';
import {button, element} from './controls';
import {note, section} from './panel';

const k_samples = 512;
/// The error that has the brightest colour of the overlay.
const k_full_error = 0.25;
type Overlay = 'samples' | 'density' | 'lobe' | 'harmonics';

export class MapSection {
    readonly root: HTMLDetailsElement;
    private readonly canvas = element('canvas', {className: 'plot', role: 'img', ariaLabel: 'The environment as a lat-long map'});
    private readonly facts = note();
    private readonly plot = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    private readonly overlays = new Set<Overlay>();
    private survey?: Survey;
    private samples?: Float32Array;
    private harmonics?: HarmonicsError;
    private readonly harmonicsText = note();
    private lobe: {direction: THREE.Vector3; roughness: number} | null = null;

    constructor(private readonly app: App) {
        const toggle = (overlay: Overlay, text: string, title: string) => {
            const made = button(text, () => {
                if (!this.overlays.delete(overlay)) this.overlays.add(overlay);
                made.ariaPressed = String(this.overlays.has(overlay));
                void this.draw();
            }, title);
            made.ariaPressed = 'false';
            return made;
        };
        this.plot.setAttribute('class', 'plot');
        this.plot.setAttribute('role', 'img');
        this.plot.setAttribute('viewBox', '0 0 288 64');
        this.root = section('Environment map', false, this.canvas,
            element('div', {className: 'row'}, toggle('samples', 'Samples', `${k_samples} light directions, drawn by luminance`),
                    toggle('density', 'Density', 'With which directions are drawn, logarithmic'), toggle('lobe', 'Lobe', 'The GGX lobe of the point under the pointer'),
                    toggle('harmonics', 'SH', 'How far nine harmonics are from the exact irradiance: black 0, yellow a quarter of its mean or more')),
            this.harmonicsText,
            this.plot as unknown as HTMLElement, this.facts);
        this.root.addEventListener('toggle', () => void this.load());
        app.onOpened(() => {
            this.survey = this.samples = undefined;
            this.harmonics = undefined;
            void this.load();
        });
        app.store.listen(changed => ['exposure', 'tonemap', 'turn'].some(key => changed.has(key as never)) && void this.draw());
    }

    /// The lobe that a surface reflects: its middle, towards the light, and the roughness.
    setLobe(lobe: {direction: THREE.Vector3; roughness: number} | null): void {
        this.lobe = lobe;
        if (this.overlays.has('lobe') && this.root.open) void this.draw();
    }
    get wantsLobe(): boolean {
        return this.root.open && this.overlays.has('lobe');
    }

    private async load(): Promise<void> {
        if (!this.root.open || this.survey) return;
        this.survey = await this.app.baker.survey(128);
        this.drawHistogram(this.survey);
        await this.draw();
    }

    private async draw(): Promise<void> {
        const {survey} = this;
        if (!survey || !this.root.open) return;
        if (this.overlays.has('samples')) this.samples ??= await this.app.baker.samples(k_samples);
        if (this.overlays.has('harmonics') && this.app.bake) this.harmonics ??= await harmonicsError(this.app.baker, this.app.bake.sh);
        this.tellHarmonics();
        const {width, height, pixels} = survey.thumbnail, context = this.canvas.getContext('2d')!;
        this.canvas.width = width;
        this.canvas.height = height;
        const picture = context.createImageData(width, height), scale = 2 ** this.app.state.exposure, show = (v: number) => 255 * Math.min(1, (v * scale) / (1 + v * scale) * 1.2) ** (1 / 2.2);
        const lobe = this.overlays.has('lobe') && this.lobe ? this.lobeShape(this.lobe) : null;
        for (let y = 0, k = 0; y < height; ++y)
            for (let x = 0; x < width; ++x, ++k) {
                const r = pixels[3 * k]!, g = pixels[3 * k + 1]!, b = pixels[3 * k + 2]!;
                let colour: [number, number, number] = [show(r), show(g), show(b)];
                if (this.overlays.has('density')) colour = heatColour(0.5 + Math.log2((0.2126 * r + 0.7152 * g + 0.0722 * b) / survey.meanLuminance + 1e-9) / 14);
                if (this.overlays.has('harmonics') && this.harmonics) colour = heatColour(errorAt(this.harmonics, (x + 0.5) / width, (y + 0.5) / height) / k_full_error);
                const part = lobe ? lobe((x + 0.5) / width, (y + 0.5) / height) : 0;
                picture.data.set([colour[0] + (80 - colour[0]) * part, colour[1] + (255 - colour[1]) * part, colour[2] + (120 - colour[2]) * part, 255], 4 * k);
            }
        context.putImageData(picture, 0, 0);
        if (this.overlays.has('samples') && this.samples) this.drawSamples(context, this.samples, width, height);
    }

    private tellHarmonics(): void {
        const {harmonics} = this;
        this.harmonicsText.hidden = !this.overlays.has('harmonics') || !harmonics;
        if (harmonics) this.harmonicsText.textContent = `Nine harmonics against the exact irradiance: RMS ${percent(harmonics.rms)} of its mean, at most ${percent(harmonics.most)}.`;
    }

    /// The lobe's share at a point of the map, 0 to 0.85: D of GGX about the mirror direction, with n = v = r.
    private lobeShape({direction, roughness}: {direction: THREE.Vector3; roughness: number}): (u: number, v: number) => number {
        const turned = direction.clone().applyAxisAngle(new THREE.Vector3(0, 1, 0), radians(this.app.state.turn)), alpha2 = Math.max(0.03, roughness) ** 4;
        return (u, v) => {
            const phi = (u - 0.5) * 2 * Math.PI, theta = v * Math.PI;
            const c = Math.sin(theta) * Math.cos(phi) * turned.x + Math.cos(theta) * turned.y + Math.sin(theta) * Math.sin(phi) * turned.z;
            return c > 0 ? 0.85 * c * (2 * alpha2 / (alpha2 * (1 + c) + 1 - c)) ** 2 : 0;
        };
    }

    private drawSamples(context: CanvasRenderingContext2D, samples: Float32Array, width: number, height: number): void {
        context.fillStyle = '#ff4fd8';
        for (let k = 0; k < samples.length; k += 2) context.fillRect(samples[k]! * width - 0.75, samples[k + 1]! * height - 0.75, 1.5, 1.5);
    }

    private drawHistogram({histogram, meanLuminance, peakLuminance}: Survey): void {
        const most = Math.max(...histogram), ev = (bin: number) => k_least_ev + bin / k_bins_per_ev;
        const used = [...histogram.keys()].filter(k => histogram[k]! > 1e-6), from = Math.min(...used) - 1, to = Math.max(...used) + 2, step = 288 / (to - from);
        const bars = used.map(k => `M${((k - from) * step).toFixed(1)} 52v${(-48 * Math.sqrt(histogram[k]! / most)).toFixed(1)}h${(step * 0.86).toFixed(1)}V52z`).join('');
        const labels = [];
        for (let e = Math.ceil(ev(from) / 2) * 2; e <= ev(to); e += 2) labels.push(`<text x="${(((e - k_least_ev) * k_bins_per_ev - from) * step).toFixed(1)}" y="62" text-anchor="middle">${e}</text>`);
        this.plot.innerHTML = `<path class="area" d="${bars}"/><path class="axis" d="M0 52H288"/>${labels.join('')}`;
        this.plot.setAttribute('aria-label', `Histogram of the luminance in stops, from ${ev(from).toFixed(0)} to ${ev(to).toFixed(0)} EV`);
        const stops = Math.log2(peakLuminance / meanLuminance);
        this.facts.textContent = `Luminance in EV by solid angle. Mean ${meanLuminance.toPrecision(3)}, brightest ${peakLuminance.toPrecision(3)}, ${stops.toFixed(1)} stops above the mean.`;
    }
}

const percent = (part: number) => `${(100 * part).toPrecision(2)} %`;
const errorAt = ({width, height, errors}: HarmonicsError, u: number, v: number) => Math.abs(errors[Math.floor(v * height) * width + Math.floor(u * width)]!);
