import './snakes.css';

import type { App } from '../app';
import { h, icon, iconButton } from '../dom';
import { SnakeFields } from './fields';
import { imageEndings } from './files';
import { ImageView } from './image_view';
import { SnakeModel, type Tool } from './model';

const toolNames: readonly (readonly [Tool, string, string, string])[] = [
  ['draw', 'material', 'Draw', 'Draw a snake by hand (D)'],
  ['ellipse', 'ellipse', 'Ellipse', 'Draw an ellipse from corner to corner, with Shift a circle (E)'],
  ['points', 'points', 'Points', 'Drag control points (P)'],
  ['pull', 'grab', 'Pull', 'Draw a contour with a spring, which runs meanwhile (G)'],
  ['volcano', 'volcano', 'Volcano', 'Put a volcano, which pushes snakes away; a click takes it away again (K)'],
];

const hints: Record<Tool, string> = {
  draw: 'Draw along what you look for.',
  ellipse: 'Drag from corner to corner.',
  points: 'Drag a control point; a click on another contour shows its points. Beside them the image moves.',
  pull: 'Press on a contour and pull: the snake runs while you hold it.',
  volcano: 'Click where snakes are to be pushed away.',
};

let open: SnakesPanel | null = null;

export async function showSnakes(app: App, file?: File): Promise<void> {
  open ??= new SnakesPanel(app);
  if (file) await open.open(file);
}

/** The workspace of images: it covers the page until it is closed. */
class SnakesPanel {
  private readonly model: SnakeModel;
  private readonly view: ImageView;
  private readonly element: HTMLElement;
  private readonly others: HTMLElement[];
  private readonly notices = document.querySelector<HTMLElement>('.notices')!;
  private readonly stage = document.querySelector<HTMLElement>('.stage')!;
  private readonly sessions: number;
  private readonly run: HTMLButtonElement;
  private readonly picker = h('input', { type: 'file', accept: imageEndings.join(), hidden: true, aria: { label: 'Image to open' } });

  constructor(private readonly app: App) {
    this.model = new SnakeModel(app);
    this.view = new ImageView(this.model);
    this.sessions = app.documents.sessions;
    this.run = iconButton('play', 'Run or stop (Space)', () => void this.model.run(!this.model.running), 'Run');
    this.run.classList.add('snakes-run');
    const page = document.getElementById('studio')!;
    this.others = [...page.children] as HTMLElement[];
    this.element = h('section', { class: 'snakes', aria: { label: 'Snakes in an image' } },
      this.bar(),
      h('div', { class: 'snakes-stage' }, this.view.element, this.welcome(), this.notices),
      new SnakeFields(this.model).element,
      this.status());
    for (const other of this.others) other.inert = true;
    page.append(this.element);
    this.picker.addEventListener('change', () => {
      const file = this.picker.files?.[0];
      this.picker.value = '';
      if (file) void this.open(file);
    });
    this.model.onImage = () => this.view.fit();
    document.addEventListener('keydown', this.key);
    app.onChange.push(this.look);
    this.model.changed();
  }

  async open(file: File): Promise<void> {
    try {
      await this.model.open(file);
    } catch (error) {
      this.model.tell(error);
    }
  }

  private async leave(): Promise<void> {
    if (this.model.script.snakes.length > 0) {
      const choice = await this.app.ask({ title: 'Close the image?', text: 'Its snakes are lost unless you save them.', choices: [{ id: 'close', label: 'Close it' }] });
      if (choice !== 'close') return;
    }
    this.close();
  }

  close(): void {
    document.removeEventListener('keydown', this.key);
    this.app.onChange.splice(this.app.onChange.indexOf(this.look), 1);
    this.view.close();
    this.model.close();
    this.stage.append(this.notices);
    this.element.remove();
    for (const other of this.others) other.inert = false;
    open = null;
    this.app.changed();
  }

  /** Another document was opened beside it. */
  private readonly look = (): void => {
    if (this.app.documents.sessions !== this.sessions) this.close();
  };

  private readonly key = (event: KeyboardEvent): void => {
    const target = event.target as HTMLElement;
    if (target.closest('input[type=text], textarea, dialog') || event.altKey) return;
    if (event.ctrlKey || event.metaKey) {
      const key = event.key.toLowerCase();
      if (key !== 'z' && key !== 'y') return;
      event.preventDefault();
      return this.travel(key === 'z' && !event.shiftKey);
    }
    const tool = ({ d: 'draw', e: 'ellipse', p: 'points', g: 'pull', k: 'volcano' } as const)[event.key.toLowerCase()];
    if (tool) this.choose(tool);
    else if (event.key === ' ' && !(target instanceof HTMLButtonElement)) void this.model.run(!this.model.running);
    else if (event.key === 'f' || event.key === 'F') this.view.fit();
    else if (event.key === '+') this.view.zoom(1.25);
    else if (event.key === '-') this.view.zoom(0.8);
    else if (event.key === 'o') this.picker.click();
    else if (event.key === 'Escape') this.view.cancel();
    else if (event.key === 'Delete' && this.model.script.snakes.length > 0) void this.model.remove(this.model.selected);
    else return;
    event.preventDefault();
  };

