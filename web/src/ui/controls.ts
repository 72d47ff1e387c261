// Controls: native elements with a label, each bound to one of the values that the user chooses. Plain custom elements without a shadow, so that the page's
// style and its labels apply.

import type {State, Store, Values} from '../state';

type Keys<S, T> = {[K in keyof S]: S[K] extends T ? K : never}[keyof S];

let next = 0;
const uniqueId = () => `control-${next++}`;

export function element<K extends keyof HTMLElementTagNameMap>(
    tag: K, properties: Partial<HTMLElementTagNameMap[K]> = {}, ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
}

/// Shows a value now and whenever it changes.
function follow<S extends object>(store: Values<S>, key: keyof S, show: () => void): void {
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
export class RangeControl<S extends object = State> extends HTMLElement {
    constructor(store: Values<S>, key: Keys<S, number>, label: string, {min, max, step, text = String, title = ''}: RangeOptions) {
        super();
        const id = uniqueId();
        const input = element('input', {type: 'range', id, min: `${min}`, max: `${max}`, step: `${step}`});
        const output = element('output');
        output.htmlFor.add(id);
        const name = element('label', {htmlFor: id, title}, label);
        input.addEventListener('input', () => store.set({[key]: Number(input.value)} as Partial<S>));
        name.addEventListener('dblclick', () => store.reset(key));
        follow(store, key, () => {
            input.value = String(store.state[key]);
            output.value = text(store.state[key] as number);
            input.setAttribute('aria-valuetext', output.value);
        });
        this.append(name, output, input);
    }
}

/// One of a few words, side by side.
export class ChoiceControl<S extends object = State> extends HTMLElement {
    constructor(store: Values<S>, key: Keys<S, string>, label: string, choices: readonly (readonly [value: string, text: string, title?: string])[]) {
        super();
        const name = uniqueId();
        const row = element('div'), set = element('fieldset', {}, element('legend', {}, label), row);
        for (const [value, text, title = ''] of choices) {
            const input = element('input', {type: 'radio', name, value});
            input.addEventListener('change', () => store.set({[key]: value} as Partial<S>));
            row.append(element('label', {title}, input, element('span', {}, text)));
        }
        follow(store, key, () => {
            for (const input of set.querySelectorAll('input')) input.checked = input.value === store.state[key];
        });
        this.append(set);
    }
}

/// One of many words, in a list that opens.
export class SelectControl<S extends object = State> extends HTMLElement {
    private readonly select = element('select', {id: uniqueId()});
    constructor(store: Values<S>, key: Keys<S, string>, label: string, choices: readonly (readonly [value: string, text: string])[]) {
        super();
        this.append(element('label', {htmlFor: this.select.id}, label), this.select);
        this.fill(choices);
        this.select.addEventListener('change', () => store.set({[key]: this.select.value} as Partial<S>));
        follow(store, key, () => (this.select.value = store.state[key] as string));
    }
    fill(choices: readonly (readonly [value: string, text: string])[]): void {
        this.select.replaceChildren(...choices.map(([value, text]) => element('option', {value}, text)));
    }
}

/// On or off.
export class CheckControl<S extends object = State> extends HTMLElement {
    constructor(store: Values<S>, key: Keys<S, boolean>, label: string, title = '') {
        super();
        const input = element('input', {type: 'checkbox'});
        input.addEventListener('change', () => store.set({[key]: input.checked} as Partial<S>));
        follow(store, key, () => (input.checked = store.state[key] as boolean));
        this.append(element('label', {title}, input, element('span', {}, label)));
    }
}

/// A colour of sRGB.
export class ColourControl<S extends object = State> extends HTMLElement {
    constructor(store: Values<S>, key: Keys<S, string>, label: string) {
        super();
        const id = uniqueId(), input = element('input', {type: 'color', id});
        input.addEventListener('input', () => store.set({[key]: input.value} as Partial<S>));
        follow(store, key, () => (input.value = store.state[key] as string));
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
