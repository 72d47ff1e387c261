// What the pages need of a browser.

/// A sentence on what this browser lacks; empty where it lacks nothing.
export function whatIsMissing(): string {
    const probe = document.createElement('canvas').getContext('webgl2');
    if (!probe) return 'This browser has no WebGL2, which this page needs. Try another browser, or switch on hardware acceleration.';
    return probe.getExtension('EXT_color_buffer_float') ? '' : 'This graphics card cannot draw into floating-point pictures (EXT_color_buffer_float), which this page needs.';
}
