import type { App } from '../app';
import type { Command } from '../engine/session_types';
import { Brush, type BrushActions } from './brush';
import { Edges } from './edges';
import { type Mode, paintModes } from './modes';
import { Paint, type PaintKind } from './paint';
import { PointEditor } from './point_edit';
import { Pointers, type PointerTool } from './pointers';

/** Everything that the pointer can do, and which of it a press means now. */
export class Hand {
  readonly brush: Brush;
  readonly points: PointEditor;
  readonly paint: Paint;
  readonly edges: Edges;
  readonly pointers: Pointers;

  constructor(private readonly app: App) {
    const { viewer } = app;
    const actions = actionsOf(app);
    this.brush = new Brush(viewer, actions);
    this.points = new PointEditor(viewer, { ...actions, changed: () => app.changed() });
    this.paint = new Paint(viewer, () => this.brush.settings.radius, {
      execute: (commands) => app.execute(commands), select: actions.select,
      journal: async () => (JSON.parse(await app.client.journal()) as { commands: Command[] }).commands,
    });
    this.edges = new Edges(viewer, actions.select);
    this.pointers = new Pointers(viewer.viewports, viewer.navigator, () => this.tool());
    app.onChange.push(() => this.refresh());
  }

  get mode(): Mode {
    return this.brush.mode;
  }

  set mode(mode: Mode) {
    this.tool().hover?.(null);
    for (const v of this.app.viewer.viewports) v.element.style.cursor = '';
    this.brush.mode = mode;
    document.querySelector('.side')?.scrollTo({ top: 0 }); // where the panel of the mode is
    if (paintModes.includes(mode)) this.paint.kind = mode as PaintKind;
  }

  /** Something that Esc would take back is under way. */
  get active(): boolean {
    return [this.brush, this.points, this.paint].some((tool) => tool.active);
  }

  tool(): PointerTool {
    if (this.mode === 'points') return this.points;
    if (this.mode === 'edges') return this.edges;
    return paintModes.includes(this.mode) ? this.paint : this.brush;
  }

  /** What is drawn over the surface follows the surface. */
  private refresh(): void {
    this.app.viewer.editing = this.mode === 'points' || this.mode === 'pin';
    this.points.refresh(this.mode === 'points');
    this.edges.refresh(this.mode === 'edges');
    void this.paint.refresh(this.mode === 'material', this.app.changes);
  }
}

function actionsOf(app: App): BrushActions {
  return {
    begin: async (commands) => (await app.execute(commands)) !== null,
    follow: (commands, join) => app.client.follow(commands, join),
    end: async (commands) => {
      await app.client.followed();
      if (commands.length > 0) await app.execute(commands, commands[0]!.do === 'remove');
      else await app.execute([]);
    },
    cancel: async () => {
      await app.client.followed();
      await app.execute([{ do: 'undo' }]);
    },
    place: (point, normal) => void app.placeTool(point, normal),
    select: (surface) => app.select(surface),
    pickTool: (name) => {
      app.viewer.selectTool(name);
      app.changed();
    },
    settingsChanged: () => app.changed(),
  };
}
