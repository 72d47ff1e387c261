// What is under the pointer: the pixel's radiance, and the lobe of the surface there.

import * as THREE from 'three';
import type {App} from '../app';
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

    /// Reads the pixel again, because the picture has become better.
    async refresh(): Promise<void> {
        if (!this.place || this.reading || !this.app.ready) return;
        this.reading = true;
        const [x, y] = this.place, {stage, state} = this.app, split = state.view === 'split' && x / stage.panes[0].width > state.divider && state.other !== 'picture' && state.other !== 'truth';
        const {target, height} = stage.panes[split ? 1 : 0]!, values = new Float32Array(4);
        await stage.renderer.readRenderTargetPixelsAsync(target, x, height - 1 - y, 1, 1, values).catch(() => {});
        this.status.showPixel(x, y, [values[0]!, values[1]!, values[2]!]);
        this.reading = false;
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
