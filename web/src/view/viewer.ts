import * as THREE from 'three';

import { format, unitInWords } from '../document/units';
import type { Context, Trim } from '../engine/context';
import type { Frame } from '../engine/protocol';
import { type Bounds, boundsOf } from './bounds';
import { BodyView } from './body_view';
import { CombView } from './comb_view';
import { ContextView, type GreyHit } from './context_view';
import { type Display, type Palette, palettes, type Theme } from './display';
import { Extent } from './extent';
import { Ground, roundStepAbove } from './ground';
import { limitsOf } from './limits';
import { Navigator } from './navigator';
import { nearestPoint } from './near';
import type { GridPicker } from './picking';
import { Placing, type Standing, still } from './placing';
import { Section, type SectionAxis } from './section';
import { Relief } from './relief';
import { placeSections } from './surface_material';
import { type Hit, nearestOn, scenePoint } from './surface_pick';
import { SurfaceView } from './surface_view';
import { type ToolScene, ToolsView } from './tools_view';
import { trimTextures } from './trim_shader';
import { Turntable } from './turntable';
import { type ViewName, Viewport } from './viewport';

export type { Hit } from './surface_pick';

/** Draws frames of the session in one window or four. Draws only when something has changed. */
export class Viewer {
  readonly element = document.createElement('div');
  readonly scene = new THREE.Scene();
  readonly viewports: Viewport[];
  readonly surfaces: SurfaceView[] = [];
  readonly ground = new Ground();
  /** Marks of the part that is worked on, in its coordinates, drawn on top. */
  readonly overlay = new THREE.Group();
  /** Marks in the scene. */
  readonly marks = new THREE.Group();
  /** Where parts of an assembly stand. */
  readonly placing = new Placing();
  origin: [number, number, number] = [0, 0, 0];
  frame: Frame | null = null;
  /** Called after each picture. */
  readonly onDrawn: (() => void)[] = [];

  readonly navigator = new Navigator((viewport, at) => {
    const hit = this.pick(viewport, at);
    return hit ? scenePoint(hit) : viewport.unprojectInScene(at.clientX, at.clientY, viewport.target);
  });
  /** A double click on the label of a view. */
  onMaximise: (name: ViewName) => void = () => {};

  readonly extent = new Extent(this);
  readonly turntable: Turntable;
  readonly section = new Section();
  readonly context = new ContextView();
  private readonly work = new THREE.Group(); // what is in the coordinates of the part that is worked on
  readonly tools = new ToolsView(this.work, () => this.viewports);
  readonly combs = new CombView();
  readonly bodies = new BodyView();
  /** A file was opened, and nothing in it has been chosen yet: what the session has selected is not what the user has. */
  waiting = false;
  private trims: Trim[] = [];
  private readonly renderer: THREE.WebGLRenderer;
  private readonly relief = new Relief();
  private readonly raycaster = new THREE.Raycaster();
  private due = false;
  private firstView = ''; // where it was fitted to surfaces, before the grey faces were there
  private editsPoints = false;
  private groundHeight = 0;
  private sceneRadius = 1;
  private theme: Theme = 'dark';

