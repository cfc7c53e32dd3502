import type * as THREE from 'three';

import type { Frame } from '../engine/protocol';
import type { Palette } from './display';
import { ToolView } from './tool_view';
import type { Viewport } from './viewport';

/** What the pictures of tools need to know of the scene. */
export interface ToolScene {
  origin: readonly number[];
  /** Radius of everything. */
  size: number;
  palette: Palette;
}

/** Pictures of all tools, in the place of the part that they work on, and the gizmos of the one that is selected. */
export class ToolsView {
  selected: string | null = null;
  private readonly views = new Map<string, ToolView>();

  constructor(private readonly parent: THREE.Object3D, private readonly viewports: () => readonly Viewport[]) {}

  get(name: string): ToolView | undefined {
    return this.views.get(name);
  }

  show(frame: Frame, scene: ToolScene): void {
    const infos = frame.state.tools;
    for (const [name, view] of this.views) {
      if (infos.some((t) => t.name === name)) continue;
      this.parent.remove(view.object);
      view.dispose();
      this.views.delete(name);
    }
    const dragging = this.viewports().some((v) => v.gizmo.dragging);
    for (const info of infos) {
      let view = this.views.get(info.name);
      if (!view) {
        view = new ToolView(info);
        view.object.userData.tool = info.name;
        this.views.set(info.name, view);
        this.parent.add(view.object);
      }
      const picture = frame.toolPictures[info.name];
      if (picture) view.picture = picture;
      // While the user drags a tool, the picture is ahead of the session.
      if (!(dragging && info.name === this.selected)) view.show(info, scene.origin, scene.size, scene.palette, info.name === this.selected);
    }
    if (this.selected && !this.views.has(this.selected)) this.select(null, scene);
    else this.attachGizmos();
  }

  select(name: string | null, scene: ToolScene): void {
    this.selected = name;
    this.restyle(scene);
    this.attachGizmos();
  }

  restyle({ origin, size, palette }: ToolScene): void {
    for (const [name, view] of this.views) view.show(view.tool, origin, size, palette, name === this.selected);
  }

  private attachGizmos(): void {
    const view = this.selected ? this.views.get(this.selected) : undefined;
    for (const { gizmo } of this.viewports()) {
      if (view && gizmo.object !== view.object) gizmo.attach(view.object);
      else if (!view && gizmo.object) gizmo.detach();
    }
  }

  /** The tool on a ray. */
  pick(raycaster: THREE.Raycaster): string | null {
    const hit = raycaster.intersectObjects([...this.views.values()].map((t) => t.object), false)[0];
    return (hit?.object.userData.tool as string | undefined) ?? null;
  }
}
