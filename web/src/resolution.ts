// How many pixels are drawn: all of the screen's, or fewer where frames are slow.

const k_slow_ms = 200;
const k_least = 0.25;

export class Resolution {
    /// Drawn pixels per pixel of the screen, along each side.
    scale = 1;
    private slow = 0;
    private last = 0;

    /// Told when a frame begins that follows the one before without a pause. Whether fewer pixels should be drawn from now on.
    frame(now: number, full: boolean): boolean {
        const time = now - this.last;
        this.last = now;
        this.slow = time > k_slow_ms && time < 20 * k_slow_ms ? this.slow + 1 : 0;
        if (full || this.slow < 2 || this.scale <= k_least) return false;
        this.slow = 0;
        this.scale /= 2;
        return true;
    }
    pause(): void {
        this.last = -Infinity;
    }
}
