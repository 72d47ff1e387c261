// The panel's sections: what is shown, how it is lit, and how that is computed.

import type {App} from '../app';
import {defaults, projections, tonemaps, type Mode, type State} from '../state';
import {button, CheckControl, ChoiceControl, ColourControl, element, onlyWhere, RangeControl, SelectControl} from './controls';
import {environmentNames, fixed, modeNotes, signed, tonemapNames} from './labels';

export function section(title: string, open: boolean, ...parts: HTMLElement[]): HTMLDetailsElement {
    return element('details', {open}, element('summary', {}, title), element('div', {}, ...parts));
}

export const note = (...text: (string | Node)[]): HTMLParagraphElement => element('p', {className: 'note'}, ...text);

const models = [['spheres', 'Spheres: gold, plastic'], ['grid', 'Grid: roughness × metalness'], ['ball', 'Ball on a plinth'], ['furnace', 'White metal ball'], ['none', 'None: the environment alone']] as const;

const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);

/// A list that opens, with its label.
function labelled(label: string, id: string): [HTMLElement, HTMLSelectElement] {
    const select = element('select', {id});
    return [element('div', {className: 'select'}, element('label', {htmlFor: id}, label), select), select];
}
/// Those with a text of their own first, then what was opened.
function fill(select: HTMLSelectElement, named: readonly (readonly [string, string])[], names: Iterable<string>, chosen: string): void {
    const own = [...new Set([...names, chosen])].filter(name => !named.some(([value]) => value === name));
    select.replaceChildren(...[...named, ...own.map(name => [name, name] as const)].map(([value, text]) => element('option', {value}, text)));
    select.value = chosen;
}

export function sceneSection(app: App): HTMLElement {
    const {store} = app;
    const [modelPart, model] = labelled('Model', 'model'), [environmentPart, environment] = labelled('Environment', 'environment');
    model.addEventListener('change', () => app.chooseModel(model.value));
    environment.addEventListener('change', () => app.chooseEnvironment(environment.value));
    const variant = element('select', {id: 'variant'}), warnings = note(), notes = note();
    const variants = element('div', {className: 'select', hidden: true}, element('label', {htmlFor: 'variant'}, 'Material variant'), variant);
    variant.addEventListener('change', () => void app.useVariant(variant.value === '' ? null : Number(variant.value)));
    app.onOpened(() => {
        fill(model, models, app.models.keys(), app.model.name);
        fill(environment, environmentNames, [...app.environments.keys()].filter(name => name !== 'furnace'), app.environmentName);
        warnings.hidden = app.warnings.length === 0;
        warnings.textContent = app.warnings.map(text => `${capital(text)}.`).join(' ');
        notes.hidden = !app.model.notes?.length;
        notes.textContent = (app.model.notes ?? []).map(capital).join(' ');
        lights.hidden = app.stage.lights === 0;
        variants.hidden = app.model.variants.length === 0;
        variant.replaceChildren(element('option', {value: ''}, 'as in the file'), ...app.model.variants.map((name, k) => element('option', {value: `${k}`}, name)));
    });
    const projection = new SelectControl(store, 'projection', 'Files without a stated projection are', projections.map(name => [name, name === 'auto' ? 'recognised by their shape' : name] as const));
    const lights = new CheckControl(store, 'lights', 'Lights of the model', 'Points, spots and directional lights of the file (KHR_lights_punctual)');
    lights.hidden = true;
    return section('Scene', true, modelPart, notes, variants, environmentPart, warnings, new CheckControl(store, 'furnace', 'White furnace', 'Light of radiance 1 from everywhere (W)'),
        lights, new CheckControl(store, 'motion', 'Let it move', 'Balls to and fro, models about the vertical axis (M)'), projection);
}

