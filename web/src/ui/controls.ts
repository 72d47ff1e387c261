// Controls: native elements with a label, each bound to one value of the state. Plain custom elements without a shadow, so that the page's
// style and its labels apply.

import type {State, Store} from '../state';

type Keys<T> = {[K in keyof State]: State[K] extends T ? K : never}[keyof State];

let next = 0;
const uniqueId = () => `control-${next++}`;

export function element<K extends keyof HTMLElementTagNameMap>(
    tag: K, properties: Partial<HTMLElementTagNameMap[K]> = {}, ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
}

/// Shows a value of the state now and whenever it changes.
function follow(store: Store, key: keyof State, show: () => void): void {
    show();
    store.listen(changed => changed.has(key) && show());
}

interface RangeOptions {
    min: number;
    max: number;
    step: number;
    /// How the value is written beside the slider.
    text?: (value: number) => string;
    title?: string;
}

/// A slider with its value. A double click on the label sets the default.
export class RangeControl extends HTMLElement {
    constructor(store: Store, key: Keys<number>, label: string, {min, max, step, text = String, title = ''}: RangeOptions) {
        super();
        const id = uniqueId();
        const input = element('input', {type: 'range', id, min: `${min}`, max: `${max}`, step: `${step}`});
        const output = element('output');
        output.htmlFor.add(id);
        const name = element('label', {htmlFor: id, title}, label);
        input.addEventListener('input', () => store.set({[key]: Number(input.value)}));
        name.addEventListener('dblclick', () => store.reset(key));
        follow(store, key, () => {
            input.value = String(store.state[key]);
            output.value = text(store.state[key]);
            input.setAttribute('aria-valuetext', output.value);
        });
        this.append(name, output, input);
    }
}

/// One of a few words, side by side.
export class ChoiceControl extends HTMLElement {
    constructor(store: Store, key: Keys<string>, label: string, choices: readonly (readonly [value: string, text: string, title?: string])[]) {
        super();
        const name = uniqueId();
        const row = element('div'), set = element('fieldset', {}, element('legend', {}, label), row);
        for (const [value, text, title = ''] of choices) {
            const input = element('input', {type: 'radio', name, value});
            input.addEventListener('change', () => store.set({[key]: value}));
            row.append(element('label', {title}, input, element('span', {}, text)));
        }
        follow(store, key, () => {
            for (const input of set.querySelectorAll('input')) input.checked = input.value === store.state[key];
        });
        this.append(set);
    }
}

/// One of many words, in a list that opens.
export class SelectControl extends HTMLElement {
    private readonly select = element('select', {id: uniqueId()});
    constructor(store: Store, key: Keys<string>, label: string, choices: readonly (readonly [value: string, text: string])[]) {
        super();
        this.append(element('label', {htmlFor: this.select.id}, label), this.select);
        this.fill(choices);
        this.select.addEventListener('change', () => store.set({[key]: this.select.value}));
        follow(store, key, () => (this.select.value = store.state[key]));
    }
    fill(choices: readonly (readonly [value: string, text: string])[]): void {
        this.select.replaceChildren(...choices.map(([value, text]) => element('option', {value}, text)));
    }
}

/// On or off.
export class CheckControl extends HTMLElement {
    constructor(store: Store, key: Keys<boolean>, label: string, title = '') {
        super();
        const input = element('input', {type: 'checkbox'});
        input.addEventListener('change', () => store.set({[key]: input.checked}));
        follow(store, key, () => (input.checked = store.state[key]));
        this.append(element('label', {title}, input, element('span', {}, label)));
    }
}

/// A colour of sRGB.
export class ColourControl extends HTMLElement {
    constructor(store: Store, key: Keys<string>, label: string) {
        super();
        const id = uniqueId(), input = element('input', {type: 'color', id});
        input.addEventListener('input', () => store.set({[key]: input.value}));
        follow(store, key, () => (input.value = store.state[key]));
        this.append(element('label', {htmlFor: id}, label), input);
    }
}

customElements.define('dl-range', RangeControl);
customElements.define('dl-choice', ChoiceControl);
customElements.define('dl-select', SelectControl);
customElements.define('dl-check', CheckControl);
customElements.define('dl-colour', ColourControl);

export function button(text: string, act: () => void, title = ''): HTMLButtonElement {
    const made = element('button', {type: 'button', title}, text);
    made.addEventListener('click', act);
    return made;
}

/// Shows a part of the panel only where the state asks for it.
export function onlyWhere(store: Store, part: HTMLElement, shown: (state: State) => boolean): HTMLElement {
    const show = () => (part.hidden = !shown(store.state));
    show();
    store.listen(show);
    return part;
}
