// Two methods beside each other, and their difference in numbers.

import type {App} from '../app';
import {Comparer} from '../compare/comparer';
import type {Comparison, ObjectError} from '../compare/compare_worker';
import {Inspector} from '../render/inspector';
import {others, type State} from '../state';
import {button, ChoiceControl, element, SelectControl} from './controls';
import {modeNames, otherNames} from './labels';
import {note, section} from './panel';

export class CompareSection {
    readonly root: HTMLDetailsElement;
    private readonly comparer = new Comparer(result => this.show(result));
    private readonly summary = note('The right side is what the left is compared with.');
    private readonly rows = element('tbody');
    private readonly table: HTMLElement;
    private readonly inspector: Inspector;
    private size = [0, 0];
    private done = '';
    /// Grows whenever something has changed: the map of an earlier picture does not belong to this one.
    private series = 0;
    private measured = -1;

    constructor(
        private readonly app: App,
        choosePicture: () => void,
    ) {
        this.inspector = new Inspector(app.stage);
        const {store} = app, head = element('tr', {}, ...['Object', 'RMSE', 'FLIP'].map(text => element('th', {scope: 'col'}, text)));
        this.table = element('div', {className: 'scroll', hidden: true, tabIndex: 0, role: 'region', ariaLabel: 'Errors by object'}, element('table', {}, element('thead', {}, head), this.rows));
        this.root = section('Compare', false,
            new ChoiceControl(store, 'view', 'View', [['one', 'One', ''], ['other', 'Other', 'What it is compared with'], ['split', 'Split', 'S'], ['difference', 'Differ', 'D'], ['flip', 'FLIP', 'E']]),
            new SelectControl(store, 'other', 'Compared with', others.filter(name => name !== 'truth' || app.served?.truth).map(name => [name, otherNames[name]] as const)),
            element('div', {className: 'row'}, button('Open a picture…', choosePicture, 'A picture of `domelight render` (.exr, .hdr) of the same size')),
            this.summary, this.table);
        store.listen(() => {
            this.done = '';
            ++this.series;
            app.stage.setMap(null);
        });
    }

    /// Called after each frame: compares when the panes have averaged 1, 4, 16, 64 frames, and so on.
    update(): void {
        const {state, stage} = this.app;
        if (state.view === 'one' || state.view === 'other' || (!this.root.open && state.view === 'split')) return;
        if (!stage.hasOther(state)) return void (this.summary.textContent = state.other === 'picture' ? 'Open a picture to compare with.' : 'The path-traced picture is on its way.');
        const count = this.app.least, key = `${Math.floor(Math.log2(Math.max(1, count)) / 2)} ${state.view} ${stage.pictureChanges}`;
        if (count < 1 || key === this.done) return;
        this.done = key;
        void this.comparer.ask(async () => {
            const {width, height} = stage.panes[0];
            this.size = [width, height];
            this.measured = this.series;
            const [test, reference, objects] = await Promise.all([this.inspector.displayed(state, 0), this.inspector.displayed(state, 1), this.inspector.objects()]);
            return {width, height, test, reference, objects};
        });
    }

    private show({all, objects, map}: Comparison): void {
        const {state, stage} = this.app, names = stage.objectNames;
        this.summary.textContent = `${modeNames[state.mode]} against ${nameOf(state)}: RMSE ${all.rmse.toFixed(2)} of 255, mean FLIP ${all.flip.toFixed(4)}, of the displayed values.`;
        this.rows.replaceChildren(...objects.map(error => rowOf(names[error.object - 1] ?? '', error)));
        this.table.hidden = objects.length < 2;
        if (this.measured === this.series && stage.panes[0].width === this.size[0] && stage.panes[0].height === this.size[1]) stage.setMap({bytes: map, width: this.size[0]!, height: this.size[1]!});
        this.app.redraw();
    }
}

const nameOf = (state: State) => (state.other === 'picture' ? 'the picture' : state.other === 'truth' ? 'the path-traced picture' : modeNames[state.other]);
const rowOf = (name: string, {rmse, flip}: ObjectError) =>
    element('tr', {}, element('td', {title: name}, name), element('td', {}, rmse.toFixed(2)), element('td', {}, flip.toFixed(4)));