export function pictureSection(app: App, screen: HTMLElement[]): HTMLElement {
    const {store} = app;
    return section('Light and picture', true,
        new RangeControl(store, 'exposure', 'Exposure', {min: -8, max: 8, step: 0.1, text: v => `${signed(1)(v)} EV`}),
        element('div', {className: 'row'}, button('Expose for this light', () => store.set({exposure: app.goodExposure}), 'So that the mean of the environment is half of white')),
        new RangeControl(store, 'turn', 'Turn of the light', {min: -180, max: 180, step: 1, text: v => `${v.toFixed(0)}°`, title: 'Shift and drag'}),
        new SelectControl(store, 'tonemap', 'Tone map', tonemaps.map(name => [name, tonemapNames[name]] as const)),
        ...screen,
        new ChoiceControl(store, 'background', 'Background', [['environment', 'Sharp'], ['blurred', 'Blurred'], ['colour', 'White']]),
        onlyWhere(store, new RangeControl(store, 'blur', 'Blur', {min: 0.05, max: 1, step: 0.01, text: fixed(2)}), s => s.background === 'blurred'),
        new CheckControl(store, 'fullResolution', 'Full resolution always', 'Otherwise fewer pixels are drawn while something moves, where frames take longer than a tenth of a second'));
}

/// Controls that belong to some of the methods.
export function methodSection({store}: App): HTMLElement {
    const text = note();
    const tell = () => (text.textContent = modeNotes[store.state.mode]);
    tell();
    store.listen(tell);
    const of = (...modes: Mode[]) => (s: State) => modes.includes(s.mode) || (s.view !== 'one' && modes.includes(s.other as Mode));
    const where = (shown: (s: State) => boolean, ...parts: HTMLElement[]) => parts.map(part => onlyWhere(store, part, shown));
    return section('Method', true, text,
        ...where(of('split-sum', 'stretched', 'phong'),
            new ChoiceControl(store, 'irradiance', 'Irradiance', [['cube', 'Cube'], ['sh', 'Nine harmonics']]),
            new CheckControl(store, 'occlusion', 'Occlusion textures')),
        ...where(of('split-sum', 'stretched'),
            new CheckControl(store, 'multipleScattering', 'Multiple scattering', 'Fdez-Aguera 2019: rough metals do not darken'),
            new ChoiceControl(store, 'diffuseWeight', 'Diffuse weight', [['energy', 'Energy'], ['fresnel', '1 − F(NdotV)']])),
        ...where(of('split-sum', 'stretched'), new CheckControl(store, 'live', 'Objects see their neighbours', 'A cube is drawn from the middle of each and filtered whenever something changes (L)')),
        ...where(of('split-sum'), new CheckControl(store, 'bentLookup', 'Bent lookup', 'Towards the normal on rough surfaces')),
        ...where(of('mirror', 'refract'),
            new SelectControl(store, 'lookup', 'Environment read as', [['environment', 'the map itself'], ['cube', 'cube'], ['latlong', 'lat-long'],
                                                                       ['sphere-map', 'sphere map'], ['dual-paraboloid', 'dual paraboloid']])),
        ...where(of('refract'),
            new RangeControl(store, 'iorOutside', 'Index outside', {min: 1, max: 2.5, step: 0.01, text: fixed(2)}),
            new CheckControl(store, 'iorOverride', 'Choose the index inside'),
            new RangeControl(store, 'ior', 'Index inside', {min: 1, max: 2.5, step: 0.01, text: fixed(2)})),
        ...where(of('monte-carlo'),
            new ChoiceControl(store, 'strategy', 'Directions from', [['mis', 'Both (MIS)'], ['env', 'Light'], ['brdf', 'BRDF']]),
            new ChoiceControl(store, 'tables', 'Drawn by', [['guided', 'Guide tables'], ['walk', 'Row, then column']]),
            new RangeControl(store, 'samples', 'Samples a frame', {min: 1, max: 16, step: 1}),
            new RangeControl(store, 'rows', 'Rows of the map', {min: 64, max: 512, step: 64})));
}

export function materialSection({store}: App, levelOfExponent: (exponent: number) => string): HTMLElement {
    const parts = [
        new ColourControl(store, 'color', 'Base colour'),
        new RangeControl(store, 'metalness', 'Metalness', {min: 0, max: 1, step: 0.01, text: fixed(2)}),
        new RangeControl(store, 'roughness', 'Roughness', {min: 0, max: 1, step: 0.01, text: fixed(2)}),
        new RangeControl(store, 'exponentLog2', 'Phong exponent n_s', {min: 0, max: 14, step: 0.1, text: v => `${(2 ** v).toFixed(v < 4 ? 1 : 0)}, level ${levelOfExponent(2 ** v)}`}),
    ].map(part => onlyWhere(store, part, s => s.override));
    return section('Material', store.state.override !== defaults.override, new CheckControl(store, 'override', 'One material for everything'), ...parts);
}
