import type { Question } from '../document/host';
import type { App } from './app';
import { h } from './dom';

/** Questions that stand before everything else until they are answered; Esc is “Cancel”. */
export function listenToQuestions(app: App): void {
  let open = false;
  app.ask = (question: Question) => new Promise((resolve) => {
    if (open) {
      resolve(null); // one at a time
      return;
    }
    open = true;
    const choose = (id: string) => () => dialog.close(id);
    const dialog = h('dialog', { class: 'question', aria: { label: question.title } },
      h('h2', {}, question.title),
      h('p', {}, question.text),
      h('div', { class: 'choices' },
        ...question.choices.map(({ id, label, about }, k) =>
          h('button', { type: 'button', class: k === 0 ? 'choice first' : 'choice', onclick: choose(id) }, h('b', {}, label), about && h('small', {}, about))),
        h('button', { type: 'button', class: 'choice', onclick: choose('') }, h('b', {}, 'Cancel'))));
    dialog.addEventListener('keydown', (event) => event.stopPropagation()); // no shortcuts meanwhile
    dialog.addEventListener('close', () => {
      open = false;
      dialog.remove();
      resolve(dialog.returnValue || null);
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}
