import { format } from '../../document/units';
import { h, iconButton, select } from '../dom';
import { type Direction, knotText, moved, parseKnots } from './knots';
import type { LabModel, What } from './model';
import { functionName, orderName, sup } from './names';

const mostIntegrals = 8;

/** Which functions are shown: direction, degree, derivative or integral. */
export class LabControls {
  readonly element: HTMLElement;
  private readonly directions: Record<Direction, HTMLButtonElement>;
  private readonly degree: HTMLSelectElement;
  private readonly order: HTMLSelectElement;
  private readonly integrate = this.step(-1, 'Integrate', '∫');
  private readonly differentiate = this.step(1, 'Differentiate', 'd/du');
  private listed = 0; // the degree that the list of orders was made for

  constructor(private readonly model: LabModel) {
    const chip = (d: Direction) => h('button', { class: 'chip', type: 'button', onclick: () => model.turn(d), aria: { label: `Direction ${d}` } }, d);
    this.directions = { u: chip('u'), v: chip('v') };
    const degrees = Array.from({ length: 25 }, (_, k) => [String(k + 1), `degree ${k + 1}`] as const);
    this.degree = select('Degree', degrees, '', (k) => model.setDegree(Number(k)));
    this.order = select('What is plotted', [], '', (k) => model.setOrder(Number(k)));
    this.element = h('div', { class: 'lab-line tight' }, this.directions.u, this.directions.v, this.degree, this.integrate, this.order, this.differentiate);
    this.update();
  }

  update(): void {
    const { model } = this;
    const { degree } = model.now;
    for (const [d, chip] of Object.entries(this.directions)) {
      chip.classList.toggle('on', d === model.direction);
      chip.setAttribute('aria-pressed', String(d === model.direction));
      chip.disabled = !model.surface;
    }
    this.degree.value = String(degree);
    const last = Math.min(31, 2 * degree + 1);
    if (this.listed !== degree) {
      this.listed = degree;
      this.order.replaceChildren(...Array.from({ length: mostIntegrals + last + 1 }, (_, k) => k - mostIntegrals)
        .map((k) => h('option', { value: String(k) }, orderName(k, degree))));
    }
    this.order.value = String(model.order);
    this.integrate.disabled = model.order <= -mostIntegrals;
    this.differentiate.disabled = model.order >= last;
  }

  private step(by: number, label: string, text: string): HTMLButtonElement {
    return h('button', { class: 'button small', type: 'button', aria: { label }, title: label, onclick: () => this.model.setOrder(this.model.order + by) }, text);
  }
}

/** The knots as text, the one touched last as a number, and the transfer back to the surface. */
export class KnotFields {
  readonly element: HTMLElement;
  private readonly list = h('input', { class: 'number lab-list', type: 'text', spellcheck: false, autocomplete: 'off', aria: { label: 'All knots' } });
  private readonly index = h('span', { class: 'lab-label' });
  private readonly one = h('input', { class: 'number lab-one', type: 'text', inputMode: 'decimal', spellcheck: false, autocomplete: 'off', aria: { label: 'Value of the knot' } });
  private readonly reset = h('button', { class: 'button small', type: 'button', title: 'Back to the knots of the surface', onclick: () => this.model.reset() }, 'Reset');
  private readonly apply = h('button', { class: 'button small lab-apply', type: 'button', onclick: () => void this.model.apply() }, 'Apply');
  private readonly message = h('p', { class: 'note lab-message', role: 'status' });
  private readonly detail = h('p', { class: 'note lab-detail', hidden: true });

  constructor(private readonly model: LabModel) {
    this.list.addEventListener('change', () => this.takeList());
    this.one.addEventListener('change', () => this.takeOne());
    for (const input of [this.list, this.one]) {
      input.addEventListener('keydown', (e) => {
        e.stopPropagation();
        if (e.key === 'Enter') input.blur();
        if (e.key === 'Escape') {
          this.write(true);
          input.blur();
        }
      });
    }
    const insert = iconButton('step', 'Insert a knot in the middle of the longest span', () => this.halve());
    insert.replaceChildren('+');
    insert.classList.add('small');
    this.element = h('div', { class: 'lab-fields' },
      h('div', { class: 'lab-line tight' }, this.list, this.index, this.one, insert),
      h('div', { class: 'lab-line tight' }, this.message, this.detail, this.reset, this.apply));
    this.write(true);
  }

  update(what: Set<What>): void {
    this.write(false);
    this.describe();
    if (what.has('knots')) this.list.classList.remove('wrong');
  }

