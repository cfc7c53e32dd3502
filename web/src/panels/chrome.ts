import { canPick, pickFile } from '../document/disk';
import { dataEndings } from '../document/data_files';
import { readEndings } from '../document/formats';
import type { Notice } from '../document/host';
import { selected, unitOf } from '../engine/session_state';
import { unitInWords } from '../document/units';
import { modes } from '../tools/modes';
import type { App } from './app';
import { h, icon, iconButton } from './dom';
import { galleryMenu } from './gallery_menu';
import { openLab } from './lab/door';
import { recentMenu } from './recent_menu';
import { otherKind, samePlace, saveEntries } from './save_menu';
import { shortcuts } from './shortcuts';
import { openSnakes } from './snakes/door';
import { toggleTour } from './tour';

/** Bars at the top and the left, messages, the overlay of shortcuts, the welcome screen. */

export function topBar(app: App): HTMLElement {
  const picker = h('input', { type: 'file', accept: [...readEndings, ...dataEndings].join(','), hidden: true, aria: { label: 'File to open' } });
  picker.addEventListener('change', () => {
    const file = picker.files?.[0];
    picker.value = '';
    if (file) void app.documents.openFile(file);
  });
  const open = () => {
    if (!canPick()) return picker.click();
    void app.attempt(async () => {
      const picked = await pickFile();
      if (picked) await app.documents.openFile(picked.file, picked.handle);
    });
  };
  const name = h('span', { class: 'document-name' });
  const unit = h('span', { class: 'document-unit', title: 'Unit of the document: lengths without a unit are in it' });
  const undo = iconButton('undo', 'Undo (Ctrl+Z)', () => void app.execute([{ do: 'undo' }]));
  const redo = iconButton('redo', 'Redo (Ctrl+Shift+Z)', () => void app.execute([{ do: 'redo' }]));
  const play = iconButton('play', 'Play or pause (Space)', () => app.togglePlay());
  const step = iconButton('step', 'One step (.)', () => void app.execute([{ do: 'step' }]));
  const rest = iconButton('rest', 'Run to rest (R)', () => app.togglePlay(true));
  const four = iconButton('four', 'Four views or one (4)', () => app.setDisplay({ fourViews: !app.display.fourViews }));
  const save = menu('save', 'Save', 'Save', saveEntries(app));
  const [same, other] = [samePlace, otherKind].map((entry) => [...save.querySelectorAll<HTMLElement>('.menu-item')].find((item) => item.querySelector('b')?.textContent === entry)!);
  const bar = h('header', { class: 'top' },
    h('span', { class: 'brand' }, 'Knead'),
    iconButton('open', 'Open a CAD, Rhino or Knead file, or an image (O)', open, 'Open'), galleryMenu(app), recentMenu(app), save, picker,
    h('span', { class: 'rule' }), undo, redo, h('span', { class: 'rule' }), play, step, rest,
    h('span', { class: 'spacer' }), name, unit, h('span', { class: 'spacer' }),
    ...foldable(
      iconButton('fit', 'Fit everything (Shift+F; F: what is selected)', () => app.viewer.fitAll()), four,
      iconButton('lab', 'Basis functions and Gramians (L)', () => void openLab(app)),
      iconButton('image', 'Snakes: contours in an image', () => void openSnakes(app)),
      iconButton('theme', 'Light or dark', () => app.setTheme(app.theme === 'dark' ? 'light' : 'dark')),
      iconButton('tour', 'Guided tour, two minutes', () => toggleTour(app)),
      iconButton('help', 'Shortcuts (?)', () => toggleShortcuts(app))));
  app.onChange.push(() => {
    const { state } = app;
    same!.hidden = !app.documents.place;
    other!.hidden = app.documents.file?.kind !== 'rhino';
    undo.disabled = !state?.undo || app.playing();
    redo.disabled = !state?.redo || app.playing();
    const idle = !state || selected(state).length === 0;
    play.disabled = rest.disabled = idle;
    step.disabled = idle || app.playing();
    play.replaceChildren(icon(app.playing() ? 'pause' : 'play'));
    play.classList.toggle('on', app.playing());
    four.classList.toggle('on', app.display.fourViews);
    name.textContent = state ? app.documents.name : '';
    unit.textContent = unitInWords(unitOf(state, ''));
    document.title = state ? `${app.documents.name} – Knead studio` : 'Knead studio';
  });
  return bar;
}

