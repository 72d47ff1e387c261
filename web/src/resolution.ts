// How many pixels are drawn: all of the screen's while nothing moves, and fewer while something does, where frames take long.

/// What a frame may take while something moves.
const k_fluent_ms = 100;
const k_rest_ms = 400;
const scales = [1, 0.5, 0.25];

export class Resolution {
    private moving = false;
    private movedAt = -Infinity;
    private last = -Infinity;
    /// Of a frame of all pixels, in milliseconds, as it was lately.
    private cost = 0;

    /// Drawn pixels per pixel of the screen, along each side.
    get scale(): number {
        return this.moving ? (scales.find(scale => this.cost * scale ** 2 <= k_fluent_ms) ?? scales.at(-1)!) : 1;
    }
    /// Something that is seen has changed.
    move(now: number): void {
        this.moving = true;
        this.movedAt = now;
    }
    /// Told when a frame begins that follows the one before without a pause, and at what scale that was drawn.
    frame(now: number, drawn: number): void {
        const cost = (now - this.last) / drawn ** 2;
        if (this.last > 0) this.cost = this.cost === 0 ? cost : 0.7 * this.cost + 0.3 * Math.min(cost, 4 * this.cost);
        this.last = now;
        this.moving &&= now - this.movedAt < k_rest_ms;
    }
    pause(): void {
        this.last = -Infinity;
        this.moving = false;
    }
}
