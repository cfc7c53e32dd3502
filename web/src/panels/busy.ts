import type { App } from './app';
import { h } from './dom';

const patience = 900; // milliseconds after which what the engine does is said, and can be stopped
const often = 150;

/** Says what takes long, how far it is, and stops it. */
export function busyBar(app: App): HTMLElement {
  const { client } = app;
  const text = h('span', {}, '');
  const bar = h('progress', { max: 1, aria: { label: 'How far it is' } });
  const stop = h('button', { class: 'button small', type: 'button', title: 'Ends it; the document is as it was before', onclick: () => client.stopAll() }, 'Stop');
  const element = h('div', { class: 'busy', hidden: true }, text, bar, stop);
  element.setAttribute('role', 'status');
  let reported: { done: number; total: number; since: number } | null = null;
  client.onProgress = (done, total) => (reported = { done, total, since: client.busySince ?? 0 });
  const update = () => {
    const since = client.busySince;
    const long = since !== null && performance.now() - since > patience;
    element.hidden = !long;
    if (!long) return;
    const at = reported?.since === since ? reported : null; // not of a request before
    const phase = at && client.phases[Math.floor((at.done * client.phases.length) / at.total)];
    text.textContent = phase ? `${phase} …` : at ? `Step ${at.done.toLocaleString('en')} of ${at.total.toLocaleString('en')}` : 'Working …';
    if (at && at.total > 0) bar.value = at.done / at.total;
    else bar.removeAttribute('value');
  };
  setInterval(update, often);
  return element;
}
