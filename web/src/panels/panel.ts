import type { App } from './app';
import { h } from './dom';

/**
 * A section of the side bar. `draw` recreates its content when what it depends on, `key`, has changed, but not while a
 * control in it has the focus. Hidden while it has nothing to show (`shown`).
 */
export function panel(app: App, title: string, key: (app: App) => unknown, draw: (app: App) => (Node | null)[], open = true,
                      shown: (app: App) => boolean = () => true): HTMLElement {
  const body = h('div', { class: 'panel-body' });
  const element = h('details', { class: 'panel', open, data: { panel: title } }, h('summary', {}, title), body);
  let drawn = '';
  const update = () => {
    element.hidden = !shown(app);
    if (element.hidden || !element.open) return;
    const now = JSON.stringify(key(app)) ?? '';
    if (now === drawn) return;
    const focus = document.activeElement;
    if (body.contains(focus) && (focus instanceof HTMLInputElement || focus instanceof HTMLSelectElement) &&
        (app.playing() || focus.type === 'range' || focus.ariaInvalid === 'true')) return;
    drawn = now;
    const name = body.contains(focus) ? focus?.getAttribute('aria-label') : null;
    body.replaceChildren(...draw(app).filter((n): n is Node => n !== null));
    // Restore the focus.
    if (name) body.querySelector<HTMLElement>(`[aria-label="${CSS.escape(name)}"]`)?.focus({ preventScroll: true });
  };
  app.onChange.push(update);
  element.addEventListener('toggle', update);
  update();
  return element;
}

export const row = (...children: (Node | null)[]): HTMLElement => h('div', { class: 'row' }, ...children);
export const note = (text: string): HTMLElement => h('p', { class: 'note' }, text);
