// What the pages need of a browser.

/// A sentence on what this browser lacks; empty where it lacks nothing. canvas: gets a context that three.js then uses, because a second one takes time.
export function whatIsMissing(canvas = document.createElement('canvas')): string {
    const probe = canvas.getContext('webgl2', {antialias: false, depth: false, stencil: false});
    if (!probe) return 'This browser has no WebGL2, which this page needs. Try another browser, or switch on hardware acceleration.';
    if (typeof Float16Array === 'undefined') return 'This browser has no Float16Array, which this page needs: Chrome 135, Firefox 129, Safari 18.2 or later have it.';
    return probe.getExtension('EXT_color_buffer_float') ? '' : 'This graphics card cannot draw into floating-point pictures (EXT_color_buffer_float), which this page needs.';
}
