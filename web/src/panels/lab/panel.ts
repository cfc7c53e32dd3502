import './lab.css';

import { download } from '../../document/download';
import type { App } from '../app';
import { h, iconButton } from '../dom';
import { copyText, curvesCsv, gramiansCsv, svgText } from './export';
import { GramianView } from './gramian_view';
import wasmUrl from './knead_lab.wasm?url';
import { KnotFields, LabControls } from './knot_fields';
import { LabModel, type What } from './model';
import { LabModule } from './module';
import { Plot } from './plot';

type Dock = 'below' | 'beside';

const settleTime = 200; // milliseconds without a frame, after which the surface's knots are read again
const smallest = 180;
let open: LabPanel | null = null;
let opening: Promise<void> | null = null;

/** Opens the panel of basis functions and Gramians, or closes it if it is open. */
export async function toggleLab(app: App): Promise<void> {
  if (open) return open.close();
  opening ??= (async () => {
    const module = await LabModule.load(fetch(wasmUrl));
    const model = new LabModel(app, module);
    await model.follow();
    open = new LabPanel(app, model);
  })().finally(() => (opening = null));
  return opening;
}

class LabPanel {
  private readonly stage = document.querySelector<HTMLElement>('.stage')!;
  private readonly element: HTMLElement;
  private readonly plot: Plot;
  private readonly gramian: GramianView;
  private readonly divider: HTMLElement;
  private readonly dockButton = iconButton('dock', 'Beside the views', () => this.dock(this.where === 'below' ? 'beside' : 'below'));
  private where: Dock;
  private readonly sizes: Record<Dock, number>;
  private theme: string;
  private timer = 0;
  private seen = -1;

  constructor(private readonly app: App, private readonly model: LabModel) {
    const kept = readKept();
    this.where = kept.dock ?? (this.stage.clientWidth > 1300 ? 'beside' : 'below');
    this.sizes = { below: kept.below ?? 0.56, beside: kept.beside ?? 0.48 };
    this.theme = app.theme;
    const dark = () => this.app.theme === 'dark';
    this.plot = new Plot(model, dark);
    this.gramian = new GramianView(model);
    const controls = new LabControls(model);
    const fields = new KnotFields(model);
    const hold = h('button', { class: 'chip', type: 'button', title: 'Keeps the heights of the plot while knots move', aria: { pressed: 'false' }, onclick: () => {
      this.plot.holdScale = !this.plot.holdScale;
      hold.classList.toggle('on', this.plot.holdScale);
      hold.setAttribute('aria-pressed', String(this.plot.holdScale));
      this.plot.draw();
    } }, 'Hold scale');
    this.divider = h('div', { class: 'lab-divider', tabIndex: 0, role: 'separator', aria: { label: 'Size of the panel' } });
    this.element = h('section', { class: 'lab', aria: { label: 'Basis functions and Gramians' } },
      this.divider,
      h('header', { class: 'lab-bar' },
        h('h2', {}, 'Basis and Gramians'), h('span', { class: 'spacer' }), hold,
        this.textButton('Samples CSV', 'Copy the plotted samples as CSV', () => this.copy(curvesCsv(this.model.curves), 'samples.csv')),
        this.textButton('Gramian CSV', 'Copy the Gramian by all methods as CSV', () => this.copy(gramiansCsv(this.model.gramians), 'gramian.csv')),
        this.textButton('SVG', 'Save the plot as SVG', () => this.saveSvg()),
        this.dockButton, iconButton('close', 'Close the panel', () => this.close())),
      h('div', { class: 'lab-body' },
        h('div', { class: 'lab-functions' }, controls.element, this.plot.element, fields.element),
        this.gramian.element));
    this.stage.append(this.element);
    this.divide();
    this.dock(this.where);
    model.onChange.push((what: Set<What>) => {
      controls.update();
      fields.update(what);
      this.plot.update(what);
      this.gramian.update(what);
      this.element.dataset.drawn = String(Number(this.element.dataset.drawn ?? 0) + 1);
    });
    app.onChange.push(this.look);
    model.changed('knots');
    this.element.addEventListener('keydown', (e) => {
      if (e.key !== 'Escape') return;
      e.stopPropagation();
      this.close();
    });
  }

