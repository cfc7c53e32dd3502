import { type NamedView, namedViews } from '../view/directions';
import type { App } from './app';
import { field, h, iconButton, title, toggle } from './dom';
import { note, panel, row } from './panel';
import { sectionFields, sectionState } from './section';
import { keepView, look, recall, toggleParallel, toggleTurntable } from './views';

const keys: Record<NamedView, string> = {
  front: '1', back: 'Shift+1', right: '2', left: 'Shift+2', top: '3', bottom: 'Shift+3', isometric: '6', perspective: '0',
};

/** Views by name, the projection, the turntable, and what the user keeps. */
export function viewsPanel(app: App): HTMLElement {
  app.viewer.turntable.onChange = () => app.changed();
  let name = '';
  return panel(app, 'Views', (a) => [a.display.parallel, a.viewer.turntable.on, a.documents.views, sectionState(a)], () => {
    const input = h('input', { class: 'number', type: 'text', value: name, placeholder: nextName(app), spellcheck: false, aria: { label: 'Name of the view to keep' } });
    const keep = () => {
      const chosen = name.trim() || nextName(app);
      name = '';
      keepView(app, chosen);
    };
    input.addEventListener('input', () => (name = input.value));
    input.addEventListener('keydown', (e) => {
      e.stopPropagation();
      if (e.key === 'Enter') {
        input.blur();
        keep();
      }
    });
    return [
      row(...namedViews.map((view) =>
        h('button', { class: 'chip', type: 'button', title: `${title(view)} view (${keys[view]})`, onclick: () => look(app, view) }, title(view)))),
      row(toggle('Parallel', app.display.parallel, () => toggleParallel(app), 'Parallel projection: what is far away looks no smaller (7)'),
        toggle('Turntable', app.viewer.turntable.on, () => toggleTurntable(app), 'Turns slowly, until a view is touched (8)')),
      ...sectionFields(app),
      field('Keep', row(input, h('button', { class: 'button small', type: 'button', title: 'Keep this view with the document', onclick: keep }, 'Keep view'))),
      app.documents.views.length === 0 ? note('Views that you keep are saved with the Knead document.')
        : h('ul', { class: 'list' }, ...app.documents.views.map((view) => h('li', { class: 'with-action' },
          h('button', { class: 'item', type: 'button', title: 'Show this view', onclick: () => recall(app, view) },
            h('span', {}, view.name), h('small', {}, view.parallel ? 'parallel' : 'perspective')),
          iconButton('trash', `Forget the view ${view.name}`, () => app.documents.keepView(view.name, null))))),
    ];
  }, false);
}

function nextName(app: App): string {
  const taken = new Set(app.documents.views.map((v) => v.name));
  let k = taken.size + 1;
  while (taken.has(`View ${k}`)) ++k;
  return `View ${k}`;
}
