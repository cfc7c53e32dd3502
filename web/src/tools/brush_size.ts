import * as THREE from 'three';

import { seenBox } from '../view/bounds';
import type { Viewer } from '../view/viewer';

/** What the radius of a brush keeps while views zoom and surfaces are selected: its length, its pixels, or its share of the faces. */
export type SizeUnit = 'length' | 'screen' | 'face';

/** The radius of all brushes in one of these units; the brush itself has it in the unit of the file. */
export class BrushSize {
  private chosen: SizeUnit = 'length';
  private last = 1;

  /** `quiet`: no stroke is under way. */
  constructor(private readonly viewer: Viewer, private readonly settings: { radius: number }, quiet: () => boolean, changed: () => void) {
    viewer.onDrawn.push(() => {
      if (this.chosen === 'length' || !quiet()) return;
      const now = this.length();
      if (now === this.last) return;
      this.settings.radius *= now / this.last;
      this.last = now;
      changed();
    });
  }

  get unit(): SizeUnit {
    return this.chosen;
  }

  set unit(unit: SizeUnit) {
    this.chosen = unit;
    this.last = this.length();
  }

  /** In the unit. */
  get value(): number {
    return this.settings.radius / this.length();
  }

  set value(value: number) {
    this.settings.radius = value * this.length();
  }

  /** Of the unit, file units: a pixel at the depth that the main view looks at, or a hundredth of the diagonal of what is seen of the selected surfaces. */
  private length(): number {
    const { viewer } = this;
    if (this.chosen === 'screen') return viewer.main.pixel() / viewer.workplace.scale;
    if (this.chosen === 'length') return 1;
    const chosen = viewer.frame?.state.selection ?? [];
    const box = new THREE.Box3();
    for (const k of chosen) box.union(seenBox(viewer.surfaces[k]?.picture ?? null, viewer.trimOf(k)) ?? new THREE.Box3());
    return box.isEmpty() ? this.last : box.getSize(new THREE.Vector3()).length() / 100;
  }
}
