import { autosave, type Kept } from '../document/autosave';
import type { App } from './app';
import { h, icon, iconButton } from './dom';

/** When a session was kept, as the reader writes dates. */
export const when = (kept: Kept) => new Date(kept.when).toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' });
export const extent = (kept: Kept) => `${kept.commands} ${kept.commands === 1 ? 'command' : 'commands'}`;

/** Sessions that the browser keeps, the newest first: each goes on where it was left, with its history. */
export function recentMenu(app: App): HTMLElement {
  const list = h('div', { class: 'menu-list' });
  const element = h('details', { class: 'menu' },
    h('summary', { class: 'button labelled', title: 'Recent sessions', aria: { label: 'Recent sessions' } }, icon('recent'), h('span', {}, 'Recent')), list);
  const fill = async () => {
    const left = await app.documents.keeper.left().catch(() => []);
    const rows = left.map((kept) => h('div', { class: 'with-action' },
      h('button', { type: 'button', class: 'menu-item', onclick: () => {
        element.open = false;
        void app.documents.recover(kept);
      } }, h('b', {}, kept.name), h('small', {}, `${extent(kept)}, ${when(kept)}`)),
      iconButton('trash', `Forget ${kept.name} of ${when(kept)}`, () => void autosave.forget(kept.id).then(fill))));
    list.replaceChildren(...(rows.length > 0 ? rows : [h('p', { class: 'note' }, 'No other sessions yet: what you leave stays here.')]));
  };
  element.addEventListener('toggle', () => {
    if (element.open) void fill();
  });
  document.addEventListener('pointerdown', (e) => {
    if (!element.contains(e.target as Node)) element.open = false;
  });
  element.addEventListener('keydown', (e) => {
    if (e.key === 'Escape') element.open = false;
  });
  return element;
}
