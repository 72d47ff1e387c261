// Which levels a chain has: in the words of `domelight bake`.

import {DomelightError} from './errors.js';
import {mirroredX} from './pixels.js';

/// How each engine reads a chain: the numbers of src/engines/. `roughness` belongs in level l of `count`, `size` wide at level 0.
const engines = {
    generic: {
        size: 512, smallest: 16, mirror: false,
        roughness: (l, count) => (l <= 0 ? 0 : Math.max(0.6, 0.08 ** (1 / Math.max(1, count - 2))) ** (count - 1 - l)),
    },
    three: {size: 512, smallest: 8, mirror: true, roughness: (l, count) => 1 - Math.sqrt(1 - l / Math.max(1, count - 1))},
    babylon: {size: 256, smallest: 1, mirror: true, roughness: (l, _, size) => (l <= 0 ? 0 : Math.sqrt(Math.min(1, 2 ** (l / 0.8) / size)))},
    playcanvas: {size: 256, smallest: 8, mirror: false, roughness: l => Math.min(1, l / 5)},
    khronos: {size: 256, smallest: 16, mirror: false, roughness: (l, count) => l / Math.max(1, count - 1)},
};

function countOf(size, smallest) {
    return Math.max(1, Math.floor(Math.log2(size / smallest)) + 1);
}

/// Levels of half the size each. `roughness`: an array, or (level, count, size) => roughness.
function chain({size, levels, lobe, roughness}) {
    if (!(Number.isInteger(size) && size >= 1 && size <= 16384)) throw new DomelightError(`${size} is not from 1 to 16384`, 'size');
    if (!(Number.isInteger(levels) && levels >= 1 && levels <= 15)) throw new DomelightError(`${levels} is not from 1 to 15`, 'levels');
    if (Array.isArray(roughness) && roughness.length !== levels)
        throw new DomelightError(`has ${roughness.length} numbers for ${levels} levels`, 'roughness');
    return Array.from({length: levels}, (_, l) => ({
        size: Math.max(1, size >> l), roughness: Array.isArray(roughness) ? roughness[l] : roughness(l, levels, size), ...(lobe !== undefined && {lobe}),
    }));
}

/// The levels that prefilter() is asked for: stated one by one, or `levels` of them from `size` down with roughness
/// growing linearly from 0 to 1.
export function levelSpecs({levels = 5, size = 256, lobe, roughness = (l, count) => l / Math.max(1, count - 1)}) {
    if (!Array.isArray(levels)) return chain({size, levels, lobe, roughness});
    return levels.map(level => {
        if (typeof level !== 'object' || level === null) throw new DomelightError('has an element that is not an object', 'levels', 'Each is {size, roughness}.');
        const {size, roughness, exponent, lobe: own = lobe} = level;
        if (size === undefined) throw new DomelightError('has an element without a size', 'levels', 'Each is {size, roughness}.');
        return {size, ...(roughness !== undefined && {roughness}), ...(exponent !== undefined && {exponent}), ...(own !== undefined && {lobe: own})};
    });
}

/// What bake() filters: the levels of an engine, each with what was asked instead.
export function bakePlan({engine = 'generic', size, levels, lobe, roughness, layout, texels, mirror, encoding = 'rgba16f', irradianceSize, shBands}) {
    const known = engines[engine];
    if (!known) throw new DomelightError(`${JSON.stringify(engine)} is not known`, 'engine', `Known: ${Object.keys(engines).join(', ')}.`);
    const finest = size ?? known.size;
    const count = levels ?? countOf(finest, known.smallest);
    return {
        engine, encoding, layout, irradianceSize, shBands,
        texels: texels ?? (layout === 'latlong' ? undefined : 'read'),
        levels: chain({size: finest, levels: count, lobe, roughness: roughness ?? known.roughness}),
        worldToSource: (mirror ?? (layout !== 'latlong' && known.mirror)) ? mirroredX : undefined,
    };
}
