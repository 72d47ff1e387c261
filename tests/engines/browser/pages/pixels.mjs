// Functions that every page uses for its pixels.

/// Loads classic scripts, for engines that are published in that form.
export function script(url) {
    return new Promise((resolve, reject) => {
        const element = Object.assign(document.createElement('script'), {src: url, onload: resolve, onerror: () => reject(new Error(`no ${url}`))});
        document.head.append(element);
    });
}

/// Float RGBA rows as text, to be returned from the browser. Rows of GL run upward, ours downward.
export function packed(rgba, width, height, upward = true) {
    const floats = new Float32Array(width * height * 4);
    for (let y = 0; y < height; ++y)
        floats.set(rgba.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (upward ? height - 1 - y : y));
    const bytes = new Uint8Array(floats.buffer);
    let text = '';
    for (let k = 0; k < bytes.length; k += 0x8000) text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
    return {width, height, rgba: btoa(text)};
}

/// The canvas's own pixels, bytes^gamma, in linear light. To be called in the task that drew them.
export function canvasPixels(gl, gamma) {
    const width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
    const bytes = new Uint8Array(4 * width * height);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return packed(Float32Array.from(bytes, v => (v / 255) ** gamma), width, height);
}
