// A plot of lines, drawn as SVG in the style of the app.

export interface Axis {
    from: number;
    to: number;
    log?: boolean;
    label: string;
    ticks: number[];
    text?: (value: number) => string;
}
export interface Line {
    points: [number, number][];
    /// A class of the style sheet: line, ideal, other.
    kind?: string;
    name?: string;
    dots?: boolean;
}

const k_width = 360;

export class Plot {
    readonly root = document.createElementNS('http://www.w3.org/2000/svg', 'svg');

    constructor(private readonly label: string, private readonly height = 190) {
        this.root.setAttribute('class', 'plot');
        this.root.setAttribute('role', 'img');
        this.root.setAttribute('viewBox', `0 0 ${k_width} ${height}`);
    }

    /// told: what the plot shows, for those who do not see it.
    draw(x: Axis, y: Axis, lines: Line[], told: string): void {
        const left = 58, right = k_width - 16, top = 24, bottom = this.height - 34;
        const place = (axis: Axis, value: number, a: number, b: number) => {
            const scale = (v: number) => (axis.log ? Math.log(Math.max(v, 1e-30)) : v);
            const t = (scale(value) - scale(axis.from)) / (scale(axis.to) - scale(axis.from));
            return a + Math.min(1, Math.max(0, t)) * (b - a);
        };
        const px = (v: number) => place(x, v, left, right).toFixed(1), py = (v: number) => place(y, v, bottom, top).toFixed(1);
        const parts = [`<path class="axis" d="M${left} ${top}V${bottom}H${right}"/>`];
        for (const v of x.ticks) parts.push(`<text x="${px(v)}" y="${bottom + 13}" text-anchor="middle">${(x.text ?? String)(v)}</text>`);
        for (const v of y.ticks) parts.push(`<path class="axis" d="M${left} ${py(v)}h-4"/><text x="${left - 7}" y="${Number(py(v)) + 3}" text-anchor="end">${(y.text ?? String)(v)}</text>`);
        parts.push(`<text x="${(left + right) / 2}" y="${this.height - 5}" text-anchor="middle">${x.label}</text>`, `<text x="6" y="13">${y.label}</text>`);
        for (const {points, kind = 'line', dots} of lines) {
            parts.push(`<path class="${kind}" d="${points.map(([a, b], k) => `${k ? 'L' : 'M'}${px(a)} ${py(b)}`).join('')}"/>`);
            if (dots) for (const [a, b] of points) parts.push(`<circle class="${kind}" cx="${px(a)}" cy="${py(b)}" r="3"/>`);
        }
        let at = right;
        for (const {name, kind = 'line'} of lines.filter(line => line.name).reverse()) {
            at -= 5.6 * name!.length;
            parts.push(`<path class="${kind}" d="M${at - 20} 10h15"/><text x="${at}" y="13">${name}</text>`);
            at -= 32;
        }
        this.root.innerHTML = parts.join('');
        this.root.setAttribute('aria-label', `${this.label}. ${told}`);
    }
}
