import * as THREE from 'three';

import type { SavedView } from '../document/saved_views';
import { type NamedView, sideFrom } from '../view/directions';
import type { App } from './app';

/** Views by name, kept views, projections: what the panel, the cube and the keys do alike. */

/** The free view, shown alone unless there are four. */
function free(app: App) {
  if (app.viewer.main.axial) app.setDisplay({ view: 'perspective' });
  return app.viewer.viewports[0]!;
}

/** Turns the view that is shown. One along an axis has six sides; anything else is for the free one. */
export function look(app: App, to: NamedView | THREE.Vector3): void {
  const { main } = app.viewer;
  app.viewer.turntable.on = false;
  const along = typeof to === 'string' ? to !== 'perspective' && to !== 'isometric' : sideFrom(to) !== null;
  (main.axial && along ? main : free(app)).turn(to);
}

export function toggleParallel(app: App): void {
  free(app);
  app.setDisplay({ parallel: !app.display.parallel });
}

export function toggleTurntable(app: App): void {
  const { turntable } = app.viewer;
  if (!turntable.on) free(app);
  turntable.on = !turntable.on;
}

/** Keeps what is shown now, in the place of a view of the same name. */
export function keepView(app: App, name: string): void {
  const { origin, main } = app.viewer;
  const placed = main.placement();
  const inFile = (p: THREE.Vector3Tuple) => p.map((x, d) => x + origin[d]!) as THREE.Vector3Tuple;
  app.documents.keepView(name, { name, ...placed, position: inFile(placed.position), target: inFile(placed.target) });
}

export function recall(app: App, view: SavedView): void {
  const { origin, turntable } = app.viewer;
  turntable.on = false;
  const inScene = (p: THREE.Vector3Tuple) => p.map((x, d) => x - origin[d]!) as THREE.Vector3Tuple;
  free(app).restore({ ...view, position: inScene(view.position), target: inScene(view.target) });
  app.setDisplay({ parallel: view.parallel });
}
