// What is under the pointer: the pixel's radiance, and the lobe of the surface there.

import * as THREE from 'three';
import type {App} from '../app';
import {isPicture} from '../state';
import {Inspector} from '../render/inspector';
import type {MapSection} from './map_section';
import type {Status} from './status';

export class Hover {
    private place: [number, number] | null = null;
    private reading = false;
    private probing = false;
    private readonly inspector: Inspector;

    constructor(
        private readonly app: App,
        private readonly status: Status,
        private readonly map: MapSection,
    ) {
        this.inspector = new Inspector(app.stage);
    }

    /// x, y: in CSS pixels.
    at(x: number, y: number): void {
        const {width, height} = this.app.stage.panes[0];
        this.place = [Math.floor((x / innerWidth) * width), Math.floor((y / innerHeight) * height)];
        void this.refresh();
        if (this.map.wantsLobe && !this.probing) void this.showLobe();
    }

    /// The pointer is elsewhere.
    leave(): void {
        this.place = null;
        this.status.showPixel(null);
    }
    /// Reads the pixel again, because the picture has become better.
    async refresh(): Promise<void> {
        if (!this.place || this.reading || !this.app.ready) return;
        this.reading = true;
        const [x, y] = this.place, {stage, state} = this.app, {view, divider, other} = state;
        const right = view === 'other' || (view === 'split' && x / stage.panes[0].width > divider), picture = right && isPicture(other) ? stage.pictureAt(other, x, y) : null;
        if (picture) this.status.showPixel({x, y, rgb: picture});
        else await this.read(x, y, right && !isPicture(other) ? 1 : 0);
        this.reading = false;
    }
    private async read(x: number, y: number, pane: number): Promise<void> {
        const {stage} = this.app, {target, height} = stage.panes[pane]!, values = new Float32Array(4);
        await stage.renderer.readRenderTargetPixelsAsync(target, x, height - 1 - y, 1, 1, values).catch(() => {});
        if (this.place) this.status.showPixel({x, y, rgb: [values[0]!, values[1]!, values[2]!]});
    }

    private async showLobe(): Promise<void> {
        const [x, y] = this.place!, {stage} = this.app;
        this.probing = true;
        const reading = this.inspector.probe(x, y);
        const view = new THREE.Vector3(0, 0, 0.5).unproject(stage.camera).sub(stage.camera.position).normalize();  // the probe looked at this pixel alone
        const found = await reading;
        this.probing = false;
        this.map.setLobe(found && {direction: view.reflect(found.normal), roughness: found.roughness});
    }
}