  constructor(public display: Display) {
    this.element.className = 'viewer';
    this.renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.autoClear = false;
    this.renderer.localClippingEnabled = true;
    this.renderer.domElement.className = 'viewer-canvas';
    this.renderer.domElement.setAttribute('aria-label', 'The scene');
    this.renderer.domElement.addEventListener('webglcontextrestored', () => this.redraw());
    const names: ViewName[] = ['perspective', 'top', 'front', 'right'];
    this.viewports = names.map((name) => new Viewport(name, this.scene, () => this.redraw()));
    for (const v of this.viewports) {
      v.label.addEventListener('dblclick', () => this.onMaximise(v.name));
      v.label.addEventListener('keydown', (e) => {
        if (e.key === 'Enter') this.onMaximise(v.name);
      });
    }
    const windows = document.createElement('div');
    windows.className = 'viewports';
    this.turntable = new Turntable(this.viewports[0]!, windows);
    windows.append(...this.viewports.map((v) => v.element));
    this.element.append(this.renderer.domElement, windows);
    const key = new THREE.DirectionalLight(0xffffff, 2.2);
    key.position.set(0.4, -0.6, 1);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f98, 1.4), key, this.ground.mesh, this.work, this.marks, this.context.group, this.section.group, this.bodies.group);
    this.work.matrixAutoUpdate = false;
    this.work.add(this.overlay, this.combs.group);
    this.section.onChange = () => this.redraw();
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  /** Control points are shown and can be picked. */
  set editing(on: boolean) {
    if (this.surfaces.every((s) => s.editing === on) && this.editsPoints === on) return;
    this.editsPoints = this.bodies.editing = on;
    for (const s of this.surfaces) s.editing = on;
    this.restyle();
  }

  get unit(): string {
    return this.placing.placed ? this.placing.assembly!.unit : (this.frame?.state.surfaces[0] ?? this.frame?.state.bodies[0])?.unit ?? '';
  }

  /** The view alone, or, of four, the perspective one. */
  get main(): Viewport {
    return this.viewports.find((v) => !this.display.fourViews && v.name === this.display.view) ?? this.viewports[0]!;
  }

  get palette(): Palette {
    return palettes[this.theme];
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.restyle();
  }

  /** Takes over a frame of the worker. The views are fitted if `fresh`. */
  show(frame: Frame, fresh: boolean): void {
    this.frame = frame;
    this.origin = frame.origin;
    const { state, pictures } = frame;
    if (frame.assembly !== undefined) this.placing.open(frame.assembly, frame.origin);
    while (this.surfaces.length > pictures.length) {
      const gone = this.surfaces.pop()!;
      this.scene.remove(gone.group);
      gone.dispose();
    }
    while (this.surfaces.length < pictures.length) {
      const view = new SurfaceView();
      view.editing = this.editsPoints;
      this.surfaces.push(view);
      this.scene.add(view.group);
    }
    const { colour, autoLimits } = this.display;
    if (colour && autoLimits) this.display.limits = limitsOf(colour, frame.range);
    this.combs.show(frame.combs);
    this.combs.restyle(this.display.combScale * this.bounds().radius, this.palette.comb);
    const lit = (k: number) => state.selection.length === 0 || state.selection.includes(k);
    pictures.forEach((p, k) => this.surfaces[k]!.show(p, state.surfaces[k]!, this.display, this.palette, lit(k)));
    this.bodies.show(frame.bodies, frame.lattice, state.body, state.bodies, this.placing);
    this.stand();
    this.tools.show(frame, this.toolScene);
    this.section.forget();
    if (fresh) {
      this.section.end();
      this.fit();
      this.firstView = JSON.stringify(this.main.placement());
    } else this.lowerGround();
    this.redraw();
  }

  /** The surroundings of the surfaces of the frame, and the visible part of each. */
  showContext(context: Context | null, trims: Trim[]): void {
    this.context.show(context, this.placing);
    this.section.forget();
    this.trims = trims;
    this.surfaces.forEach((s, k) => (s.trim = trimTextures(trims[k] ?? null)));
    const unmoved = this.firstView === JSON.stringify(this.main.placement());
    this.restyle();
    if (context && unmoved && !this.extent.whole) requestAnimationFrame(() => this.fitAll()); // grey faces belong to the first view
  }

  /** Puts all surfaces where they stand, and what belongs to the part that is worked on into its place. */
  private stand(): void {
    this.surfaces.forEach((s, k) => s.stand(this.standings(k), this.working(k)));
    const { workplace } = this;
    this.work.matrix.copy(workplace.matrix);
    this.work.updateMatrixWorld(true);
    for (const view of this.viewports) view.workplace = workplace;
    this.bodies.workplace = workplace;
    this.bodies.restyle(this.display, this.palette);
  }

  /** Where a surface stands, by its number. */
  standings(surface: number): readonly Standing[] {
    return this.placing.of(this.frame?.state.surfaces[surface]?.id ?? '');
  }

  /** In which of these places it is worked on. */
  working(surface: number): Standing {
    return this.placing.working(this.frame?.state.surfaces[surface]?.id ?? '');
  }

  /** The place of the selected curve or the first selected surface: tools, control points, edges and combs are there. */
  get workplace(): Standing {
    const { selection: [first] = [], bodies = [], body = null } = this.frame?.state ?? {};
    if (body !== null) return this.placing.working(bodies[body]!.id);
    return first === undefined ? still : this.working(first);
  }

  /** From now on a part is worked on in this of its places. */
  workAt(standing: Standing): void {
    if (!this.placing.work(standing)) return;
    this.stand();
    this.section.forget();
    this.redraw();
  }

  /** The ground stays below whatever is pressed down. */
  private lowerGround(): void {
    const { radius, lowest } = this.bounds();
    if (this.groundHeight > lowest - 0.02 * radius) this.groundHeight = lowest - 0.06 * radius;
    this.sceneRadius = radius;
  }

  private get toolScene(): ToolScene {
    return { origin: this.origin, size: this.bounds().radius, palette: this.palette };
  }

  selectTool(name: string | null): void {
    this.tools.select(name, this.toolScene);
    this.redraw();
  }

  trimOf(surface: number): Trim {
    return this.trims[surface] ?? null;
  }

  /** Whether the user has chosen this surface. */
  isSelected(surface: number): boolean {
    return !this.waiting && (this.frame?.state.selection.includes(surface) ?? false);
  }

  /** Centre and radius of all surfaces. */
  bounds(): Bounds {
    return this.extent.bounds();
  }

  /** Shows all surfaces. */
  fit(bounds = this.bounds()): void {
    for (const v of this.viewports) v.fit(bounds);
    const { radius, lowest } = this.bounds();
    this.groundHeight = lowest - 0.12 * radius;
    this.sceneRadius = radius;
    this.redraw();
  }

  /** Shows the grey face that was clicked last, or what is seen of the selected surfaces; all if there are none. */
  fitSelected(): void {
    const { state } = this.frame ?? {};
    const boxes = (state?.selection ?? []).map((k) => this.extent.seen(k));
    const grey = this.context.chosenBox();
    if (grey || (boxes.length > 0 && !this.waiting)) this.fit(boundsOf(grey ? [grey] : boxes));
    else this.fitAll();
  }

  /** Shows the other faces of the file, too. */
  fitAll(): void {
    this.fit(boundsOf(this.extent.all()));
  }

  /** Cuts through the middle of everything, and hides what is before that. */
  beginSection(axis: SectionAxis): void {
    const box = this.extent.all().reduce<THREE.Box3>((all, other) => (other ? all.union(other) : all), new THREE.Box3());
    if (!box.isEmpty()) this.section.begin(axis, box, this.main.camera.getWorldDirection(new THREE.Vector3()).negate());
  }

  restyle(): void {
    this.context.restyle(this.display, this.palette);
    this.section.forget();
    this.ground.restyle(this.palette);
    this.combs.restyle(this.display.combScale * this.bounds().radius, this.palette.comb);
    this.bodies.restyle(this.display, this.palette);
    const state = this.frame?.state;
    this.surfaces.forEach((s, k) =>
      s.restyle(this.display, this.palette, !state || this.waiting || state.selection.length === 0 || state.selection.includes(k)));
    this.tools.restyle(this.toolScene);
    this.element.classList.toggle('four', this.display.fourViews);
    this.viewports[0]!.parallel = this.display.parallel;
    for (const v of this.viewports) v.element.hidden = !this.display.fourViews && v.name !== this.display.view;
    this.resize();
  }

  /**
   * What is under the pointer: the nearest surface, as last drawn, or, in the place that is worked on, as it was when `frozen`
   * was taken; where it is drawn trimmed, only what its faces show.
   */
  pick(viewport: Viewport, event: { clientX: number; clientY: number }, frozen?: readonly (GridPicker | null)[]): Hit | null {
    const { ray } = viewport.sceneRay(event, this.raycaster);
    const far = this.section.clip(ray);
    const { workplace } = this;
    const best = nearestOn(ray, far, (frozen ?? this.pickers).map((picker, k) => {
      const all = this.standings(k);
      const standings = frozen ? all.filter(({ part, place }) => part === workplace.part && place === workplace.place) : all;
      return { picker, trim: this.display.trimmed ? this.trimOf(k) : null, standings };
    }));
    return best && !frozen && this.context.hides(this.raycaster, best.distance) ? null : best;
  }

  /** The grey face under the pointer, if no surface is before it. */
  pickGrey(viewport: Viewport, event: { clientX: number; clientY: number }): GreyHit | null {
    if (this.pick(viewport, event)) return null;
    return this.context.hit(this.raycaster, this.section.clip(this.raycaster.ray));
  }

  get pickers(): (GridPicker | null)[] {
    return this.surfaces.map((s) => s.picker);
  }

  pickTool(viewport: Viewport, event: { clientX: number; clientY: number }): string | null {
    return this.tools.pick(viewport.sceneRay(event, this.raycaster));
  }

  /** Where points of the part that is worked on, or by a matrix of others, lie on the page, as by `projectAll`; NaN also where a section hides them. */
  places(viewport: Viewport, points: ArrayLike<number>, { matrix }: Pick<Standing, 'matrix'> = this.workplace): Float32Array {
    const places = viewport.projectAll(points, matrix);
    const p = new THREE.Vector3();
    for (let k = 0; 3 * k < points.length && this.section.on; ++k) {
      p.set(points[3 * k]!, points[3 * k + 1]!, points[3 * k + 2]!).applyMatrix4(matrix);
      if (this.section.hides(p.x, p.y, p.z)) places[2 * k] = NaN;
    }
    return places;
  }

  /** Index of the control point of a surface under the pointer, within `reach` pixels. */
  pickControlPoint(viewport: Viewport, event: { clientX: number; clientY: number }, surface: number, reach = 9): number | null {
    const net = this.surfaces[surface]?.picture?.net;
    return net ? nearestPoint(this.places(viewport, net), event, reach) : null;
  }

  redraw(): void {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      this.draw();
    });
  }

  /** Length between section curves: the user's, or a round one that gives about twenty. */
  get sectionSpacing(): number {
    return this.display.sectionSpacing || roundStepAbove(this.bounds().radius / 10);
  }

  private resize(): void {
    this.renderer.setSize(Math.max(1, this.element.clientWidth), Math.max(1, this.element.clientHeight), false);
    for (const v of this.viewports) v.resize();
    this.redraw();
  }

  private draw(): void {
    const whole = this.element.getBoundingClientRect();
    this.section.prepare([...this.surfaces.map((s) => s.group), this.context.group, this.combs.group, this.overlay, this.marks], () => ({
      surfaces: this.display.surface ? this.surfaces.flatMap(({ picture }, k) =>
        (picture ? [{ picture, trim: this.display.trimmed ? this.trimOf(k) : null, standings: this.standings(k) }] : [])) : [],
      grey: this.context.group.visible ? this.context.pieces : [],
    }));
    const relief = Relief.wanted(this.display);
    const spacing = this.display.sections === 'none' ? 1 : this.sectionSpacing;
    for (const s of this.surfaces) placeSections(s.mesh.material, this.display, spacing, this.origin);
    this.relief.begin(this.renderer, relief);
    this.renderer.setClearColor(this.palette.background);
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    for (const view of this.viewports) {
      const box = view.element.getBoundingClientRect();
      if (box.width === 0 || box.height === 0) continue;
      const x = box.left - whole.left;
      const y = whole.bottom - box.bottom;
      if (relief) this.relief.draw(this.renderer, this.scene, view.camera, [x, y, box.width, box.height]);
      this.renderer.setViewport(x, y, box.width, box.height);
      this.renderer.setScissor(x, y, box.width, box.height);
      for (const other of this.viewports) other.gizmo.getHelper().visible = other === view && other.gizmo.object !== undefined;
      this.ground.mesh.visible = this.display.grid;
      if (this.display.grid) this.ground.prepare(view, this.groundHeight, this.sceneRadius, this.origin);
      view.showScale(this.display.grid ? `${format(this.ground.step)} ${unitInWords(this.unit)}` : '', this.ground.step / view.pixel());
      this.renderer.render(this.scene, view.camera);
    }
    for (const follow of this.onDrawn) follow();
  }

  /** The picture on the screen as a PNG file, with `scale` pixels for each of the page's. */
  picture(scale = 1): Promise<Blob> {
    const usual = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(scale);
    this.draw();
    const picture = new Promise<Blob>((resolve, reject) =>
      this.renderer.domElement.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('no picture'))), 'image/png'));
    this.renderer.setPixelRatio(usual);
    this.draw();
    return picture;
  }
}
