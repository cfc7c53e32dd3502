import * as THREE from 'three';

import type { Command, Vector3 } from '../engine/session_types';
import type { GridPicker } from '../view/picking';
import type { Hit, Viewer } from '../view/viewer';
import type { Viewport } from '../view/viewport';
import { brushModes, type Mode } from './modes';
import { pressureOf } from './pen';
import type { PointerTool } from './pointers';
import { Ring } from './ring';

export interface BrushSettings {
  /** Radius of the ball, file units. */
  radius: number;
  /** How deep it goes, in radii; how much of a bump smoothing removes. */
  strength: number;
  /** The pressure of a pen scales the strength down. */
  pressure: boolean;
}

/** The pointer's requests to the session. */
export interface BrushActions {
  /** A new act of these commands, after the one before has ended; resolves once they are done, false if they failed. */
  begin(commands: Command[]): Promise<boolean>;
  /** Continues the act; requests that come too fast are dropped. */
  follow(commands: () => Command[], join: boolean): void;
  /** Ends the act. */
  end(commands: Command[]): Promise<void>;
  /** Reverts the act. */
  cancel(): Promise<void>;
  place(point: THREE.Vector3, normal: THREE.Vector3): void;
  select(surface: number): Promise<void>;
  pickTool(name: string | null): void;
  settingsChanged(): void;
}

export const brushName = 'brush';

type Place = Pick<Hit, 'point' | 'normal' | 'fractions' | 'surface'> & { press: number };

interface Stroke {
  viewport: Viewport;
  kind: 'ball' | 'grab' | 'smooth';
  inward: boolean;
  frozen: (GridPicker | null)[];
  begun: Promise<boolean>;
  start: THREE.Vector3;
  /** Centres of the ball not yet sent to the session, and its radius. */
  ahead: Vector3[];
  radius: number;
  at: Pick<Hit, 'fractions' | 'surface'>;
  cancelled: boolean;
}

/** Strokes: a ball pressed along the surface, smoothing, a point dragged; also places tools and selects by a click. */
export class BrushTool implements PointerTool {
  mode: Mode = 'push';
  settings: BrushSettings = { radius: 1, strength: 0.5, pressure: true };

  private stroke: Stroke | null = null;
  /** Hold-drag: how far the pointer is from its start, and the initial values. */
  private sizing: { x: number; y: number; radius: number; strength: number; hit: Hit | null } | null = null;
  private readonly ring: Ring;

  constructor(private readonly viewer: Viewer, private readonly actions: BrushActions) {
    this.ring = new Ring(viewer);
  }

  get active(): boolean {
    return this.stroke !== null || this.sizing !== null;
  }

  wheel(event: WheelEvent): boolean {
    const brush = brushModes.includes(this.mode);
    if (!this.stroke && !(brush && (event.shiftKey || event.altKey))) return false;
    const delta = event.deltaY !== 0 ? event.deltaY : event.deltaX;
    const factor = Math.exp(-Math.sign(delta) * 0.12);
    if (event.altKey) this.settings.strength = Math.min(1, Math.max(0.02, this.settings.strength * factor));
    else this.settings.radius *= factor;
    this.actions.settingsChanged();
    return true;
  }

  press(viewport: Viewport, event: PointerEvent): boolean {
    if (this.mode === 'look' || (!brushModes.includes(this.mode) && this.mode !== 'place')) return false;
    const hit = this.viewer.pick(viewport, event);
    if (event.ctrlKey && this.mode !== 'place') {
      this.sizing = { x: event.clientX, y: event.clientY, ...this.settings, hit };
      return true;
    }
    if (!hit) return false;
    if (this.mode === 'place') {
      const place = () => this.actions.place(hit.point, hit.normal);
      // A tool acts in the coordinates of the selected part.
      if (hit.standing.part === this.viewer.workplace.part) place();
      else void this.actions.select(hit.surface).then(place);
      return true;
    }
    // The first press on a surface selects it and moves nothing.
    if (!this.viewer.isSelected(hit.surface)) {
      void this.actions.select(hit.surface);
      return true;
    }
    // The pointer moves along the shape at the time of the press, so that a stroke keeps its depth.
    const frozen = this.viewer.pickers;
    const kind = this.mode === 'grab' ? 'grab' : this.mode === 'smooth' || event.shiftKey ? 'smooth' : 'ball';
    const inward = (this.mode === 'push') !== event.altKey;
    const last = { ...hit, press: this.pressure(event) };
    const stroke: Stroke = {
      viewport, kind, inward, frozen, begun: Promise.resolve(true), start: hit.point.clone(),
      ahead: [], radius: this.settings.radius, at: hit, cancelled: false,
    };
    this.stroke = stroke;
    stroke.begun = this.actions.begin(
      kind === 'ball' ? this.ball(this.centre(last, inward))
      : kind === 'smooth' ? this.smooth(last)
      : [this.grab(stroke, new THREE.Vector3())]);
    return true;
  }

  private pressure(event: PointerEvent): number {
    return (this.settings.pressure ? pressureOf(event) : null) ?? 1;
  }

