import * as THREE from 'three';

import { heldTogether } from '../tools/held';
import type { App } from './app';
import { h } from './dom';

/** Beside the selected face: what of all selected ones is held. A click shows its edges, to hold others. */
export function heldBadge(app: App): HTMLElement {
  const badge = h('button', { class: 'held-badge', type: 'button', hidden: true, title: 'Click to choose what the edges hold (D)', onclick: () => app.hand.choose('edges') });
  const { viewer } = app;
  let box: THREE.Box3 | null = null;

  /** Where messages begin that lie below a place x of the page. */
  const roof = (x: number): number => {
    const tops = [...document.querySelectorAll('.notices > *')].map((notice) => notice.getBoundingClientRect())
      .filter((r) => x + badge.offsetWidth / 2 > r.left && x - badge.offsetWidth / 2 < r.right).map((r) => r.top - 8);
    return Math.min(...tops, Infinity);
  };
  const place = () => {
    if (badge.hidden || !box) return;
    const { min, max } = box;
    const corners = [min, max].flatMap(({ x }) => [min, max].flatMap(({ y }) => [min, max].flatMap(({ z }) => [x, y, z])));
    const places = viewer.main.projectAll(corners);
    const xs = places.filter((_, k) => k % 2 === 0), ys = places.filter((_, k) => k % 2 === 1);
    if (xs.some(Number.isNaN)) return;
    const stage = viewer.element.getBoundingClientRect(), view = viewer.main.element.getBoundingClientRect();
    const within = (x: number, least: number, most: number) => Math.max(least, Math.min(x, most));
    const x = within((Math.min(...xs) + Math.max(...xs)) / 2, view.left + badge.offsetWidth / 2 + 8, view.right - badge.offsetWidth / 2 - 8);
    const lowest = Math.min(view.bottom - 26, roof(x)) - badge.offsetHeight;
    const y = within(Math.max(...ys) + 8, view.top + 34, lowest);
    badge.style.left = `${Math.round(x - stage.left)}px`;
    badge.style.top = `${Math.round(y - stage.top)}px`;
  };
  app.onChange.push(() => {
    const { state } = app;
    const k = state?.selection[0];
    const info = k === undefined ? undefined : state!.surfaces[k];
    const held = app.hand.edges.held;
    badge.hidden = !info || viewer.waiting || held === null || app.hand.active;
    if (badge.hidden || !info) return;
    badge.textContent = heldTogether(held!);
    badge.classList.toggle('loose', badge.textContent.startsWith('Nothing held') || badge.textContent.endsWith('when it moves'));
    box = viewer.extent.seen(k!);
    place();
  });
  viewer.onDrawn.push(place);
  return badge;
}
