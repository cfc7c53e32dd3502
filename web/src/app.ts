import * as THREE from 'three';

import { autosave, type Saved } from './document/autosave';
import { readKnead, writeKnead } from './document/knead_file';
import { loadContext } from './document/context';
import { clay } from './document/clay';
import { Client } from './engine/client';
import type { Frame } from './engine/protocol';
import { type Command, EngineError, type EngineErrorInfo, type SessionInfo, type StepInfo, type SurfaceInfo, type SurfaceNumbers } from './engine/session_types';
import { followGizmo } from './view/gizmo';
import { Hand } from './view/hand';
import type { Brush } from './view/brush';
import type { Mode } from './view/modes';
import { newTool } from './view/new_tool';
import { defaultDisplay, type Display, type Theme } from './view/display';
import { Viewer } from './view/viewer';

export interface Notice {
  kind: 'error' | 'info';
  text: string;
  remedy?: string;
  actions?: { label: string; act: () => void }[];
}

const autosaveDelay = 800; // milliseconds without a change
const keptSteps = 400; // of the plot

/** What the page knows and can do: the line to the session, the viewer, and what the user has chosen. */
export class App {
  readonly client: Client;
  readonly viewer: Viewer;
  readonly hand: Hand;
  display: Display;
  theme: Theme;
  frame: Frame | null = null;
  steps: StepInfo[] = [];
  framesPerSecond = 0;
  /** Counts what was done, so that the history knows when to look again. */
  changes = 0;
  /** Files that the user gave, opened or refused. */
  filesHandled = 0;
  /** The file that was opened, for documents and the autosave. */
  source: { name: string; bytes: Uint8Array | null } = { name: 'sheet', bytes: null };

  /** Panels draw themselves anew on these. */
  readonly onChange: ((app: App) => void)[] = [];
  notify: (notice: Notice) => void = () => {};

  private fresh = false;
  private dirty = false;
  private saveTimer = 0;
  private lastFrame = 0;
  private wasPlaying = false;
  private stepsEnd = 0;

