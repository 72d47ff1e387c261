// What was baked, as files for an engine.

import type {App} from '../app';
import {sizesDownTo, threeRoughness} from '../bake/chain';
import {writeKtx2} from '../bake/ktx2';
import {button, element} from './controls';
import {note, section} from './panel';

export function save(name: string, data: BlobPart, type = 'application/octet-stream'): void {
    const link = element('a', {href: URL.createObjectURL(new Blob([data], {type})), download: name});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

const engines = ['three', 'three-latlong', 'babylon', 'playcanvas', 'filament', 'khronos', 'bevy', 'gltf', 'godot', 'unity', 'unreal', 'blender', 'mitsuba', 'pbrt', 'usd', 'materialx'];

export function exportSection(app: App): HTMLElement {
    const files = element('div', {className: 'row'},
        button('specular.ktx2', () => app.bake && save('specular.ktx2', writeKtx2(app.bake.specular.levels, 6))),
        button('irradiance.ktx2', () => app.bake && save('irradiance.ktx2', writeKtx2([app.bake.irradiance], 6))),
        button('brdf.ktx2', () => app.brdf && save('brdf.ktx2', writeKtx2([app.brdf], 1))),
        button('sh.json', () => app.bake && save('sh.json', harmonics(app.bake.sh), 'application/json')));
    const stem = () => (app.environmentName || 'environment').replace(/\.[^.]*$/, ''), threeSizes = sizesDownTo(512, 8);
    const three = button('environment.pmrem.ktx2', () => void app.export('environment.pmrem.ktx2', async () => {
        const {levels} = await app.baker.chain(threeSizes, threeSizes.map((_, l) => threeRoughness(l, threeSizes.length)), true);
        return writeKtx2(levels, 6);
    }, bytes => save(`${stem()}.pmrem.ktx2`, bytes)), '512² in 7 levels, half floats');
    const engine = element('select', {id: 'engine'}, ...engines.map(name => element('option', {value: name}, name))), command = element('code');
    const tell = () => (command.textContent = `domelight bake ${app.environmentName || 'studio.hdr'} -o out --for ${engine.value} --size ${app.state.size}`);
    engine.addEventListener('change', tell);
    app.onOpened(tell);
    return section('Export', false, note('For an engine of your own: half floats, as docs/shaders/generic.* reads them.'), files,
        note('For three.js (r187 on, KTX2Loader; set texture.isPMREMTexture = true): half floats, where the command line writes UASTC HDR, an eighth of the size.'), element('div', {className: 'row'}, three),
        note('The page writes KTX2 of half floats only: other containers and block compression are made on the command line.'),
        element('div', {className: 'select'}, element('label', {htmlFor: 'engine'}, 'For another engine, on the command line'), engine), note(command));
}

const harmonics = (sh: Float32Array) =>
    JSON.stringify({irradiance: Array.from({length: 9}, (_, k) => [...sh.slice(3 * k, 3 * k + 3)])}, null, 2);
