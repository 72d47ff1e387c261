// The set of probes that lights the model: what it is, and how it is read.

import type {App} from '../app';
import {CheckControl, onlyWhere, RangeControl} from './controls';
import {note, section} from './panel';

export function probesSection(app: App): HTMLElement {
    const {store} = app, text = note(), legend = note();
    const lit = [
        new RangeControl(store, 'probeBlend', 'Probes blended', {min: 1, max: 8, step: 1, title: 'Those with the largest weights'}),
        new CheckControl(store, 'probeParallax', 'Parallax', 'Reflections are looked up where the ray leaves the box of walls around each probe'),
        new CheckControl(store, 'probeVisibility', 'Visibility', 'Off: all probes of a cell count, also those behind walls, as in engines that know no visibility'),
    ].map(part => onlyWhere(store, part, s => s.probes));
    const root = section('Probes', true, text, new CheckControl(store, 'probes', 'Light by the probes', 'Split-sum, stretched and Phong; otherwise by the environment (I)'), ...lit,
        new CheckControl(store, 'probeBalls', 'Show the probes', 'As balls with their irradiance; the rim says what each is (G)'), legend);
    root.hidden = true;
    app.onOpened(() => {
        const {set} = app.stage.probes;
        root.hidden = set === null;
        if (!set) return;
        const {probes, grid, scene} = set.record, count = (of: (probe: (typeof probes)[number]) => boolean) => probes.filter(of).length;
        const moved = count(p => p.valid && p.moved), invalid = count(p => !p.valid);
        text.textContent = `${probes.length} probes${grid ? `, ${grid.counts.join(' × ')} in a grid` : ''}, captured in ${scene}. ` +
            `${grid ? 'A point is lit by the eight of its cell' : 'A point is lit by the nearest eight'}; the environment is only seen behind the model.` +
            (scene && scene !== app.model.name ? ` The model shown is ${app.model.name}: its light is only right if that is the same scene.` : '');
        legend.textContent = `${probes.length - moved - invalid} stand where they were placed (white rim), ${moved} were moved out of surfaces (orange rim), ${invalid} are not valid (pink rim, crossed out).`;
    });
    return root;
}