  constructor() {
    const kept = readKept();
    this.display = { ...defaultDisplay, ...kept.display, field: 'none', zebra: false };
    this.theme = kept.theme ?? (matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
    this.client = new Client(new Worker(new URL('./engine/worker.ts', import.meta.url), { type: 'module' }));
    this.viewer = new Viewer(this.display);
    this.hand = new Hand(this);
    this.viewer.navigator.convention = this.display.convention;
    this.viewer.onMaximise = (view) => this.setDisplay({ view, fourViews: !this.display.fourViews });
    this.client.onFrame = (frame) => this.show(frame);
    this.client.onError = (error) => this.fail(error);
    for (const viewport of this.viewer.viewports) followGizmo(this, viewport);
    this.setTheme(this.theme);
  }

  get brush(): Brush {
    return this.hand.brush;
  }

  get state(): SessionInfo | null {
    return this.frame?.state ?? null;
  }

  /** Diagonal of the selected surfaces, or of all. */
  get diagonal(): number {
    const { state } = this;
    if (!state || state.surfaces.length === 0) return 1;
    const chosen = state.selection.length > 0 ? state.selection.map((k) => state.surfaces[k]!) : state.surfaces;
    const box = new THREE.Box3();
    for (const s of chosen) box.expandByPoint(new THREE.Vector3(...s.lower)).expandByPoint(new THREE.Vector3(...s.upper));
    return box.getSize(new THREE.Vector3()).length() || 1;
  }

  changed(): void {
    for (const draw of this.onChange) draw(this);
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
    this.viewer.show(frame, this.fresh);
    if (this.fresh) {
      this.fresh = false;
      this.brush.settings.radius = 0.08 * this.diagonal;
    }
    if (this.wasPlaying && !frame.playing) this.touch();
    this.wasPlaying = frame.playing;
    this.changed();
  }

  /** Executes commands as one entry of the history. Null where something went wrong; the user has been told then. */
  async execute(commands: Command[], join = false): Promise<true | null> {
    return this.attempt(async () => {
      await this.client.execute(commands, join);
      this.touch();
    });
  }

  async attempt(act: () => Promise<void>): Promise<true | null> {
    try {
      await act();
      return true;
    } catch (error) {
      if (error instanceof EngineError) this.fail(error.info);
      else this.notify({ kind: 'error', text: error instanceof Error ? error.message : String(error) });
      return null;
    }
  }

  private fail(error: EngineErrorInfo): void {
    const place = error.where ? `${error.where}: ` : '';
    const text = place + error.what;
    this.notify({ kind: 'error', text: text[0]!.toUpperCase() + text.slice(1), remedy: error.remedy });
  }

  // --- documents ---------------------------------------------------------------------------------------------------

  async openStep(bytes: Uint8Array, name: string, commands: Command[] = []): Promise<true | null> {
    return this.attempt(async () => {
      this.begin();
      const script = JSON.stringify({ knead: 1, commands });
      await this.client.open(bytes, name, script);
      this.source = { name, bytes };
      this.dirty = false;
      const [only, ...others] = this.state!.surfaces;
      if (commands.length === 0 && only && others.length === 0) await this.client.execute(firstSettings(only));
      if (this.state!.surfaces.length > 1 && this.state!.selection.length === 0) {
        this.notify({ kind: 'info', text: `${this.state!.surfaces.length} surfaces: click the one to sculpt.` });
      }
      this.changed();
      void loadContext(this);
    });
  }

  async startFresh(name: string, commands: Command[]): Promise<true | null> {
    return this.attempt(async () => {
      this.begin();
      await this.client.fresh(name, commands);
      this.source = { name, bytes: null };
      this.dirty = false;
      this.changed();
    });
  }

  private begin(): void {
    this.fresh = true;
    this.steps = [];
    this.stepsEnd = 0;
    this.viewer.selectTool(null);
    this.viewer.showContext(null, []);
  }

  async openFile(file: File): Promise<void> {
    await this.read(file);
    ++this.filesHandled;
  }

  private async read(file: File): Promise<void> {
    const bytes = new Uint8Array(await file.arrayBuffer());
    if (/\.(knead|json)$/i.test(file.name)) {
      await this.attempt(async () => {
        const { name, source, commands } = readKnead(new TextDecoder().decode(bytes));
        if (source) await this.openStep(source, name, commands);
        else await this.startFresh(name, commands);
      });
    } else if (/\.(stp|step|p21)$/i.test(file.name)) {
      await this.openStep(bytes, file.name);
    } else {
      this.notify({ kind: 'error', text: `“${file.name}” is not a kind of file that the studio reads`,
        remedy: 'open a STEP file (.step, .stp) or a Knead document (.knead)' });
    }
  }

  async saveStep(): Promise<void> {
    await this.attempt(async () => {
      const bytes = await this.client.save();
      const stem = this.stem();
      download(new Blob([bytes.slice().buffer as ArrayBuffer], { type: 'model/step' }), `${stem}-sculpted.step`);
      const touching = this.state!.tools.filter((t) => t.plasticity < 1);
      this.notify({ kind: 'info', text: touching.length > 0 && this.state!.last !== null && this.state!.last.gap > 0
        ? 'Saved with a tool still in contact: the shape is the one it holds.'
        : 'Saved.' });
    });
  }

  async saveKnead(): Promise<void> {
    await this.attempt(async () => {
      const text = writeKnead(this.source.name, this.source.bytes, await this.client.journal());
      download(new Blob([text], { type: 'application/json' }), `${this.stem()}.knead`);
    });
  }

  async saveScript(): Promise<void> {
    await this.attempt(async () => {
      download(new Blob([await this.client.journal()], { type: 'application/json' }), `${this.stem()}.json`);
    });
  }

  async savePicture(): Promise<void> {
    await this.attempt(async () => download(await this.viewer.picture(), `${this.stem()}.png`));
  }

  private stem(): string {
    return this.source.name.replace(/\.[^.]*$/, '').replace(/[^\w.-]+/g, '_') || 'surface';
  }

  /** Something changed: it is kept in the browser as soon as the user pauses. */
  private touch(): void {
    this.dirty = true;
    delete document.documentElement.dataset.kept;
    clearTimeout(this.saveTimer);
    this.saveTimer = window.setTimeout(() => void this.keep(), autosaveDelay);
  }

  private async keep(): Promise<void> {
    if (!this.dirty || this.hand.active || this.frame?.playing) return;
    this.dirty = false;
    try {
      const journal = await this.client.journal();
      const commands = (JSON.parse(journal) as { commands: Command[] }).commands.length;
      await autosave.write({ name: this.source.name, source: this.source.bytes, journal, when: Date.now(), commands });
      document.documentElement.dataset.kept = String(commands);
    } catch (error) {
      this.notify({ kind: 'error', text: `The browser could not keep a copy: ${String(error)}`, remedy: 'save a Knead document' });
    }
  }

  async recover(saved: Saved): Promise<void> {
    const { commands } = JSON.parse(saved.journal) as { commands: Command[] };
    if (saved.source) await this.openStep(saved.source, saved.name, commands);
    else await this.startFresh(saved.name, commands);
  }

  /** Selects a surface. One that nothing was said about becomes clay with held edges: pressed, it would float away. */
  async select(surface: number): Promise<void> {
    const info = this.state!.surfaces[surface]!;
    await this.execute([{ do: 'select', surface: info.id }, ...firstSettings(info)]);
  }

  // --- tools -------------------------------------------------------------------------------------------------------

  /** What a click in the mode `place` puts into the scene. */
  readonly placing: { shape: string; surface?: string } = { shape: 'sphere' };

  /** A new tool, on the near side of the surface point. */
  async placeTool(point: THREE.Vector3, normal: THREE.Vector3): Promise<void> {
    const command = newTool(this, point, normal);
    if (await this.execute([command])) {
      this.setMode('look');
      this.viewer.selectTool(command.name as string);
      this.changed();
    }
  }

  setMode(mode: Mode): void {
    this.hand.mode = mode;
    this.changed();
  }

  // --- what is seen ------------------------------------------------------------------------------------------------

  setDisplay(change: Partial<Display>): void {
    const repaint = (change.field !== undefined && change.field !== this.display.field) || change.detail !== undefined;
    Object.assign(this.display, change);
    this.viewer.navigator.convention = this.display.convention;
    this.viewer.restyle();
    if (repaint) void this.attempt(async () => void (await this.client.paint({ detail: this.display.detail, field: this.display.field })));
    this.keepSettings();
    this.changed();
  }

  private comparing = false;

  /** While a key is held: the surfaces as they were opened. */
  compare(opened: boolean): void {
    if (!this.state || opened === this.comparing) return;
    this.comparing = opened;
    document.documentElement.dataset.comparing = String(opened);
    void this.attempt(async () => void (await this.client.paint({ detail: this.display.detail, field: this.display.field, opened })));
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
      localStorage.setItem('knead', JSON.stringify({ display: this.display, theme: this.theme }));
    } catch {
      // Without storage the settings last as long as the page.
    }
  }

