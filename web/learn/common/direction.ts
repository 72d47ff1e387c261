// A direction that the user chooses: two sliders, and the pointer on a lat-long map.

import {radians, degrees} from '../../src/scene/framing';
import type {Values} from '../../src/state';
import {RangeControl} from '../../src/ui/controls';

/// In degrees. Azimuth 0 is +X, in the middle of a lat-long map, and 90 is +Z; elevation 90 is +Y.
export interface Direction {
    azimuth: number;
    elevation: number;
}

type Vector = [number, number, number];

export function vectorOf({azimuth, elevation}: Direction): Vector {
    const a = radians(azimuth), e = radians(elevation);
    return [Math.cos(e) * Math.cos(a), Math.sin(e), Math.cos(e) * Math.sin(a)];
}

/// The point (u, v) of a lat-long map that shows a direction of any length (docs/conventions.md).
export function latlongPoint([x, y, z]: Vector): [number, number] {
    return [0.5 + Math.atan2(z, x) / (2 * Math.PI), Math.atan2(Math.hypot(x, z), y) / Math.PI];
}

export function directionAt([u, v]: [number, number]): Direction {
    return {azimuth: 360 * u - 180, elevation: 90 - 180 * v};
}

export function directionOf([x, y, z]: Vector): Direction {
    return {azimuth: degrees(Math.atan2(z, x)), elevation: degrees(Math.atan2(y, Math.hypot(x, z)))};
}

const text = (v: number) => `${v.toFixed(1)}°`;

/// The sliders of a direction. what: "Normal", "Mirror direction".
export function directionControls<T extends Direction>(values: Values<T>, what: string): HTMLElement[] {
    const of = values as unknown as Values<Direction>;
    return [
        new RangeControl(of, 'azimuth', `${what}: azimuth`, {min: -180, max: 180, step: 0.5, text}),
        new RangeControl(of, 'elevation', `${what}: elevation`, {min: -90, max: 90, step: 0.5, text}),
    ];
}

/// Calls back with the point of an element, 0 to 1 each, that is pressed or dragged to. hover: also where a mouse is above it.
export function onDrag(canvas: HTMLElement, moved: (point: [number, number]) => void, hover = false): void {
    const tell = (event: PointerEvent) => {
        const box = canvas.getBoundingClientRect(), part = (v: number) => Math.min(1, Math.max(0, v));
        moved([part((event.clientX - box.left) / box.width), part((event.clientY - box.top) / box.height)]);
    };
    canvas.addEventListener('pointerdown', event => {
        canvas.setPointerCapture(event.pointerId);
        tell(event);
    });
    canvas.addEventListener('pointermove', event => (canvas.hasPointerCapture(event.pointerId) || (hover && event.pointerType === 'mouse')) && tell(event));
}

/// A ring at a point of a canvas, 0 to 1 each, that is seen on light and dark.
export function drawMark(context: CanvasRenderingContext2D, [u, v]: [number, number], radius = 7): void {
    const {width, height} = context.canvas, scale = Math.max(1, width / Math.max(1, context.canvas.clientWidth));
    for (const [style, line] of [['#000', 4], ['#fff', 2]] as const) {
        context.beginPath();
        context.arc(u * width, v * height, radius * scale, 0, 2 * Math.PI);
        context.strokeStyle = style;
        context.lineWidth = line * scale;
        context.stroke();
    }
}
