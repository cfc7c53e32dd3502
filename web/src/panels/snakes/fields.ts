import { format } from '../../document/units';
import { field, h, icon, iconButton, select, toggle } from '../dom';
import { numberInput } from '../number_input';
import { note, row } from '../panel';
import { imageEndings } from './files';
import type { SnakeModel } from './model';
import { type Field, imageFields, type ImageNumber, moreFields, moreImageFields, presets, snakeFields } from './script';

/** The column beside the image: energies, settings, the list of snakes. Made anew when what it shows has changed. */
export class SnakeFields {
  readonly element = h('aside', { class: 'snakes-fields', aria: { label: 'Energies and settings' } });
  private readonly list = h('ul', { class: 'list snakes-list' });
  private drawn = '';
  private open = false;

  constructor(private readonly model: SnakeModel) {
    model.onChange.push(() => this.draw());
    this.element.addEventListener('focusout', () => setTimeout(() => this.draw(), 0));
    this.draw();
  }

  private draw(): void {
    const { model } = this;
    this.drawList();
    const { image, settings, volcanoes, mask } = model.script;
    const now = JSON.stringify([image, settings, volcanoes.length, mask, model.preset.name, model.spring, model.volcano, model.keepSprings, model.holdEnds, model.energy !== null, model.image?.name, model.script.snakes.length > 0]);
    if (now === this.drawn) return;
    const focus = document.activeElement;
    if (this.element.contains(focus) && focus instanceof HTMLInputElement && focus.type === 'text') return; // once it is left
    this.drawn = now;
    const name = this.element.contains(focus) ? focus?.getAttribute('aria-label') : null;
    const picker = h('input', { type: 'file', accept: imageEndings.join(), hidden: true, aria: { label: 'Mask to open' } });
    picker.addEventListener('change', () => {
      const file = picker.files?.[0];
      if (file) void model.openMask(file).catch((error: unknown) => model.tell(error));
    });
    const more = h('details', { class: 'more', open: this.open }, h('summary', {}, 'More settings'), ...moreFields.map((f) => this.setting(f)), ...moreImageFields.map((f) => this.energy(f)));
    more.addEventListener('toggle', () => (this.open = more.open));
    this.element.replaceChildren(
      h('section', {}, h('h3', {}, 'Snakes'), this.list, model.script.snakes.length === 0 ? note('None yet: draw one in the image.') : null),
      h('section', {}, h('h3', {}, 'What attracts'),
        field('Kind', select('Kind of energy', presets.map((p) => [p.name, p.name] as const), model.preset.name, (chosen) => void model.choose(presets.find((p) => p.name === chosen)!))),
        note(`${model.preset.about}.`),
        ...imageFields.map((f) => this.energy(f)),
        row(h('button', { class: 'button small', type: 'button', title: 'An image whose white parts the energy “Mask” draws to', disabled: !model.image, onclick: () => picker.click() }, mask ? `Mask: ${mask}` : 'Open a mask…'), picker,
          toggle('Relative', image.relative_region, (on) => void model.apply((script) => ({ ...script, image: { ...script.image, relative_region: on } })), 'Regions count in the difference of the means, at most 1: the same force for what is pale and what is bright'),
          toggle('Show the energy', model.energy !== null, (on) => void model.showEnergy(on), 'What attracts, in place of the image: white draws most. Forces along the normal, as regions and the balloon, are not in it'))),
      h('section', {}, h('h3', {}, 'How the snake resists'), ...snakeFields.map((f) => this.setting(f)), more),
      h('section', {}, h('h3', {}, 'By hand'),
        this.line('Spring', 'Force per pixel by which a drag draws a contour. Too strong a pull far across others makes a contour cross itself.', model.spring, (spring) => {
          model.spring = spring;
          model.changed();
        }),
        this.line('Volcano', 'Force of a new volcano at its rim, from where it falls with the square of the distance: small against what attracts, or it moves snakes that are far away.', model.volcano, (volcano) => {
          model.volcano = volcano;
          model.changed();
        }),
        row(toggle('Springs stay', model.keepSprings, (keep) => {
          model.keepSprings = keep;
          model.changed();
        }, 'A spring stays where the drag ends; it is in the script, too. Drag its end to move it'),
          toggle('Ends held', model.holdEnds, (hold) => {
            model.holdEnds = hold;
            model.changed();
          }, 'Of open snakes that are drawn from now on; free ones give way')),
        volcanoes.length > 0 ? row(h('button', { class: 'button small', type: 'button', onclick: () => void model.setVolcanoes([]) }, volcanoes.length === 1 ? 'Remove the volcano' : `Remove ${volcanoes.length} volcanoes`)) : null),
    );
    if (name) this.element.querySelector<HTMLElement>(`[aria-label="${CSS.escape(name)}"]`)?.focus({ preventScroll: true });
  }

  private drawList(): void {
    const { model } = this, { states, netFrom } = model.snakes;
    while (this.list.children.length > states.length) this.list.lastChild!.remove();
    states.forEach(({ closed, iterations, resting }, k) => {
      let item = this.list.children[k];
      if (!item) {
        item = h('li', { class: 'with-action' },
          h('button', { class: 'item', type: 'button', onclick: () => {
            model.selected = k;
            model.changed();
          } }, h('span'), h('small')),
          iconButton('trash', `Remove snake ${k + 1}`, () => void model.remove(k)));
        this.list.append(item);
      }
      const button = item.firstElementChild!;
      button.classList.toggle('on', k === model.selected);
      button.children[0]!.textContent = `${k + 1}: ${closed ? 'closed' : 'open'}, ${netFrom[k + 1]! - netFrom[k]!} points`;
      button.children[1]!.textContent = resting ? `at rest after ${iterations}` : `${iterations}`;
    });
  }

  private energy({ key, label, about, whole }: Field<ImageNumber>): HTMLElement {
    const { model } = this;
    return this.line(label, about, model.script.image[key], (value) => model.refusal((script) => ({ ...script, image: { ...script.image, [key]: whole ? Math.round(value) : value } })), whole, !model.image);
  }

  private setting({ key, label, about, whole }: Field<keyof SnakeModel['script']['settings']>): HTMLElement {
    const { model } = this;
    return this.line(label, about, model.script.settings[key], (value) => model.refusal((script) => ({ ...script, settings: { ...script.settings, [key]: whole ? Math.round(value) : value } })), whole, !model.image);
  }

  /** A number with its name, and a mark that unfolds what it means. */
  private line(label: string, about: string, value: number, change: (value: number) => void | Promise<string | null>, whole = false, disabled = false): HTMLElement {
    const input = numberInput(label, value, change, (text) => {
      const number = Number(text.replace(',', '.'));
      return text.trim() === '' || !Number.isFinite(number) ? null : whole ? Math.round(number) : number;
    });
    input.value = format(value);
    input.disabled = disabled;
    const meaning = h('p', { class: 'note meaning', hidden: true }, about);
    const ask = h('button', { class: 'button ask', type: 'button', title: about, aria: { label: `What “${label}” means`, expanded: 'false' }, onclick: () => {
      meaning.hidden = !meaning.hidden;
      ask.setAttribute('aria-expanded', String(!meaning.hidden));
    } }, icon('help'));
    return h('div', { class: 'snakes-line' }, field(label, input, about), ask, meaning);
  }
}