  close(): void {
    this.app.onChange.splice(this.app.onChange.indexOf(this.look), 1);
    clearTimeout(this.timer);
    this.plot.close();
    this.gramian.close();
    this.model.close();
    // Keys go to the views again.
    if (this.element.contains(document.activeElement)) this.stage.querySelector<HTMLElement>('.view-perspective')?.focus({ preventScroll: true });
    this.element.remove();
    this.stage.classList.remove('lab-below', 'lab-beside');
    this.stage.style.removeProperty('--lab-size');
    open = null;
    this.app.changed();
  }

  /** The session may now have other knots, the page other colours. */
  private readonly look = (): void => {
    const { app } = this;
    if (this.theme !== app.theme) {
      this.theme = app.theme;
      this.plot.draw();
      this.gramian.draw();
    }
    if (this.seen === app.changes) return;
    this.seen = app.changes;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => {
      if (!app.playing() && !app.hand.brush.active) void this.model.follow().catch(() => {}); // closed or busy: the next frame asks again
    }, settleTime);
  };

  private textButton(text: string, label: string, act: () => void): HTMLElement {
    return h('button', { class: 'button small', type: 'button', title: label, aria: { label }, onclick: act }, text);
  }

  private copy(text: string, name: string): void {
    void copyText(text, name).then((copied) => this.app.notify({ kind: 'info', text: copied ? 'Copied.' : `Saved as ${name}: the browser keeps its clipboard to itself.` }));
  }

  private saveSvg(): void {
    const ground = getComputedStyle(document.documentElement).getPropertyValue('--panel').trim();
    download(svgText(this.plot.svg, ground), 'basis.svg', 'image/svg+xml');
  }

  // --- where it is -------------------------------------------------------------------------------------------------

  private dock(where: Dock): void {
    this.where = where;
    this.stage.classList.toggle('lab-below', where === 'below');
    this.stage.classList.toggle('lab-beside', where === 'beside');
    const label = where === 'below' ? 'Beside the views' : 'Below the views';
    this.dockButton.title = label;
    this.dockButton.setAttribute('aria-label', label);
    this.divider.setAttribute('aria-orientation', where === 'below' ? 'horizontal' : 'vertical');
    this.resize(this.sizes[where]);
  }

  /** The share of the stage that the panel takes. */
  private resize(share: number): void {
    const whole = this.where === 'below' ? this.stage.clientHeight : this.stage.clientWidth;
    const kept = Math.min(0.9, Math.max(smallest / Math.max(1, whole), share));
    this.sizes[this.where] = kept;
    this.stage.style.setProperty('--lab-size', `${(100 * kept).toFixed(2)}%`);
    for (const [name, value] of [['now', kept], ['min', 0], ['max', 1]] as const) this.divider.setAttribute(`aria-value${name}`, String(Math.round(100 * value)));
    try {
      localStorage.setItem('knead-lab', JSON.stringify({ dock: this.where, ...this.sizes }));
    } catch {
      // Without storage the position lasts until the page is closed.
    }
  }

  private divide(): void {
    const { divider } = this;
    divider.addEventListener('pointerdown', (e) => {
      divider.setPointerCapture(e.pointerId);
      e.preventDefault();
    });
    divider.addEventListener('pointermove', (e) => {
      if (!divider.hasPointerCapture(e.pointerId)) return;
      const box = this.stage.getBoundingClientRect();
      this.resize(this.where === 'below' ? (box.bottom - e.clientY) / box.height : (box.right - e.clientX) / box.width);
    });
    divider.addEventListener('keydown', (e) => {
      const by = { ArrowUp: 0.04, ArrowLeft: 0.04, ArrowDown: -0.04, ArrowRight: -0.04 }[e.key];
      if (by === undefined) return;
      this.resize(this.sizes[this.where] + by);
      e.preventDefault();
      e.stopPropagation();
    });
  }
}

function readKept(): { dock?: Dock; below?: number; beside?: number } {
  try {
    return JSON.parse(localStorage.getItem('knead-lab') ?? '{}') as { dock?: Dock; below?: number; beside?: number };
  } catch {
    return {};
  }
}
