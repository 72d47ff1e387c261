// The levels of the engine `generic` (src/engines/generic.cpp): what docs/shaders/generic.glsl reads.

/// Sizes from `size` down to `smallest`, halved from level to level.
export function sizesDownTo(size: number, smallest: number): number[] {
    const sizes = [];
    for (let s = size; s >= smallest; s /= 2) sizes.push(s);
    return sizes;
}

/// The roughness of a level of `levels`.
export function levelRoughness(level: number, levels: number): number {
    const last = levels - 1;
    if (level === 0) return 0;
    return Math.max(0.6, 0.08 ** (1 / Math.max(1, last - 1))) ** (last - level);
}

/// The exponent of a level of a modified Phong chain (src/engines/engine.cpp, default_phong_exponents).
export function levelExponent(level: number): number {
    return level === 0 ? Infinity : Math.max(1, 2 ** (13 - 2 * level), 2 ** (7 - level));
}

/// The roughness that corresponds to an exponent by Beckmann's relation n = 2 / alpha² - 2: between levels, a Phong chain is
/// interpolated linearly in it.
export function matchingRoughness(exponent: number): number {
    return exponent === Infinity ? 0 : (2 / (exponent + 2)) ** 0.25;
}

/// The level, between two levels too, whose lobe has an exponent.
export function phongLevel(exponent: number, count: number): number {
    const r = matchingRoughness(exponent);
    for (let l = 1; l < count; ++l) {
        const low = matchingRoughness(levelExponent(l - 1)), high = matchingRoughness(levelExponent(l));
        if (r < high) return l - (high - r) / (high - low);
    }
    return count - 1;
}
