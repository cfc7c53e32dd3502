import { h } from '../dom';
import type { Highlight } from './model';

export interface BandTable {
  size: number;
  bandwidth: number;
  values: Float64Array;
}

/** How a value is coloured: by sign and size, by the power of ten of its size, or whether it is there at all. */
export type Scale = 'signed' | 'power' | 'spy';

const red = [204, 66, 52];
const blue = [52, 112, 204];
const powers = [-18, -10] as const; // of a relative difference: no colour, full colour

/** A small picture of a matrix; pointing at it names the entry. */
export class HeatMap {
  readonly canvas: HTMLCanvasElement;
  readonly caption: HTMLElement;
  readonly element: HTMLElement;
  private table: BandTable | null = null;
  private scale: Scale = 'signed';
  private readonly cells = document.createElement('canvas');

  constructor(name: string, point: (at: Highlight | null) => void, pick: (at: Highlight) => void) {
    this.canvas = h('canvas', { class: 'lab-map', role: 'img', aria: { label: name } });
    this.caption = h('figcaption', {}, name);
    this.element = h('figure', { class: 'lab-figure' }, this.canvas, this.caption);
    this.canvas.addEventListener('pointermove', (e) => point(this.at(e)));
    this.canvas.addEventListener('pointerleave', () => point(null));
    this.canvas.addEventListener('click', (e) => {
      const at = this.at(e);
      if (at) pick(at);
    });
  }

  private at(event: MouseEvent): Highlight | null {
    const n = this.table?.size ?? 0;
    const box = this.canvas.getBoundingClientRect();
    const j = Math.floor(((event.clientX - box.left) / box.width) * n);
    const i = Math.floor(((event.clientY - box.top) / box.height) * n);
    return i >= 0 && i < n && j >= 0 && j < n ? { i, j } : null;
  }

  show(table: BandTable, scale: Scale, accent: string): void {
    this.table = table;
    this.scale = scale;
    const { size: n, bandwidth: p, values } = table;
    this.cells.width = this.cells.height = n;
    const context = this.cells.getContext('2d')!;
    const image = context.createImageData(n, n);
    const largest = scale === 'signed' ? values.reduce((most, x) => (Number.isFinite(x) ? Math.max(most, Math.abs(x)) : most), 0) : 1;
    const own = parse(accent);
    for (let i = 0; i < n; ++i) {
      for (let j = Math.max(0, i - p); j <= Math.min(n - 1, i + p); ++j) {
        const [colour, strength] = this.shade(values[i * (2 * p + 1) + j - i + p]!, largest, own);
        image.data.set([...colour, Math.round(255 * strength)], 4 * (i * n + j));
      }
    }
    context.putImageData(image, 0, 0);
  }

  /** A colour and its intensity. Roots make small entries visible beside large ones. */
  private shade(value: number, largest: number, own: number[]): [number[], number] {
    if (!Number.isFinite(value)) return [red, 1];
    if (this.scale === 'spy') return [own, value === 0 ? 0.14 : 1];
    if (value === 0) return [own, 0.08];
    if (this.scale === 'signed') return [value > 0 ? red : blue, 0.1 + 0.9 * Math.sqrt(Math.abs(value) / largest)];
    const t = (Math.log10(value) - powers[0]) / (powers[1] - powers[0]);
    return [red, 0.12 + 0.88 * Math.min(1, Math.max(0, t))];
  }

  /** Puts the picture on the page, with the row and the column under the pointer. */
  draw(highlight: Highlight | null, line: string): void {
    const { canvas } = this;
    const ratio = Math.min(window.devicePixelRatio, 2);
    const side = Math.max(1, Math.round(canvas.clientWidth * ratio));
    if (canvas.width !== side) canvas.width = canvas.height = side;
    const context = canvas.getContext('2d')!;
    context.clearRect(0, 0, side, side);
    const n = this.table?.size ?? 0;
    if (n === 0) return;
    context.imageSmoothingEnabled = n > side;
    context.drawImage(this.cells, 0, 0, side, side);
    const cell = side / n;
    if (this.scale === 'spy' && cell > 5) {
      // Gaps between the entries make them countable.
      context.save();
      context.globalCompositeOperation = 'destination-out';
      for (let k = 1; k < n; ++k) {
        context.fillRect(k * cell - 0.5, 0, 1, side);
        context.fillRect(0, k * cell - 0.5, side, 1);
      }
      context.restore();
    }
    if (!highlight) return;
    context.strokeStyle = line;
    context.lineWidth = ratio;
    context.globalAlpha = 0.55;
    context.strokeRect(-ratio, highlight.i * cell, side + 2 * ratio, cell);
    context.strokeRect(highlight.j * cell, -ratio, cell, side + 2 * ratio);
    context.globalAlpha = 1;
    context.lineWidth = 2 * ratio;
    context.strokeRect(highlight.j * cell, highlight.i * cell, cell, cell);
  }
}

/** #rrggbb */
function parse(colour: string): number[] {
  const digits = /^#([0-9a-f]{6})/i.exec(colour.trim())?.[1] ?? '3fb6a8';
  return [0, 2, 4].map((k) => parseInt(digits.slice(k, k + 2), 16));
}