  private write(evenFocused: boolean): void {
    const { model } = this;
    const { knots } = model.now;
    if (evenFocused || document.activeElement !== this.list) this.list.value = knotText(knots);
    const active = model.active >= 0 && model.active < knots.length ? model.active : -1;
    this.index.textContent = active < 0 ? 'Knot' : `Knot ${active}`;
    this.one.disabled = active < 0;
    if (evenFocused || document.activeElement !== this.one) this.one.value = active < 0 ? '' : String(knots[active]);
    const { change } = model;
    this.reset.disabled = !model.edited;
    this.apply.disabled = change.kind !== 'command';
    this.apply.setAttribute('aria-label', 'Apply to the surface');
    this.apply.title = change.kind === 'command' ? change.about : change.kind === 'same' ? 'These are the knots of the surface' : change.why;
    const about = !model.surface ? 'No surface is open: these knots belong to nothing.'
      : change.kind === 'same' ? `Direction ${model.direction} of “${model.surface.name}”.${model.surface.rational ? ' It has weights: these are the polynomial functions below them.' : ''}`
        : change.kind === 'command' ? `Edited: ${change.about}.` : `Edited, for looking only: ${change.why}.`;
    this.message.classList.toggle('error', model.error !== '');
    this.message.textContent = model.error ? model.error[0]!.toUpperCase() + model.error.slice(1) : about;
    this.message.title = this.message.textContent;
  }

  /** What is pointed at, in words: a function, or two and where both are. */
  private describe(): void {
    const { highlight, now, basis, module } = this.model;
    this.detail.hidden = !highlight || this.model.error !== '';
    this.message.hidden = !this.detail.hidden;
    if (!highlight) return;
    const { i, j } = highlight;
    const [low, high] = [now.knots[Math.max(i, j)]!, now.knots[Math.min(i, j) + now.degree + 1]!];
    const support = `[${format(low)}, ${format(high)}]`;
    if (i !== j) {
      this.detail.textContent = `${functionName(i, 0)} and ${functionName(j, 0)}: ${low < high ? `both on ${support}` : 'nowhere both'}`;
      return;
    }
    // Jumps of the lowest order show how smooth a function is at a knot.
    const smooth = module.jumps(i).map((at) => [at.knot, at.lowest - 1] as const);
    const usual = Math.max(...smooth.map(([, c]) => c));
    const less = smooth.filter(([, c]) => c < usual).map(([knot, c]) => `${continuity(c)} at ${format(knot)}`);
    this.detail.textContent = `${functionName(i, 0)}: support ${support}, Greville ${format(basis.greville[i]!)}, integral ${format(basis.integrals[i]!)}, ` +
      `${continuity(usual)}${less.length > 0 ? `, ${less.join(', ')}` : ''}`;
  }

  private takeList(): void {
    const { model } = this;
    const knots = parseKnots(this.list.value);
    if (!Array.isArray(knots)) {
      model.error = `“${knots.text}”, entry ${knots.at}, is not a number; write numbers separated by commas`;
      model.changed('surface');
      this.list.classList.add('wrong');
      return;
    }
    this.list.classList.toggle('wrong', !model.edit({ degree: model.now.degree, knots }));
  }

  private takeOne(): void {
    const { model } = this;
    const value = Number(this.one.value.trim().replace(',', '.'));
    const good = this.one.value.trim() !== '' && Number.isFinite(value);
    this.one.classList.toggle('wrong', !good);
    if (!good) return;
    const knots = moved(model.now.knots, model.active, model.active, value);
    if (knots[model.active] !== value) {
      model.error = `${value} is beyond a neighbour; give a number from ${model.now.knots[model.active - 1] ?? '−∞'} to ${model.now.knots[model.active + 1] ?? '∞'}`;
      model.changed('surface');
      return;
    }
    model.edit({ degree: model.now.degree, knots });
  }

  private halve(): void {
    const { model } = this;
    const { knots, degree } = model.now;
    const [low, high] = model.basis.domain;
    let longest = -1;
    knots.forEach((x, k) => {
      const length = knots[k + 1]! - x;
      if (x >= low && knots[k + 1]! <= high && (longest < 0 || length > knots[longest + 1]! - knots[longest]!)) longest = k;
    });
    const middle = (knots[longest]! + knots[longest + 1]!) / 2;
    const more = [...knots.slice(0, longest + 1), middle, ...knots.slice(longest + 1)];
    if (model.edit({ degree, knots: more })) model.touch(longest + 1);
  }
}

const continuity = (order: number): string => (order < 0 ? 'jumps' : `C${sup(order)}`);
