import { h, select } from '../dom';
import { EntryTable } from './entry_table';
import { type BandTable, HeatMap, type Scale } from './heat_map';
import type { Highlight, LabModel, What } from './model';
import { type Gramians, methods, pairs } from './module';
import { duration, exact, gramianName, sub, tiny } from './names';

const shortcuts: [number, number][] = [[0, 0], [1, 0], [1, 1], [2, 2]];
const highest = 15;

/** Every table of a Gramian, by name. */
const tables = {
  gauss: ['gauss', (g: Gramians) => g.values[0]!],
  analytic: ['analytic', (g: Gramians) => g.values[1]!],
  recurrence: ['recurrence', (g: Gramians) => g.values[2]!],
  difference0: ['gauss − recurrence', (g: Gramians) => g.differences[0]!],
  difference1: ['analytic − recurrence', (g: Gramians) => g.differences[1]!],
  difference2: ['analytic − gauss', (g: Gramians) => g.differences[2]!],
  relative0: ['gauss − recurrence, relative', (g: Gramians) => g.relative[0]!],
  relative1: ['analytic − recurrence, relative', (g: Gramians) => g.relative[1]!],
  relative2: ['analytic − gauss, relative', (g: Gramians) => g.relative[2]!],
  absolute: ['∫|product|', (g: Gramians) => g.absolute],
} as const;
type Shown = keyof typeof tables;

/** One Gramian by three methods: maps, numbers, differences, times. */
export class GramianView {
  readonly element: HTMLElement;
  private readonly chips: [HTMLButtonElement, number, number][];
  private readonly orders = h('div', { class: 'row' });
  private readonly byMethod = h('tbody');
  private readonly byPair = h('tbody');
  private readonly entryHead = h('th', { scope: 'col' });
  private readonly hereHead = h('th', { scope: 'col' });
  private readonly maps: [HeatMap, Shown, Scale][];
  private readonly table: EntryTable;
  private readonly method = h('span', { class: 'note' });
  private shown: Shown = 'recurrence';
  private readonly observer: ResizeObserver;

  constructor(private readonly model: LabModel) {
    const point = (at: Highlight | null) => model.show(at);
    this.table = new EntryTable(point);
    const map = (name: string, shown: Shown, scale: Scale) =>
      [new HeatMap(name, point, (at) => this.table.select(at)), shown, scale] as [HeatMap, Shown, Scale];
    this.maps = [map('Gauss', 'gauss', 'signed'), map('Analytic', 'analytic', 'signed'), map('Recurrence', 'recurrence', 'signed'),
      map('Difference', 'relative2', 'power'), map('Spy', 'recurrence', 'spy')];
    this.chips = shortcuts.map(([a, b]) => [h('button', { class: 'chip', type: 'button', onclick: () => model.setGramian(a, b),
      aria: { label: `Gramian of derivatives ${a} and ${b}` } }, `${a}${b}`), a, b]);
    const what = select('Numbers shown', (Object.keys(tables) as Shown[]).map((k) => [k, tables[k][0]] as const), this.shown, (k) => {
      this.shown = k;
      this.draw();
    });
    this.maps[3]![0].element.title = 'analytic − gauss, relative to ∫|product|, by its power of ten from 1e-18 to 1e-10';
    const heads = (...texts: (string | HTMLElement)[]) => h('thead', {}, h('tr', {}, ...texts.map((t) => (typeof t === 'string' ? h('th', { scope: 'col' }, t) : t))));
    this.element = h('div', { class: 'lab-gramian' },
      h('div', { class: 'lab-part' },
        h('div', { class: 'lab-line' }, h('span', { class: 'lab-label' }, 'Gramian'), ...this.chips.map(([c]) => c), this.orders, this.method),
        h('div', { class: 'lab-maps' }, ...this.maps.map(([m]) => m.element)),
        h('div', { class: 'lab-tables' },
          h('table', { class: 'lab-summary', aria: { label: 'The methods' } }, heads('method', 'time', this.entryHead), this.byMethod),
          h('table', { class: 'lab-summary', aria: { label: 'What the methods differ by' } },
            heads('difference', 'largest', 'relative', 'at', this.hereHead, 'relative'), this.byPair))),
      h('div', { class: 'lab-part lab-numbers' },
        h('div', { class: 'lab-line' }, h('span', { class: 'lab-label' }, 'Numbers'), what), this.table.element));
    this.observer = new ResizeObserver(() => this.light());
    this.observer.observe(this.element);
    this.draw();
  }

