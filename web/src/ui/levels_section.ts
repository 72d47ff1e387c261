// Every level that was baked, as ball, faces or lat-long map.

import type {App} from '../app';
import {levelExponent, levelRoughness} from '../bake/chain';
import {LevelPictures, sizeOf, type LevelOptions, type Shape} from '../render/level_pictures';
import {button, element} from './controls';
import {section} from './panel';

type Figure = Omit<LevelOptions, 'shape'> & {text: string};

export function levelsSection(app: App): HTMLElement {
    const pictures = new LevelPictures(app.stage), grid = element('div', {className: 'levels ball'});
    let shape: Shape = 'ball', drawing = 0;
    const choices = ([['ball', 'Balls'], ['faces', 'Faces'], ['latlong', 'Lat-long']] as const).map(([name, text]) => {
        const made = button(text, () => {
            shape = name;
            grid.className = `levels ${name}`;
            choices.forEach(choice => (choice.ariaPressed = String(choice === made)));
            void draw();
        });
        made.ariaPressed = String(name === shape);
        return made;
    });
    const root = section('Baked levels', false, element('div', {className: 'row'}, ...choices), grid);

    const figures = (): Figure[] => [
        ...Array.from({length: app.levels}, (_, level) => ({text: `${level}: r ${levelRoughness(level, app.levels).toFixed(2)}`, map: 'specular' as const, level})),
        ...Array.from({length: Math.max(0, app.phongLevels - 1)}, (_, l) => ({text: `Phong ${l + 1}: n ${levelExponent(l + 1)}`, map: 'phong' as const, level: l + 1})),
        {text: 'E / π', map: 'irradiance', level: 0},
        {text: 'E / π, nine harmonics', map: 'sh', level: 0},
    ];
    /// Draws one level after the other, when the graphics card has done its work, until it is asked to draw again.
    const draw = async () => {
        if (!root.open || !app.stage.uniforms.u_specular!.value) return;
        const turn = ++drawing, all = figures().map(({text, ...options}) => ({options, text, canvas: element('canvas', {role: 'img', ariaLabel: text, ...sizeOf(shape)})}));
        const place = () => grid.replaceChildren(...all.map(({canvas, text}) => element('figure', {}, canvas, element('figcaption', {}, text))));
        if (grid.childElementCount !== all.length || grid.dataset.shape !== shape) place();  // otherwise the earlier pictures stay until there are new ones
        grid.dataset.shape = shape;
        for (const {canvas, options} of all) {
            await app.stage.backlog.emptied();
            if (turn !== drawing) return;
            await pictures.draw(canvas, app.state, {...options, shape});
        }
        if (turn === drawing) place();
    };
    root.addEventListener('toggle', () => void draw());
    app.onOpened(() => void draw());
    app.store.listen(changed => (['exposure', 'tonemap', 'size'] as const).some(key => changed.has(key)) && void draw());
    app.onPhong(() => void draw());
    return root;
}