  drag(event: PointerEvent): void {
    const { stroke, sizing } = this;
    if (sizing) {
      this.resize(sizing, event);
      return;
    }
    if (!stroke) return;
    if (stroke.kind === 'grab') {
      const by = stroke.viewport.unproject(event.clientX, event.clientY, stroke.start).sub(stroke.start);
      void this.followOn(stroke, () => [{ do: 'undo' }, this.grab(stroke, by)], false);
      return;
    }
    const hit = this.viewer.pick(stroke.viewport, event, stroke.frozen);
    if (!hit || !this.viewer.isSelected(hit.surface)) return;
    this.showRing(hit);
    const place = { ...hit, press: this.pressure(event) };
    if (stroke.kind === 'ball') {
      stroke.ahead.push(this.centre(place, stroke.inward));
      void this.followOn(stroke, () => this.led(stroke), true);
    }
    else void this.followOn(stroke, () => this.smooth(place), true);
  }

  /** Rightwards larger, upwards deeper. */
  private resize(from: NonNullable<BrushTool['sizing']>, event: PointerEvent): void {
    this.settings.radius = from.radius * Math.exp((event.clientX - from.x) / 120);
    this.settings.strength = Math.min(1, Math.max(0.02, from.strength - (event.clientY - from.y) / 300));
    if (from.hit) this.showRing(from.hit);
    this.actions.settingsChanged();
  }

  /** Also after the release of a stroke whose first command is still under way: `release` waits behind it. */
  private async followOn(stroke: Stroke, commands: () => Command[], join: boolean): Promise<void> {
    if ((await stroke.begun) && !stroke.cancelled) this.actions.follow(commands, join);
  }

  release(): void {
    this.sizing = null;
    const { stroke } = this;
    if (!stroke) return;
    this.stroke = null;
    void (async () => {
      if ((await stroke.begun) && !stroke.cancelled) {
        await this.actions.end(stroke.kind === 'ball' ? this.lifted(stroke) : []);
      }
    })();
  }

  /** A press and release in one place, not a stroke: selects what is there. */
  click(viewport: Viewport, event: PointerEvent): boolean {
    const tool = this.viewer.pickTool(viewport, event);
    this.actions.pickTool(tool);
    if (tool) return true;
    const hit = this.viewer.pick(viewport, event);
    if (hit && !this.viewer.isSelected(hit.surface)) void this.actions.select(hit.surface);
    return hit !== null;
  }

  /** Esc: as if the stroke had never been. */
  async cancel(): Promise<void> {
    const { stroke, sizing } = this;
    if (sizing) {
      this.settings.radius = sizing.radius;
      this.settings.strength = sizing.strength;
      this.sizing = null;
      this.actions.settingsChanged();
    }
    if (!stroke) return;
    stroke.cancelled = true;
    this.stroke = null;
    if (await stroke.begun) await this.actions.cancel();
  }

  /** Of the ball that is pressed in at a place. */
  private centre({ point, normal, press }: Place, inward: boolean): Vector3 {
    const { radius, strength } = this.settings;
    const away = (1 - strength * press) * radius;
    const centre = point.clone().addScaledVector(normal, inward ? away : -away);
    const [x, y, z] = this.viewer.origin;
    return [centre.x + x, centre.y + y, centre.z + z];
  }

  /** Puts a ball down, which stays down. */
  private ball(position: Vector3): Command[] {
    return [
      { do: 'tool', name: brushName, shape: 'sphere', radius: this.settings.radius, position, mode: 'collision', plasticity: 1, touches: 'visible' },
      { do: 'stroke', tool: brushName, path: [position], open: true },
    ];
  }

  private smooth(at: Place): Command[] {
    return [{ do: 'relax', ...this.on(at), radius: this.settings.radius, strength: this.settings.strength * at.press }];
  }

  /** Continues along all pointer positions since the last call: the session uses its own spacing. */
  private led(stroke: Stroke): Command[] {
    const path = stroke.ahead.splice(0);
    if (path.length === 0) return [];
    if (stroke.radius !== this.settings.radius) {
      stroke.radius = this.settings.radius;
      return [...this.ball(path[0]!), { do: 'stroke', tool: brushName, path, open: true }];
    }
    return [{ do: 'stroke', tool: brushName, path, open: true }];
  }

  private lifted(stroke: Stroke): Command[] {
    return [...this.led(stroke), { do: 'stroke', tool: brushName, path: [] }, { do: 'remove', tool: brushName }];
  }

  private grab(stroke: Stroke, by: THREE.Vector3): Command {
    return { do: 'drag', ...this.on(stroke.at), by: by.toArray(), radius: this.settings.radius, steps: 1 };
  }

  /** A point of a surface, which is named where several are selected. */
  private on({ fractions, surface }: Pick<Hit, 'fractions' | 'surface'>): { at: [number, number]; surface?: string } {
    const { selection, surfaces } = this.viewer.frame!.state;
    return selection.length > 1 ? { at: fractions, surface: surfaces[surface]!.id } : { at: fractions };
  }

  hover(viewport: Viewport | null, event?: PointerEvent): void {
    const hit = brushModes.includes(this.mode) && viewport && event ? this.viewer.pick(viewport, event) : null;
    if (hit) this.showRing(hit);
    else this.ring.hide();
  }

  private showRing(hit: Hit): void {
    const { radius, strength } = this.settings;
    // Where a ball at that depth cuts the plane.
    const ball = this.mode === 'push' || this.mode === 'pull';
    this.ring.show(hit, ball ? radius * Math.sqrt(Math.max(0.05, 1 - (1 - strength) ** 2)) : radius);
  }
}