  private numbers: { of: string; data: Promise<SurfaceNumbers> } | null = null;

  /** The numbers of a surface as it is now; asked for once per change. */
  surfaceData(surface: number): Promise<SurfaceNumbers> {
    const of = `${surface} ${this.changes}`;
    if (this.numbers?.of !== of) this.numbers = { of, data: this.client.surface(surface) };
    return this.numbers.data;
  }

  playing(): boolean {
    return this.frame?.playing ?? false;
  }

  togglePlay(toRest = false): void {
    void this.attempt(async () => void (await (this.playing() ? this.client.stop() : this.client.play(toRest))));
  }
}

/** Clay that is held at its edges, for a surface as it came. */
function firstSettings(surface: SurfaceInfo): Command[] {
  if (surface.hold > 0 || surface.pins > 0 || surface.constraints.length > 0 || surface.moved > 0) return [];
  const rows = Math.min(2, Math.floor((Math.min(...surface.net) - 2) / 2));
  return [...(rows > 0 ? [{ do: 'hold', rows }] : []), ...clay];
}

function readKept(): { display?: Partial<Display>; theme?: Theme } {
  try {
    return JSON.parse(localStorage.getItem('knead') ?? '{}') as { display?: Partial<Display>; theme?: Theme };
  } catch {
    return {};
  }
}

function download(blob: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
