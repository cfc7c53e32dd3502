import * as THREE from 'three';

import type { Command, Vector3 } from '../engine/session_types';
import { pickBody } from '../view/body_picking';
import type { BodyHit } from '../view/near';
import type { Viewer } from '../view/viewer';
import type { Viewport } from '../view/viewport';
import type { PointerTool } from './pointers';

export interface BodyActions {
  begin(commands: Command[]): Promise<boolean>;
  follow(commands: () => Command[], join: boolean): void;
  end(commands: Command[]): Promise<void>;
  cancel(): Promise<void>;
}

const spring = 'hand';
const strength = 1000;
const sides = ['u0', 'u1', 'v0', 'v1', 'w0', 'w1'] as const;
type Side = (typeof sides)[number];

interface Pull {
  viewport: Viewport;
  hit: BodyHit;
  begun: Promise<boolean>;
  cancelled: boolean;
}

/** What the pointer does with curves and volumes: hover, select, draw by a spring, hold ends and sides. */
export class BodyHand implements PointerTool {
  private pull: Pull | null = null;
  /** The one under the pointer. */
  under: BodyHit | null = null;

  constructor(private readonly viewer: Viewer, private readonly actions: BodyActions, private readonly select: (body: number) => Promise<void>) {}

  get active(): boolean {
    return this.pull !== null;
  }

  get selected(): number | null {
    return this.viewer.frame?.state.body ?? null;
  }

  /** Lights what is under the pointer, before the tools see it. */
  listen(viewport: Viewport): void {
    const look = (e: PointerEvent | null) => {
      if (this.pull || this.viewer.bodies.bodies.length === 0) return;
      this.under = e && e.target === viewport.element ? pickBody(this.viewer, viewport, e, e.pointerType === 'touch' ? 18 : 9) : null;
      const { bodies } = this.viewer, hovered = this.under?.body ?? null;
      if (bodies.hovered === hovered) return;
      bodies.hovered = hovered;
      bodies.restyle(this.viewer.display, this.viewer.palette);
      viewport.element.style.cursor = hovered === null ? '' : 'pointer';
      this.viewer.redraw();
    };
    viewport.element.addEventListener('pointermove', (e) => {
      if (e.buttons === 0) look(e);
    }, { capture: true });
    viewport.element.addEventListener('pointerdown', look, { capture: true });
    viewport.element.addEventListener('pointerleave', () => look(null));
  }

  /** The nearest one is selected; true if there is one. */
  click(viewport: Viewport, event: PointerEvent): boolean {
    const hit = pickBody(this.viewer, viewport, event);
    if (!hit) return false;
    this.viewer.workAt(hit.standing);
    if (hit.body !== this.selected) void this.select(hit.body);
    return true;
  }

  // --- a spring ----------------------------------------------------------------------------------------------------

  press(viewport: Viewport, event: PointerEvent): boolean {
    const { mode } = this.viewer.element.dataset;
    const hit = mode === 'look' ? null : pickBody(this.viewer, viewport, event, event.pointerType === 'touch' ? 18 : 9);
    if (!hit) return false; // looking, the view turns; a click selects
    this.viewer.workAt(hit.standing);
    if (hit.body !== this.selected) {
      void this.select(hit.body);
      return true;
    }
    if (mode === 'edges') {
      this.hold(hit);
      return true;
    }
    const pull: Pull = { viewport, hit, begun: Promise.resolve(true), cancelled: false };
    pull.begun = this.actions.begin(this.drawn(pull, hit.point));
    this.pull = pull;
    return true;
  }

  drag(event: PointerEvent): void {
    const { pull } = this;
    if (!pull) return;
    const to = pull.viewport.unproject(event.clientX, event.clientY, pull.hit.point);
    void pull.begun.then((good) => {
      if (good && !pull.cancelled) this.actions.follow(() => this.drawn(pull, to), true);
    });
  }

  release(): void {
    const { pull } = this;
    this.pull = null;
    // What the hand has made stays, as on surfaces.
    void pull?.begun.then((good) => (good && !pull.cancelled ? this.actions.end([{ do: 'rest' }, { do: 'remove', tool: spring }]) : undefined));
  }

  async cancel(): Promise<void> {
    const { pull } = this;
    this.pull = null;
    if (!pull) return;
    pull.cancelled = true;
    if (await pull.begun) await this.actions.cancel();
  }

  private drawn({ hit }: Pull, to: THREE.Vector3): Command[] {
    const { origin, frame } = this.viewer;
    const at = frame!.state.bodies[hit.body]!.kind === 'curve' ? hit.at.slice(0, 1) : hit.at;
    const place = to.toArray().map((x, d) => x + origin[d]!) as Vector3;
    return [{ do: 'force', name: spring, kind: 'spring', at, to: place, strength }, { do: 'step', count: 2 }];
  }

  // --- ends and sides ----------------------------------------------------------------------------------------------

  /** The end of a curve, or the side of a volume, that is nearest to the pointer: held if it is free, free if it is held. */
  private hold({ body, at }: BodyHit): void {
    const info = this.viewer.frame!.state.bodies[body]!;
    const distances = sides.slice(0, info.kind === 'curve' ? 2 : 6).map((_, k) => (k % 2 === 0 ? at[Math.floor(k / 2)]! : 1 - at[Math.floor(k / 2)]!));
    const which: Side = sides[distances.indexOf(Math.min(...distances))]!;
    const held = (info.sides as readonly string[]).includes(which);
    void this.actions.begin([{ do: 'edge', which, hold: held ? 'open' : 'position' }]).then((good) => (good ? this.actions.end([]) : undefined));
  }
}
