// Whether the graphics card has done what it was given. The page gives it more only then, so that no call of the page has to wait for the card.

import type * as THREE from 'three';

const k_pause_ms = 4;

export class Backlog {
    private sync: WebGLSync | null = null;
    private readonly gl: WebGL2RenderingContext;

    constructor(renderer: THREE.WebGLRenderer) {
        this.gl = renderer.getContext() as WebGL2RenderingContext;
    }

    /// Called after something was given to the card.
    mark(): void {
        this.gl.deleteSync(this.sync);
        this.sync = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        this.gl.flush();
    }
    /// What was given before belongs to a context that is lost.
    forget(): void {
        this.sync = null;
    }
    get done(): boolean {
        const {gl, sync} = this;
        if (sync && !gl.isContextLost() && gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
        gl.deleteSync(sync);
        this.sync = null;
        return true;
    }
    async emptied(): Promise<void> {
        while (!this.done) await new Promise(resolve => setTimeout(resolve, k_pause_ms));
    }
}