  close(): void {
    this.observer.disconnect();
    this.table.close();
  }

  update(what: Set<What>): void {
    if (what.has('knots') || what.has('gramian')) this.draw();
    else if (what.has('times')) this.say();
    if (what.has('highlight')) this.light();
  }

  /** Redraws everything, after a change of numbers or colours. */
  draw(): void {
    const { model } = this;
    const { gramians } = model;
    for (const [chip, a, b] of this.chips) {
      const on = a === model.a && b === model.b;
      chip.classList.toggle('on', on);
      chip.setAttribute('aria-pressed', String(on));
    }
    this.drawOrders();
    const accent = style('--accent');
    for (const [map, shown, scale] of this.maps) map.show(this.bands(shown), scale, accent);
    const p = gramians.bandwidth;
    const values = gramians.values[2]!;
    const band = gramians.size * (2 * p + 1) - p * (p + 1);
    this.maps[4]![0].caption.textContent = `Spy: ${values.filter((x) => x !== 0).length}`;
    this.maps[4]![0].canvas.setAttribute('aria-label', `Which of the ${band} entries of the band are not zero`);
    this.maps[4]![0].element.title = `entries that are not zero, of ${band} in the band`;
    this.method.textContent = gramians.used[2] === 'recurrence' ? '' : 'recurrence leaves these orders to gauss';
    this.table.show(this.bands(this.shown), /^(difference|relative)/.test(this.shown));
    this.light();
  }

  private bands(shown: Shown): BandTable {
    const { gramians } = this.model;
    return { size: gramians.size, bandwidth: gramians.bandwidth, values: tables[shown][1](gramians) };
  }

  private drawOrders(): void {
    const { model } = this;
    if (this.orders.contains(document.activeElement)) return;
    const all = Array.from({ length: highest + 1 }, (_, k) => [String(k), String(k)] as const);
    this.orders.replaceChildren(
      select('Derivative of the row functions', all, String(model.a), (k) => model.setGramian(Number(k), model.b)),
      select('Derivative of the column functions', all, String(model.b), (k) => model.setGramian(model.a, Number(k))));
  }

  private light(): void {
    const { highlight } = this.model;
    const line = style('--text');
    for (const [map] of this.maps) map.draw(highlight, line);
    this.table.light(highlight);
    if (highlight && !this.table.element.matches(':hover')) this.table.reveal(highlight);
    this.say();
  }

  /** Methods and their differences: in the whole matrix, and in the entry that is pointed at, with all digits. */
  private say(): void {
    const { model } = this;
    const { bandwidth: p, values, differences, relative, used, worst } = model.gramians;
    const at = model.highlight;
    const beyond = at !== null && Math.abs(at.i - at.j) > p;
    const k = at ? at.i * (2 * p + 1) + at.j - at.i + p : -1;
    const entry = (text: (k: number) => string) => (at === null ? '' : beyond ? '0' : text(k));
    this.entryHead.textContent = at ? this.name(at) : 'entry: point at one';
    this.hereHead.textContent = at ? `at ${at.i}, ${at.j}` : 'here';
    const row = (name: string, ...cells: (string | HTMLElement)[]) => h('tr', {}, h('th', { scope: 'row' }, name), ...cells.map((c) => h('td', {}, c)));
    const method = (m: number) => row(used[m] === methods[m] ? methods[m]! : `${methods[m]} (${used[m]})`,
      model.times ? duration(model.times[m]!) : '…', entry((at) => exact(values[m]![at]!)));
    this.byMethod.replaceChildren(method(0), method(1), method(2));
    const place = ([i, j]: [number, number]) => (i < 0 ? 'nowhere' : h('button', { class: 'link', type: 'button', title: 'Go to this entry',
      onclick: () => this.table.select({ i, j }) }, `${i}, ${j}`));
    this.byPair.replaceChildren(...pairs.map(([first, second], n) => row(`${first} − ${second}`, tiny(worst[n]!.absolute), tiny(worst[n]!.relative),
      place(worst[n]!.relativeAt), entry((at) => tiny(differences[n]![at]!)), entry((at) => tiny(relative[n]![at]!)))));
  }

  private name({ i, j }: Highlight): string {
    return `${gramianName(this.model.a, this.model.b)}${sub(i)}˒${sub(j)}`;
  }
}

const style = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
