// The names of what can be chosen, as the page writes them.

import type {Mode, Other, State} from '../state';

export const modeNames: Record<Mode, string> = {
    'split-sum': 'Split-sum', stretched: 'Stretched', phong: 'Phong', mirror: 'Mirror', refract: 'Refract', 'monte-carlo': 'Monte Carlo',
};
export const otherNames: Record<Other, string> = {...modeNames, picture: 'A picture', truth: 'Path traced'};

export const modeNotes: Record<Mode, string> = {
    'split-sum': 'Karis 2013: one lookup in the filtered cube times the BRDF table, plus irradiance.',
    stretched: 'Nine lookups along the lobe: reflections become long at grazing angles.',
    phong: 'Modified Phong under two filtered maps, with n = v = r.',
    mirror: 'Reflection mapping: the sharp environment in the mirror direction.',
    refract: 'Snell’s law at the front surface, mixed with the reflection by Fresnel’s term.',
    'monte-carlo': 'The integral itself by random light directions, without shadows. It converges to the truth.',
};

export const tonemapNames: Record<State['tonemap'], string> = {none: 'None', reinhard: 'Reinhard', aces: 'ACES', agx: 'AgX', neutral: 'Khronos neutral'};

export const environmentNames = [['studio', 'Studio (computed here)'], ['sunset', 'Evening sky (computed here)']] as const;

export const signed = (digits: number) => (v: number) => `${v > 0 ? '+' : ''}${v.toFixed(digits)}`;
export const fixed = (digits: number) => (v: number) => v.toFixed(digits);
