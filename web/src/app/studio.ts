import * as THREE from 'three';

import { Documents } from '../document/documents';
import type { Notice, Question } from '../document/host';
import { hasSettings, makeReady } from '../document/ready';
import { adviceOn, inOneLine } from '../document/words';
import { Saving } from '../document/saving';
import { Client, type End } from '../engine/client';
import type { Context, Trim } from '../engine/context';
import { plain } from '../engine/displays';
import type { Frame, PictureSettings } from '../engine/protocol';
import { selected } from '../engine/session_state';
import { type Command, KneadError, type EngineErrorInfo, type LatticeSettings, type SessionInfo, type StepInfo, type SurfaceNumbers } from '../engine/session_types';
import { usualRadius } from '../engine/strokes';
import type { App } from '../panels/app';
import { openSnakes } from '../panels/snakes/door';
import { Hand } from '../tools/hand';
import { defaultDisplay, type Display, type Theme } from '../view/display';
import { sectionPlanes } from '../view/section_planes';
import { Viewer } from '../view/viewer';
import { CloserLook } from './closer_look';
import { Growth } from './growth';
import { Notes } from './notes';

const keptSteps = 400; // of the plot
const mostDeaths = 20; // of engines, before a page gives up

/** What the page knows and can do: the connection to the session, the viewer, and what the user has chosen. */
export class Studio implements App {
  readonly client: Client;
  readonly viewer: Viewer;
  readonly hand: Hand;
  display: Display;
  theme: Theme;
  frame: Frame | null = null;
  steps: StepInfo[] = [];
  framesPerSecond = 0;
  /** Counts commands, so that the history knows when to update. */
  changes = 0;
  readonly documents = new Documents(this);
  readonly saving = new Saving(this, this.documents);
  /** Milliseconds that the worker has spent on this session's commands. */
  computedTime = 0;

  private readonly closer: CloserLook;
  private readonly notes = new Notes(this);
  private readonly growth = new Growth(this);
  /** Panels are redrawn on these. */
  readonly onChange: (() => void)[] = [];
  notify: (notice: Notice) => void = () => {};
  settle: (topic: string) => void = () => {};
  ask: (question: Question) => Promise<string | null> = () => Promise.resolve(null);

  private fresh = false;
  private lastFrame = 0;
  private stepsEnd = 0;
  private surfaceIds = '';

