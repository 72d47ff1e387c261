// Every level that was baked, as ball, faces or lat-long map.

import type {App} from '../app';
import {levelExponent, levelRoughness} from '../bake/chain';
import {LevelPictures, type LevelOptions, type Shape} from '../render/level_pictures';
import {button, element} from './controls';
import {section} from './panel';

export function levelsSection(app: App): HTMLElement {
    const pictures = new LevelPictures(app.stage), grid = element('div', {className: 'levels ball'});
    let shape: Shape = 'ball';
    const choices = ([['ball', 'Balls'], ['faces', 'Faces'], ['latlong', 'Lat-long']] as const).map(([name, text]) => {
        const made = button(text, () => {
            shape = name;
            grid.className = `levels ${name}`;
            choices.forEach(choice => (choice.ariaPressed = String(choice === made)));
            draw();
        });
        made.ariaPressed = String(name === shape);
        return made;
    });
    const root = section('Baked levels', false, element('div', {className: 'row'}, ...choices), grid);

    const figure = (text: string, options: Omit<LevelOptions, 'shape' | 'width'>) => {
        const canvas = element('canvas', {role: 'img', ariaLabel: text});
        pictures.draw(canvas, app.state, {...options, shape, width: shape === 'ball' ? 128 : 192});
        return element('figure', {}, canvas, element('figcaption', {}, text));
    };
    const draw = () => {
        if (!root.open || !app.stage.uniforms.u_specular!.value) return;
        const {levels, phongLevels} = app, figures = [];
        for (let l = 0; l < levels; ++l) figures.push(figure(`${l}: r ${levelRoughness(l, levels).toFixed(2)}`, {map: 'specular', level: l}));
        for (let l = 1; l < phongLevels; ++l) figures.push(figure(`Phong ${l}: n ${levelExponent(l)}`, {map: 'phong', level: l}));
        figures.push(figure('E / π', {map: 'irradiance', level: 0}), figure('E / π, nine harmonics', {map: 'sh', level: 0}));
        grid.replaceChildren(...figures);
        app.redraw();
    };
    root.addEventListener('toggle', draw);
    app.onOpened(draw);
    app.store.listen(changed => ['exposure', 'tonemap', 'mode', 'size'].some(key => changed.has(key as never)) && draw());
    return root;
}
