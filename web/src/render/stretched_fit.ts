// The polynomials of the stretched lobe as GLSL, made from the C++ that has the coefficients (src/render/shading/stretched_fit.cpp), so that
// they are written down once.

import source from '../../../src/render/shading/stretched_fit.cpp?raw';

const k_taps = 9, k_cosines = 4, k_roughnesses = 5, k_terms = k_cosines * k_roughnesses;

/// For each tap the sum over i, j of a coefficient (tilt, roughness, scale, bias) times NdotV^(i/2) roughness^j.
export function stretchedFit(): string {
    const numbers = [...source.matchAll(/(-?[\d.]+(?:e-?\d+)?)f\b/g)].map(match => Number(match[1]));
    const coefficient = (tap: number, which: number, term: number) => numbers[(4 * tap + which) * k_terms + term]!;
    const literal = (v: number) => (Number.isInteger(v) ? `${v}.0` : String(v));
    const monomials = Array.from({length: k_terms}, (_, term) => {
        const factors = [...Array<string>(Math.floor(term / k_roughnesses)).fill('root'), ...Array<string>(term % k_roughnesses).fill('roughness')];
        return factors.join(' * ');
    });
    const line = (tap: number) => monomials.map((_, term) => {
        const vector = `vec4(${[0, 1, 2, 3].map(which => literal(coefficient(tap, which, term))).join()})`;
        return term === 0 ? vector : `${vector} * m${term}`;
    }).join(' + ');
    return [`const int k_taps = ${k_taps};`, 'void stretched_fit(float root, float roughness, out vec4 fits[k_taps]) {',
            ...monomials.slice(1).map((text, k) => `    float m${k + 1} = ${text};`),
            ...Array.from({length: k_taps}, (_, tap) => `    fits[${tap}] = ${line(tap)};`), '}'].join('\n');
}