  constructor() {
    const kept = readKept();
    this.display = { ...defaultDisplay, ...kept.display, colour: null };
    this.theme = kept.theme ?? (matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
    this.client = new Client(() => new Worker(new URL('../engine/worker.ts', import.meta.url), { type: 'module' }));
    this.viewer = new Viewer(this.display);
    const { section } = this.viewer, drawn = section.onChange;
    section.onChange = () => {
      drawn();
      if (this.display.combs === 'sections') this.askForPictures(false);
    };
    this.hand = new Hand(this);
    this.closer = new CloserLook(this.viewer, () => this.frame !== null && !this.hand.active && !this.playing() && !this.viewer.turntable.on,
      () => this.askForPictures(this.comparing));
    this.viewer.navigator.convention = this.display.convention;
    this.viewer.onMaximise = (view) => this.setDisplay({ view, fourViews: !this.display.fourViews });
    this.client.onFrame = (frame) => this.show(frame);
    this.client.onError = (error) => this.fail(error);
    this.client.onDeath = (end) => void this.revive(end);
    this.setTheme(this.theme);
  }

  get state(): SessionInfo | null {
    return this.frame?.state ?? null;
  }

  /** Diagonal of the selected surfaces, or of all. */
  get diagonal(): number {
    const { state } = this;
    if (!state) return 1;
    const chosen = selected(state);
    const box = new THREE.Box3();
    for (const s of chosen.length > 0 ? chosen : [...state.surfaces, ...state.bodies]) box.expandByPoint(new THREE.Vector3(...s.lower)).expandByPoint(new THREE.Vector3(...s.upper));
    return box.getSize(new THREE.Vector3()).length() || 1;
  }

  changed(): void {
    if (this.viewer.waiting !== this.documents.waiting) {
      this.viewer.waiting = this.documents.waiting;
      this.viewer.restyle();
    }
    for (const draw of this.onChange) draw();
  }

  private show(frame: Frame): void {
    const now = performance.now();
    if (this.frame?.playing && frame.playing) {
      const rate = 1000 / Math.max(1, now - this.lastFrame);
      this.framesPerSecond = this.framesPerSecond === 0 ? rate : 0.9 * this.framesPerSecond + 0.1 * rate;
    } else this.framesPerSecond = 0;
    this.lastFrame = now;
    this.frame = frame;
    ++this.changes;
    this.steps = frame.firstStep === this.stepsEnd ? [...this.steps, ...frame.steps] : frame.steps;
    this.stepsEnd = frame.state.steps;
    if (this.steps.length > keptSteps) this.steps = this.steps.slice(-keptSteps);
    this.viewer.waiting = this.documents.waiting;
    this.viewer.show(frame, this.fresh);
    const ids = frame.state.surfaces.map((s) => s.id).join();
    if (!this.fresh && ids !== this.surfaceIds) this.documents.askForContext();
    this.surfaceIds = ids;
    if (frame.assembly !== undefined) this.tellPlaces();
    if (this.fresh) {
      this.fresh = false;
      this.growth.forget();
      this.hand.size.unit = 'length';
      this.hand.brush.settings.radius = usualRadius * this.diagonal;
    }
    const busy = this.hand.active || frame.playing;
    this.notes.tell(frame.state.notes, busy);
    this.growth.follow(frame.state, busy);
    this.computedTime += frame.computeTime;
    this.documents.keeper.computed(frame.unkept, frame.playing);
    this.changed();
  }

  /** What of the opened assembly is not as the user may expect. */
  private tellPlaces(): void {
    const { assembly, left } = this.viewer.placing;
    this.toldParts.clear();
    for (const warning of assembly?.warnings ?? []) this.notify({ kind: 'info', text: warning });
    if (left > 0) this.notify({ kind: 'info', text: `${left} places of parts are not drawn: the file has too many of them. Nothing of the file is lost.` });
  }

  private readonly toldParts = new Set<string>();

  /** Says once per part that it is sculpted in all its places at once. */
  private tellRepeated(surface: number): void {
    const { placing } = this.viewer;
    const id = this.state?.surfaces[surface]?.id ?? '';
    const part = placing.assembly?.parts.find((p) => p.surfaces.includes(id));
    if (!part || placing.of(id).length < 2 || this.toldParts.has(part.name)) return;
    this.toldParts.add(part.name);
    this.notify({ kind: 'info', text: `${part.name ? `“${part.name}”` : 'This part'} stands in ${part.places.length} places of the assembly: it is sculpted once, and changes in all of them.` });
  }

  /** The last act again, changed, after commands that undo it. */
  async again(before: Command[], change: (command: Command) => Command = (command) => command): Promise<void> {
    const commands = JSON.parse(await this.client.query('journal')) as Command[];
    // What is done with a ball is a tool, its strokes and its removal.
    const first = commands.at(-1)?.do === 'remove' ? commands.map((c) => c.do).lastIndexOf('tool') : commands.length - 1;
    for (const command of before) {
      if (!(await this.execute([command]))) return;
    }
    await this.execute(commands.slice(first).map(change));
  }

  /** Executes commands as one entry of the history. Null if something went wrong, which the user has then been told. */
  async execute(commands: Command[], join = false): Promise<true | null> {
    return this.attempt(async () => {
      await this.client.execute(commands, join);
      this.documents.work(commands);
    }, !join);
  }

  async offer(commands: Command[]): Promise<string | null> {
    try {
      await this.client.execute(commands);
      this.documents.work(commands);
      return null;
    } catch (error) {
      return error instanceof KneadError ? inOneLine(error.info) : String(error);
    }
  }

  /** `whole`: what fails has done nothing. */
  async attempt(act: () => Promise<void>, whole = false): Promise<true | null> {
    const { sessions } = this.documents;
    try {
      await act();
      return true;
    } catch (error) {
      if (sessions !== this.documents.sessions && error instanceof KneadError) return null; // meant for a document that is closed
      if (error instanceof KneadError) this.fail(error.info, whole);
      else this.notify({ kind: 'error', text: error instanceof Error ? error.message : String(error) });
      return null;
    }
  }

  /** The engine has stopped: another goes on. */
  private async revive(end: End): Promise<void> {
    const { deaths, stops } = this.client;
    if (deaths - stops > mostDeaths) {
      this.notify({ kind: 'error', text: 'The engine stops again and again.', remedy: 'Reload the page: what was kept is offered there.' });
      return;
    }
    await this.client.ready;
    if (deaths !== this.client.deaths) return;
    this.askForPictures(false);
    await this.documents.revive(end);
  }

  private fail(error: EngineErrorInfo, nothingDone = false): void {
    if (error.kind === 'died') return; // told once it goes on
    const { text, remedy, actions } = adviceOn(error, nothingDone);
    this.notify({ kind: 'error', text, ...(error.code === 'none' ? {} : { topic: error.code }), remedy, actions: actions.map(({ label, commands }) => ({ label, act: () => void this.execute(commands) })) });
  }

  // --- documents: document/documents.ts, document/saving.ts ---------------------------------------------------------

  /** The next frame is of another session. Gives back what takes that back. */
  begin(again = false): () => void {
    const { fresh, steps, stepsEnd, computedTime } = this;
    const tool = this.viewer.tools.selected;
    Object.assign(this, { fresh: !again, steps: [], stepsEnd: 0, computedTime: 0 });
    this.viewer.selectTool(null);
    this.hand.edges.forget();
    this.hand.measure.clear();
    return () => {
      Object.assign(this, { fresh, steps, stepsEnd, computedTime });
      this.viewer.selectTool(tool);
    };
  }

  get detail(): number {
    return this.display.detail;
  }

  sizeBrush(radius: number): void {
    if (this.hand.size.unit !== 'length') return; // it has a size of its own
    this.hand.brush.settings.radius = Math.min(radius, usualRadius * this.diagonal);
    this.changed();
  }

  showContext(context: Context | null, trims: Trim[]): void {
    this.viewer.showContext(context, trims);
  }

  openImage(file: File): Promise<void> {
    return openSnakes(this, file);
  }

  showEdges(): void {
    const panel = document.querySelector<HTMLDetailsElement>('.panel[data-panel="Edges"]');
    if (!panel) return;
    panel.open = true;
    panel.scrollIntoView({ block: 'nearest' });
  }

  forgetEdges(): void {
    this.hand.edges.forget();
  }

  picture(scale: number): Promise<Blob> {
    return this.viewer.picture(scale);
  }

  /** Selects a surface. One without settings becomes clay with held edges; otherwise it would float away when pressed. */
  async select(surface: number): Promise<void> {
    await this.attempt(async () => {
      await makeReady(this, surface, false);
      this.documents.pick();
      this.tellRepeated(surface);
      this.changed();
      this.documents.keeper.touch();
    });
  }

  async selectTogether(surfaces: number[]): Promise<void> {
    await this.attempt(async () => {
      for (const k of surfaces) {
        if (!hasSettings(this.state!.surfaces[k]!)) await makeReady(this, k, false);
      }
      await this.client.execute([{ do: 'select', surfaces: surfaces.map((k) => this.state!.surfaces[k]!.id) }]);
      this.documents.pick();
      this.changed();
      this.documents.keeper.touch();
    });
  }

  // --- what is seen ------------------------------------------------------------------------------------------------

  setDisplay(change: Partial<Display>): void {
    const redraw = (change.colour !== undefined && change.colour !== this.display.colour) || change.colourSettings !== undefined || change.detail !== undefined ||
      change.combs !== undefined || change.combCurves !== undefined || change.combTeeth !== undefined ||
      (this.display.combs === 'sections' && (change.sections !== undefined || change.sectionSpacing !== undefined));
    Object.assign(this.display, change);
    this.viewer.navigator.convention = this.display.convention;
    this.viewer.restyle();
    if (redraw) this.askForPictures(false);
    this.keepSettings();
    this.changed();
  }

  /** From now on pictures follow the display, of the present shapes or of those that were opened. */
  askForPictures(opened: boolean): void {
    const { detail, colour, colourSettings, combs, combCurves, combTeeth } = this.display;
    const on = (direction: 'u' | 'v') => (combs === direction || combs === 'both' ? combCurves : 0);
    const asked: PictureSettings['combs'] = combs === 'none' || combs === 'sections' ? undefined : { curves: [on('u'), on('v')], teeth: combTeeth };
    const display = colour ? { display: colour.name, settings: colourSettings[colour.name] ?? {} } : plain;
    const sectionCombs = combs === 'sections' ? sectionPlanes(this.viewer) : undefined;
    void this.attempt(async () => void (await this.client.pictures({ detail, display, opened, combs: asked, sectionCombs, windows: this.closer.windows(), ...(this.hand.points.lattice ? { lattice: this.hand.points.lattice } : {}) })));
  }

  showLattice(lattice: LatticeSettings | null): void {
    this.hand.points.lattice = lattice;
    this.hand.points.choose([]);
    this.askForPictures(false);
  }

  latticePulled(): void {
    const { lattice } = this.hand.points;
    if (!lattice?.anew) return;
    this.hand.points.lattice = { net: lattice.net, margin: lattice.margin };
    this.askForPictures(false);
  }

  private comparing = false;

  /** While a key is held: the surfaces as they were opened. */
  compare(opened: boolean): void {
    if (!this.state || opened === this.comparing) return;
    this.comparing = opened;
    document.documentElement.dataset.comparing = String(opened);
    this.askForPictures(opened);
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    document.documentElement.dataset.theme = theme;
    this.viewer.setTheme(theme);
    this.keepSettings();
    this.changed();
  }

  private keepSettings(): void {
    try {
      localStorage.setItem('knead', JSON.stringify({ display: { ...this.display, colour: null }, theme: this.theme }));
    } catch {
      // Without storage the settings last until the page is closed.
    }
  }

  private numbers: { of: string; data: Promise<SurfaceNumbers> } | null = null;

  /** The numbers of a surface as it is now; requested once per change. */
  surfaceData(surface: number): Promise<SurfaceNumbers> {
    const of = `${surface} ${this.changes}`;
    if (this.numbers?.of !== of) this.numbers = { of, data: this.client.query('surface', { surface }) };
    return this.numbers.data;
  }

  playing(): boolean {
    return this.frame?.playing ?? false;
  }

  togglePlay(toRest = false): void {
    this.documents.work([{ do: 'step' }]);
    void this.attempt(async () => void (await (this.playing() ? this.client.stop() : this.client.play(toRest))));
  }
}

function readKept(): { display?: Partial<Display>; theme?: Theme } {
  try {
    return JSON.parse(localStorage.getItem('knead') ?? '{}') as { display?: Partial<Display>; theme?: Theme };
  } catch {
    return {};
  }
}