/** Buttons that a narrow page shows below the bar, while the one before them is pressed. */
function foldable(...buttons: HTMLElement[]): HTMLElement[] {
  const unfold = (open: boolean) => {
    folded.classList.toggle('open', open);
    more.setAttribute('aria-expanded', String(open));
  };
  const more = iconButton('more', 'More: view, lab, theme, tour, shortcuts', () => unfold(!folded.classList.contains('open')));
  const folded = h('div', { class: 'folded' }, ...buttons);
  more.classList.add('unfold');
  unfold(false);
  folded.addEventListener('click', () => unfold(false));
  document.addEventListener('pointerdown', (e) => {
    if (!folded.contains(e.target as Node) && !more.contains(e.target as Node)) unfold(false);
  });
  const onEscape = (e: KeyboardEvent) => {
    if (e.key === 'Escape') unfold(false);
  };
  more.addEventListener('keydown', onEscape);
  folded.addEventListener('keydown', onEscape);
  return [more, folded];
}

function menu(iconName: string, label: string, text: string, entries: [string, string, () => void][]): HTMLElement {
  const list = h('div', { class: 'menu-list' }, ...entries.map(([name, about, act]) =>
    h('button', { type: 'button', class: 'menu-item', onclick: () => {
      element.open = false;
      act();
    } }, h('b', {}, name), h('small', {}, about))));
  const element = h('details', { class: 'menu' }, h('summary', { class: 'button labelled', title: label, aria: { label } }, icon(iconName), h('span', {}, text)), list);
  document.addEventListener('pointerdown', (e) => {
    if (!element.contains(e.target as Node)) element.open = false;
  });
  element.addEventListener('keydown', (e) => {
    if (e.key === 'Escape') element.open = false;
  });
  return element;
}

export function toolRail(app: App): HTMLElement {
  const buttons = modes.map(([mode, label]) => {
    const button = iconButton(mode, label, () => app.hand.choose(mode));
    button.classList.add('rail-button');
    return [mode, button] as const;
  });
  app.onChange.push(() => {
    for (const [mode, button] of buttons) {
      button.classList.toggle('on', app.hand.mode === mode);
      button.setAttribute('aria-pressed', String(app.hand.mode === mode));
    }
    app.viewer.element.dataset.mode = app.hand.mode;
  });
  return h('nav', { class: 'rail', aria: { label: 'What the pointer does' } }, ...buttons.map(([, b]) => b));
}

/** Messages at the lower edge: never over the clay, errors until they are dismissed. */
export function notices(app: App): HTMLElement {
  const stack = h('div', { class: 'notices', aria: { live: 'polite' } });
  app.settle = (topic) => [...stack.querySelectorAll<HTMLElement>('.notice')].find((other) => other.dataset.topic === topic)?.remove();
  app.notify = (notice: Notice) => {
    const close = () => element.remove();
    const element = h('div', { class: `notice ${notice.kind}` },
      h('div', {}, h('p', {}, notice.text), notice.remedy && h('p', { class: 'remedy' }, notice.remedy),
        ...(notice.actions ?? []).map((a) => h('button', { type: 'button', class: 'button small', onclick: () => {
          close();
          a.act();
        } }, a.label))),
      iconButton('close', 'Dismiss', close));
    element.dataset.topic = notice.topic ?? notice.text;
    if (!notice.ofPage) element.dataset.session = String(app.documents.sessions);
    app.settle(element.dataset.topic);
    stack.append(element);
    while (stack.children.length > 3) stack.firstElementChild!.remove();
    const stays = notice.kind === 'info' && (notice.actions ?? []).length > 0 && !notice.passing; // an offer
    element.classList.toggle('stays', stays);
    if (!stays) setTimeout(close, notice.kind === 'error' || notice.passing ? 15_000 : 4_000);
  };
  new ResizeObserver(() => app.viewer.redraw()).observe(stack); // what stands over the view makes room
  let session = 0;
  app.onChange.push(() => {
    if (session === app.documents.sessions) return;
    session = app.documents.sessions;
    for (const old of stack.querySelectorAll<HTMLElement>('.notice[data-session]')) {
      if (old.dataset.session !== String(session)) old.remove(); // about another document
    }
  });
  return stack;
}

export function toggleShortcuts(app: App): void {
  const present = document.querySelector('.shortcuts');
  if (present) {
    present.remove();
    return;
  }
  const close = () => element.remove();
  const element = h('section', { class: 'shortcuts', aria: { label: 'Shortcuts' } },
    h('header', {}, h('h2', {}, 'Shortcuts'), iconButton('close', 'Close', close)),
    h('dl', {}, ...shortcuts(app).flatMap(([keys, what]) => [h('dt', {}, keys), h('dd', {}, what)])));
  app.viewer.element.append(element);
}
