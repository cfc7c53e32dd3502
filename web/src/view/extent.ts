import * as THREE from 'three';

import type { Trim } from '../engine/context';
import type { Picture } from '../engine/session_types';
import { type Bounds, boundsOf, seenBox } from './bounds';
import { placedBox, type Standing } from './placing';

type Boxes = (THREE.Box3 | null)[];

/** What a scene is made of, as far as its size goes. */
export interface Sized {
  readonly surfaces: readonly { readonly picture: Picture | null }[];
  readonly bodies: { boxes(): Boxes };
  readonly context: { box(): THREE.Box3 | null };
  standings(surface: number): readonly Standing[];
  working(surface: number): Standing;
  trimOf(surface: number): Trim;
}

/** How large what is drawn is, in the scene, with all places of all parts. */
export class Extent {
  constructor(private readonly scene: Sized) {}

  private placed(box: THREE.Box3 | null, surface: number): Boxes {
    return box ? this.scene.standings(surface).map((s) => placedBox(box, s)) : [];
  }

  /** Centre and radius of all surfaces, without their trims. */
  bounds(): Bounds {
    return boundsOf(this.surfaces());
  }

  /** Round all surfaces and bodies, without their trims. */
  surfaces(): Boxes {
    const { surfaces, bodies } = this.scene;
    return [...surfaces.flatMap(({ picture }, k) => this.placed(picture && new THREE.Box3().setFromArray(picture.positions), k)), ...bodies.boxes()];
  }

  /** Nothing grey reaches beyond the surfaces. */
  get whole(): boolean {
    const grey = this.scene.context.box(), own = this.surfaces().filter((box) => box !== null);
    return !grey || (own.length > 0 && boundsOf([...own, grey]).radius <= boundsOf(own).radius * (1 + 1e-6));
  }

  /** Round what is seen of a surface where it is worked on. */
  seen(surface: number): THREE.Box3 | null {
    const { scene } = this;
    return placedBox(seenBox(scene.surfaces[surface]?.picture ?? null, scene.trimOf(surface)), scene.working(surface));
  }

  /** Round what is seen of every surface, and all grey faces. */
  all(): Boxes {
    const { scene } = this;
    return [...scene.surfaces.flatMap((s, k) => this.placed(seenBox(s.picture, scene.trimOf(k)), k)), ...scene.bodies.boxes(), scene.context.box()];
  }
}
