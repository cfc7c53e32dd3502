import * as THREE from 'three';

import { format, parseLength, unitInWords } from '../document/units';
import { type SectionAxis, sectionAxes } from '../view/section';
import type { App } from './app';
import { field, h, icon, slider, toggle } from './dom';
import { numberInput } from './number_input';
import { row } from './panel';

/** The section: a plane that hides what is before it. Its controls in the panel, and its handle in the view. */

let last: SectionAxis = 'x';

/** Begins one across an axis, or ends the one that is. */
export function toggleSection(app: App, axis?: SectionAxis): void {
  const { section } = app.viewer;
  if (section.on && (axis === undefined || axis === section.axis)) section.end();
  else app.viewer.beginSection((last = axis ?? last));
  app.changed();
}

function moveTo(app: App, offset: number): void {
  app.viewer.section.move(offset);
  app.changed();
}

/** From the file's origin for axes; for a direction of the view from the middle of the scene. */
function shift(app: App): number {
  const { section, origin } = app.viewer;
  return section.axis === null || section.axis === 'view' ? 0 : origin['xyz'.indexOf(section.axis)]!;
}

export function sectionState(app: App): unknown {
  const { axis, offset, flipped } = app.viewer.section;
  return [axis, offset, flipped];
}

export function sectionFields(app: App): HTMLElement[] {
  const { section } = app.viewer;
  const unit = app.viewer.unit;
  const chips = sectionAxes.map((axis) => toggle(axis === 'view' ? 'View' : axis.toUpperCase(), section.axis === axis, () => toggleSection(app, axis),
    axis === 'view' ? 'Across the direction that is looked in' : `Across the axis ${axis}`));
  const choose = field('Section', row(...chips), 'Hides what is before a plane (X); Esc ends it');
  if (!section.on) return [choose];
  const flip = toggle('Flip', section.flipped, () => {
    section.flip();
    app.changed();
  }, 'Hides the other side of the section');
  const number = numberInput('Position of the section in numbers', section.offset + shift(app), (x) => moveTo(app, x - shift(app)), (text) => parseLength(text, unit));
  return [choose, field('Position', row(slider('Position of the section', section.offset, section.range, (x) => moveTo(app, x)), number)), row(flip)];
}

/** At a corner of the plane: a drag moves it along its normal, and so do the arrow keys. */
export function sectionHandle(app: App): HTMLElement {
  const { viewer } = app;
  const { section } = viewer;
  const handle = h('button', { class: 'section-handle', type: 'button', hidden: true, role: 'slider', title: 'Drag: position of the section. Esc ends it',
    aria: { label: 'Drag the section', orientation: 'vertical' } }, icon('move'));
  let corner: THREE.Vector3 | null = null;

  viewer.onDrawn.push(() => {
    handle.hidden = !section.on;
    if (!section.on) return;
    const view = viewer.main.element.getBoundingClientRect(), stage = viewer.element.getBoundingClientRect();
    const places = section.corners().map((point) => ({ point, at: viewer.main.projectAll(point.toArray()) })).filter(({ at }) => !Number.isNaN(at[0]));
    places.sort((a, b) => a.at[1]! - b.at[1]!);
    corner = places[0]?.point ?? null;
    const [x, y] = places[0]?.at ?? [view.left, view.top];
    handle.style.left = `${THREE.MathUtils.clamp(x!, view.left + 20, view.right - 20) - stage.left}px`;
    handle.style.top = `${THREE.MathUtils.clamp(y!, view.top + 44, view.bottom - 20) - stage.top}px`;
    const numbers = { now: section.offset + shift(app), min: section.range[0] + shift(app), max: section.range[1] + shift(app) };
    for (const [name, value] of Object.entries(numbers)) handle.setAttribute(`aria-value${name}`, String(value));
    handle.setAttribute('aria-valuetext', `${format(numbers.now)} ${unitInWords(viewer.unit)}`);
  });

  /** The offset for a motion of the pointer. */
  const along = (dx: number, dy: number): number => {
    const step = viewer.main.pixel();
    const from = viewer.main.projectAll(corner!.toArray()), to = viewer.main.projectAll(corner!.clone().addScaledVector(section.normal, 20 * step).toArray());
    const [x, y] = [(to[0]! - from[0]!) / 20, (to[1]! - from[1]!) / 20]; // pixels of the page per pixel of length
    const square = x * x + y * y;
    // Looked at along its normal the plane moves nowhere on the page: up is towards the eye.
    return square > 0.02 ? (step * (dx * x + dy * y)) / square : -step * dy;
  };
  let held: { x: number; y: number } | null = null;
  handle.addEventListener('pointerdown', (e) => {
    held = { x: e.clientX, y: e.clientY };
    handle.setPointerCapture(e.pointerId);
  });
  handle.addEventListener('pointermove', (e) => {
    if (!held || !corner) return;
    moveTo(app, section.offset + along(e.clientX - held.x, e.clientY - held.y));
    held = { x: e.clientX, y: e.clientY };
  });
  for (const end of ['pointerup', 'pointercancel'] as const) handle.addEventListener(end, () => (held = null));
  handle.addEventListener('keydown', (e) => {
    const by = { ArrowUp: 0.01, ArrowRight: 0.01, ArrowDown: -0.01, ArrowLeft: -0.01, PageUp: 0.1, PageDown: -0.1 }[e.key];
    if (by === undefined) return;
    moveTo(app, section.offset + by * (section.range[1] - section.range[0]));
    e.preventDefault();
    e.stopPropagation();
  });
  return handle;
}