  private travel(back: boolean): void {
    if (!this.view.busy) void this.model.travel(back);
  }

  private choose(tool: Tool): void {
    this.model.tool = tool;
    this.model.changed();
  }

  private bar(): HTMLElement {
    const { model } = this;
    const tools = toolNames.map(([tool, name, text, label]) => [tool, iconButton(name, label, () => this.choose(tool), text)] as const);
    const again = iconButton('restart', 'All snakes again from where they were drawn', () => void model.again(), 'Again');
    const undo = iconButton('undo', 'Undo (Ctrl+Z)', () => this.travel(true)), redo = iconButton('redo', 'Redo (Ctrl+Shift+Z)', () => this.travel(false));
    const closed = h('button', { class: 'chip', type: 'button', title: 'Whether what is drawn by hand is closed', onclick: () => {
      model.closed = !model.closed;
      model.changed();
    } });
    const save = h('details', { class: 'menu' },
      h('summary', { class: 'button labelled', title: 'Save contours and script', aria: { label: 'Save contours and script' } }, icon('save'), h('span', {}, 'Save')),
      h('div', { class: 'menu-list' }, ...([
        ['Contours, JSON', 'degree, knots, control points', () => model.saveContours('json')],
        ['Contours, CSV', 'points along them, in pixels', () => model.saveContours('csv')],
        ['Contours, SVG', 'a drawing that lies on the image', () => model.saveContours('svg')],
        ['Mask, PNG', 'white inside of closed contours', () => model.saveMask()],
        ['Script', 'where the snakes began, energies and settings: knead snake IMAGE --script FILE', () => model.saveScript()],
      ] as const).map(([name, about, act]) => h('button', { type: 'button', class: 'menu-item', onclick: () => {
        save.open = false;
        void act();
      } }, h('b', {}, name), h('small', {}, about)))));
    save.addEventListener('keydown', (e) => {
      if (e.key === 'Escape') save.open = false;
    });
    const name = h('span', { class: 'document-name' });
    model.onChange.push(() => {
      for (const [tool, button] of tools) {
        button.classList.toggle('on', model.tool === tool);
        button.setAttribute('aria-pressed', String(model.tool === tool));
        button.disabled = !model.image;
      }
      closed.textContent = model.closed ? 'Closed' : 'Open';
      closed.classList.toggle('on', model.closed);
      closed.setAttribute('aria-pressed', String(model.closed));
      closed.hidden = model.tool !== 'draw';
      undo.disabled = !model.past.undo;
      redo.disabled = !model.past.redo;
      this.run.disabled = again.disabled = model.script.snakes.length === 0;
      this.run.replaceChildren(icon(model.running ? 'pause' : 'play'), h('span', {}, model.running ? 'Stop' : 'Run'));
      name.textContent = model.image ? model.image.name : '';
      this.element.dataset.tool = model.tool;
      this.element.dataset.running = String(model.running);
    });
    return h('header', { class: 'snakes-bar' },
      h('h2', {}, 'Snakes'),
      iconButton('open', 'Open an image, PNG or JPEG (O)', () => this.picker.click(), 'Open'), save, this.picker,
      h('span', { class: 'rule' }), undo, redo,
      h('span', { class: 'rule' }), ...tools.map(([, button]) => button), closed,
      h('span', { class: 'rule' }), this.run, again,
      h('span', { class: 'spacer' }), name, h('span', { class: 'spacer' }),
      iconButton('fit', 'Fit the image (F)', () => this.view.fit()),
      iconButton('theme', 'Light or dark', () => this.app.setTheme(this.app.theme === 'dark' ? 'light' : 'dark')),
      iconButton('close', 'Close the image, back to the surfaces', () => void this.leave()));
  }

  /** What stands in place of an image. */
  private welcome(): HTMLElement {
    const element = h('div', { class: 'snakes-welcome' },
      h('p', {}, 'Snakes are curves that an image draws to its outlines, while they resist stretching and bending as surfaces do.'),
      h('button', { class: 'button labelled first', type: 'button', onclick: () => this.picker.click() }, icon('open'), h('span', {}, 'Open an image')),
      h('small', {}, 'PNG or JPEG, or drop one here. It stays on your machine.'));
    this.model.onChange.push(() => (element.hidden = this.model.image !== null));
    return element;
  }

  private status(): HTMLElement {
    const { model } = this;
    const hint = h('span', { class: 'hint' }), numbers = h('span', { class: 'snakes-numbers', aria: { live: 'off' } });
    model.onChange.push(() => {
      const { states } = model.snakes, most = Math.max(0, ...states.map((s) => s.iterations)), resting = states.filter((s) => s.resting).length;
      hint.textContent = model.image ? hints[model.tool] : '';
      const how = model.running ? 'running' : states.length === 0 ? '' : resting === states.length ? 'at rest' : 'stopped';
      const size = model.image ? `${model.image.pixels.width} × ${model.image.pixels.height} pixels` : '';
      numbers.textContent = [size, states.length > 0 ? `${most} iterations, ${how}` : ''].filter(Boolean).join('  ·  ');
    });
    return h('footer', { class: 'snakes-status' }, hint, h('span', { class: 'spacer' }), numbers);
  }
}
