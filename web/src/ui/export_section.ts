// Files for an engine, as `domelight bake --for` writes them.

import type {App} from '../app';
import type {BakedFiles} from '../export/export_worker';
import {button, element} from './controls';
import {note, section} from './panel';

export function save(name: string, data: BlobPart, type = 'application/octet-stream'): void {
    const link = element('a', {href: URL.createObjectURL(new Blob([data], {type})), download: name});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/// By the names of the library, with what each is.
const engines = [
    ['generic', 'an engine of your own (KTX2)'], ['three', 'three.js (.pmrem.ktx2)'], ['three-latlong', 'three.js (EXR, for its own filter)'], ['babylon', 'Babylon.js (.env)'],
    ['playcanvas', 'PlayCanvas (PNG)'], ['filament', 'Filament (KTX)'], ['khronos', 'Khronos glTF viewer (KTX2)'], ['bevy', 'Bevy (KTX2)'], ['gltf', 'glTF (EXT_lights_image_based)'],
    ['godot', 'Godot (EXR)'], ['unity', 'Unity (DDS, EXR)'], ['unreal', 'Unreal Engine (EXR, DDS)'], ['blender', 'Blender (EXR)'], ['mitsuba', 'Mitsuba (EXR)'], ['pbrt', 'pbrt (EXR)'],
    ['usd', 'USD (EXR)'], ['materialx', 'MaterialX (EXR)'],
] as const;
const sizes = [0, 64, 128, 256, 512, 1024];

const bytesText = (bytes: number) => (bytes < 1e6 ? `${Math.ceil(bytes / 1e3)} KB` : `${(bytes / 1e6).toFixed(1)} MB`);

export function exportSection(app: App): HTMLElement {
    const engine = element('select', {id: 'engine'}, ...engines.map(([value, text]) => element('option', {value}, text)));
    const size = element('select', {id: 'bake-size'}, ...sizes.map(value => element('option', {value: String(value)}, value === 0 ? 'the engine’s own' : String(value))));
    const command = element('code'), files = element('div', {className: 'stack', hidden: true}), made = button('Bake the files', () => void bake(), 'In a worker of its own');
    const stem = () => (app.environmentName || 'environment').replace(/\.[^.]*$/, '');
    const show = ({files: list, archive}: BakedFiles) => {
        const name = `${stem()}-${engine.value}`, all = button(`Save all as ${name}.zip (${bytesText(archive.size)})`, () => save(`${name}.zip`, archive, 'application/zip'));
        const rows = list.map(file => element('tr', {}, element('td', {title: file.name}, button(file.name, () => save(file.name.split('/').pop()!, file.data), `Save ${file.name}`)), element('td', {}, bytesText(file.data.length))));
        files.replaceChildren(element('div', {className: 'row'}, all), element('table', {}, element('tbody', {}, ...rows)));
        files.hidden = false;
    };
    const bake = async () => {
        made.disabled = true;
        files.hidden = true;
        await app.export(engine.value, Number(size.value), show);
        made.disabled = false;
    };
    const tell = () => {
        files.hidden = true;
        command.textContent = `domelight bake ${app.environmentName || 'studio.hdr'} -o out --for ${engine.value}${size.value === '0' ? '' : ` --size ${size.value}`}`;
    };
    for (const control of [engine, size]) control.addEventListener('change', tell);
    app.onOpened(tell);
    return section('Export', false,
        element('div', {className: 'select'}, element('label', {htmlFor: 'engine'}, 'For'), engine), element('div', {className: 'select'}, element('label', {htmlFor: 'bake-size'}, 'Size of level 0'), size),
        element('div', {className: 'row'}, made), files, note('The environment as its file has it, without the turn of the light and the exposure. The same on the command line:'), note(command));
}
