import * as THREE from 'three';

import { clay } from '../engine/clay';
import type { Command } from '../engine/session_types';
import type { Viewport } from '../view/viewport';
import { BodyHand } from './body_hand';
import { BrushSize } from './brush_size';
import { BrushTool, type BrushActions } from './brush';
import { Edges } from './edges';
import { followGizmo } from './gizmo';
import { aForm } from './held';
import type { Placing, ToolHost } from './host';
import { Measure } from './measure';
import { type Mode, paintModes } from './modes';
import { newTool } from './new_tool';
import { Paint, type PaintKind } from './paint';
import { PointEditor } from './point_edit';
import { Pointers, type PointerTool } from './pointers';
import { SurfaceBrush } from './surface_brush';

/** Everything that the pointer can do, and which of these a press now means. */
export class Hand {
  readonly size: BrushSize;
  readonly brush: BrushTool;
  readonly surfaceBrush: SurfaceBrush;
  readonly bodies: BodyHand;
  readonly points: PointEditor;
  readonly paint: Paint;
  readonly edges: Edges;
  readonly measure: Measure;
  readonly pointers: Pointers;
  readonly placing: Placing = { shape: 'sphere' };
  /** Resolves when the acts that have begun so far have ended. */
  idle: Promise<void> = Promise.resolve();

  constructor(private readonly host: ToolHost) {
    const { viewer } = host;
    const actions = this.actions();
    this.brush = new BrushTool(viewer, actions);
    const { settings } = this.brush;
    this.size = new BrushSize(viewer, settings, () => !this.active, () => host.changed());
    this.surfaceBrush = new SurfaceBrush(viewer, actions, () => settings.radius, (factor) => (settings.radius *= factor));
    this.bodies = new BodyHand(viewer, actions, (body) => this.selectBody(body));
    this.points = new PointEditor(viewer, { ...actions, selectBody: (body) => this.selectBody(body), changed: () => host.changed(), pulled: () => host.latticePulled() });
    this.paint = new Paint(viewer, () => this.brush.settings.radius, {
      execute: (commands) => host.execute(commands), select: actions.select,
      material: (surface, counts) => host.client.query('material', { surface, counts }),
    });
    this.edges = new Edges(viewer, actions.select, (surface) => host.client.query('face_edges', { surface }), () => host.changed());
    this.measure = new Measure(viewer, host.client, () => host.changed());
    for (const viewport of viewer.viewports) this.bodies.listen(viewport); // before the tools see it
    this.pointers = new Pointers(viewer.viewports, viewer.navigator, () => this.tool(), (viewport, event) => {
      if (this.bodies.click(viewport, event)) return;
      const surface = this.bodies.selected === null ? null : viewer.pick(viewport, event);
      if (surface) void host.select(surface.surface);
      else this.offerToConvert(viewport, event);
    },
      () => viewer.context.choose(null), (viewport, event) => this.reach(viewport, event));
    for (const viewport of viewer.viewports) followGizmo(host, viewport);
    host.onChange.push(() => this.refresh());
  }

  get mode(): Mode {
    return this.brush.mode;
  }

  /** What the pointer does from now on. */
  choose(mode: Mode): void {
    this.tool().hover?.(null);
    for (const v of this.host.viewer.viewports) v.element.style.cursor = '';
    this.brush.mode = mode;
    if (mode !== 'points' && this.points.lattice) this.host.showLattice(null);
    document.querySelector('.side')?.scrollTo({ top: 0 }); // where the panel of the mode is
    if (paintModes.includes(mode)) this.paint.kind = mode as PaintKind;
    this.host.changed();
  }

  /** Something that Esc would revert is under way. */
  get active(): boolean {
    return [this.brush, this.surfaceBrush, this.bodies, this.points, this.paint].some((tool) => tool.active);
  }

  tool(): PointerTool {
    if (this.mode === 'points') return this.points;
    if (this.mode === 'edges') return this.bodies.selected === null ? this.edges : this.bodies;
    if (this.mode === 'measure') return this.measure;
    if (this.mode === 'brush') return this.surfaceBrush;
    if ((this.mode === 'grab' || this.mode === 'look') && this.bodies.under) return this.bodies;
    return paintModes.includes(this.mode) ? this.paint : this.brush;
  }

