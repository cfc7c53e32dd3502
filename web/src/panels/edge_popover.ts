import type { Command } from '../engine/session_types';
import { type Continuity, continuityOf, continuityTitles, type Edge, edgeTitle, isSide } from '../tools/held';
import { released } from '../tools/paint';
import type { App } from './app';
import { h, iconButton, toggle } from './dom';

const choices: readonly (readonly [Continuity, string])[] = [
  ['open', 'It may move, and other faces that meet here stay'],
  ['follow', 'It moves with the faces that meet here, and these stay together'],
  ['position', 'It stays where it is'],
  ['tangent', 'It stays, with its tangent planes'],
  ['curvature', 'It stays, with its tangent planes and curvatures'],
  ['symmetry', 'It stays in its plane, and the surface meets that at right angles: half of a symmetric model'],
];

/** A menu beside a clicked edge of the surface: what to hold there. */
export function listenToEdges(app: App): void {
  let open: HTMLElement | null = null;
  const close = () => {
    open?.remove();
    open = null;
  };
  document.addEventListener('pointerdown', (e) => {
    if (open && !open.contains(e.target as Node)) close();
  }, { capture: true });
  document.addEventListener('keydown', (e) => {
    if (e.key === 'Escape') close();
  });
  app.hand.edges.onEdge = (surface, edge, at) => {
    close();
    const info = app.state!.surfaces[surface]!;
    const now = continuityOf(info, edge);
    const meeting = app.hand.edges.meeting(edge);
    const possible = choices.filter(([continuity]) => continuity !== (isSide(edge) ? 'follow' : 'symmetry') && (continuity !== 'follow' || meeting?.follows));
    const rows = possible.map(([continuity, about]) => toggle(continuityTitles[continuity], continuity === now, () => {
      close();
      void app.execute(asking(app, surface, edge, continuity));
    }, about));
    open = h('section', { class: 'popover', aria: { label: edgeTitle(edge) } },
      h('header', {}, h('b', {}, edgeTitle(edge)), iconButton('close', 'Close', close)),
      h('div', { class: 'row' }, ...rows),
      meeting ? h('p', { class: 'note' }, meeting.text) : null,
      info.hold > 0 ? h('p', { class: 'note' }, `The outer ${info.hold} rows of control points are held as well (Constraints, Held rows).`) : null);
    app.viewer.element.append(open);
    const stage = app.viewer.element.getBoundingClientRect();
    const box = open.getBoundingClientRect();
    open.style.left = `${Math.max(6, Math.min(at.x - stage.left + 10, stage.width - box.width - 6))}px`;
    open.style.top = `${Math.max(6, Math.min(at.y - stage.top + 10, stage.height - box.height - 6))}px`;
    open.querySelector('button.chip')?.dispatchEvent(new Event('focus'));
  };
}

function asking(app: App, surface: number, edge: Edge, continuity: Continuity): Command[] {
  const info = app.state!.surfaces[surface]!;
  if (!isSide(edge)) return [{ do: 'edge', edge, hold: continuity === 'symmetry' ? 'position' : continuity }];
  const wish: Command[] = continuity === 'symmetry' ? [{ do: 'symmetry', edge, ...app.hand.edges.plane(edge) }]
    : [{ do: 'edge', which: edge, hold: continuity }];
  const symmetric = info.constraints.some((c) => c.do === 'symmetry' && c.edge === edge);
  // Symmetries are freed together: those of other edges are requested again.
  return symmetric ? [...released('symmetry', info.constraints.filter((c) => c.do === 'symmetry' && c.edge !== edge)), ...wish] : wish;
}