  /** A part that stands several times is worked on where it is pressed, unless a mark is meant that is drawn elsewhere. */
  private reach(viewport: Viewport, event: PointerEvent): void {
    const { viewer } = this.host;
    const first = viewer.frame?.state.selection[0];
    if (!viewer.placing.placed || this.mode === 'measure') return;
    if (this.mode === 'points' && first !== undefined && viewer.pickControlPoint(viewport, event, first, 20) !== null) return;
    if (this.mode === 'edges' && this.edges.at(viewport, event, 22) !== null) return;
    const hit = viewer.pick(viewport, event);
    if (hit) viewer.workAt(hit.standing);
  }

  /** Marks drawn over the surface follow it. */
  private refresh(): void {
    this.host.viewer.editing = this.mode === 'points' || this.mode === 'pin';
    this.points.refresh(this.mode === 'points');
    this.edges.refresh(this.mode === 'edges');
    void this.paint.refresh(this.mode === 'material', this.host.changes);
  }

  /** A curve or a volume, alone. */
  private async selectBody(body: number): Promise<void> {
    await this.host.execute([{ do: 'select', body: this.host.state!.bodies[body]!.id }]);
  }

  /** A new tool, on the near side of the surface point. */
  private async place(point: THREE.Vector3, normal: THREE.Vector3): Promise<void> {
    const { host } = this;
    const command = newTool(host, this.placing, this.brush.settings.radius, point, normal);
    if (!(await host.execute([command]))) return;
    this.choose('look');
    host.viewer.selectTool(command.name!);
    host.changed();
  }

  /** A grey face is no spline surface, but most can become one. */
  private offerToConvert(viewport: Viewport, event: PointerEvent): void {
    const { host } = this;
    const hit = host.viewer.pickGrey(viewport, event);
    host.viewer.context.choose(hit); // what F shows
    const face = hit?.face;
    if (face?.form === 'TRIANGLES') {
      host.notify({ kind: 'info', text: `The file holds ${face.id} as triangles alone, which cannot be sculpted.` });
    }
    if (!face?.surface) return;
    const convert = async () => {
      const { surface } = face; // held along its edges from the start
      host.viewer.workAt(hit!.standing);
      if (!(await host.execute([{ do: 'convert', surfaces: [surface] }, { do: 'select', surface }, ...clay]))) return;
      await host.select(host.state!.surfaces.findIndex((s) => s.id === surface));
    };
    host.notify({
      kind: 'info', text: `The face ${face.id} lies on ${aForm(face.form)}, which does not bend.`, remedy: 'As a spline surface of the same shape it can be sculpted.',
      actions: [{ label: 'Make it a spline surface', act: () => void convert() }],
    });
  }

  private actions(): BrushActions {
    const { host } = this;
    // What has begun with an engine that has stopped since is over.
    let life = 0;
    const over = () => life !== host.client.deaths;
    let finish = () => {};
    const ended = async (commands: Command[]): Promise<void> => {
      await host.client.followed();
      if (over() || (await host.execute(commands, commands.length > 0)) !== null || over() || commands.at(-1)?.do !== 'remove') return;
      // The end of the stroke is refused: what was done before stays without its brush, or all is taken back.
      if ((await host.execute([commands.at(-1)!], true)) === null) await host.execute([{ do: 'undo' }]);
    };
    return {
      begin: async (commands) => {
        const previous = this.idle;
        let done = () => {};
        this.idle = new Promise((resolve) => (done = resolve));
        await previous;
        finish = done;
        life = host.client.deaths;
        const good = (await host.execute(commands)) !== null;
        if (!good) done();
        return good;
      },
      follow: (commands, join) => {
        if (!over()) host.client.follow(commands, join);
      },
      end: (commands) => ended(commands).finally(finish),
      cancel: async () => {
        await host.client.followed();
        if (!over()) await host.execute([{ do: 'undo' }]);
        finish();
      },
      place: (point, normal) => void this.place(point, normal),
      select: (surface) => host.select(surface),
      pickTool: (name) => {
        host.viewer.selectTool(name);
        host.changed();
      },
      settingsChanged: () => host.changed(),
    };
  }
}
