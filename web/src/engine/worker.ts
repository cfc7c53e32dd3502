import { type DisplayRange, noValue, plain } from './displays';
import { type Asked, Engine, type Query } from '@knead/engine';
import coreUrl from './knead_core.wasm?url';
import restUrl from './knead_rest.wasm?url';
import type { PictureSettings, Reply, Request } from './protocol';
import { Preparation } from './preparation';
import { Rest } from './rest';
import { type Command, KneadError, type EngineErrorInfo, errorOf, type Picture, type SessionInfo, type ToolInfo, type ToolPicture } from './session_types';
import { Standing } from './standing';
import { rehearse } from './strokes';
import { trimTree } from './trim_tree';

/** The one place where the session lives. It works through the requests in order and draws what it has changed. */

const rest = new Rest(() => new WebAssembly.Module(fetchNow(restUrl)));
const core = WebAssembly.compileStreaming(fetch(coreUrl));
const engineLoaded = core.then((module) => Engine.load(module, rest)).then((engine) => {
  engine.onProgress = tellProgress;
  return engine;
});

const preparation = new Preparation(core, () => new Worker(new URL('./warm_up.ts', import.meta.url), { type: 'module' }), async () => {
  const engine = await engineLoaded;
  try {
    if (playing !== 'no' || !hasSession(engine)) return false;
    rehearse(engine);
  } catch (error) {
    died(error);
  }
  return true;
});
const works = new Set<Request['kind'] | Query>(['open', 'fresh', 'restore', 'execute', 'play', 'save', 'file']);

/** While the C++ session waits for it. */
function fetchNow(url: string): ArrayBuffer {
  const request = new XMLHttpRequest();
  request.open('GET', url, false);
  request.responseType = 'arraybuffer';
  request.send();
  if (request.status !== 200) throw new Error(`${url} could not be fetched: ${request.status} ${request.statusText}`);
  return request.response as ArrayBuffer;
}

const restAfter = 4000; // milliseconds: what the page shows first comes first
void engineLoaded.then(() => setTimeout(() => {
  if (!rest.started) WebAssembly.compileStreaming(fetch(restUrl)).then((module) => rest.provide(module), () => undefined); // a call fetches it again
}, restAfter));
let settings: PictureSettings = { detail: 96, display: plain };
/** Nothing has changed since the page asked for pictures: what it sees from nearby is drawn finely. */
let resting = false;
let playing: 'no' | 'on' | 'toRest' = 'no';
let ownEntry = false; // the steps of this play have begun their history entry
let frameDrawn = true;
let frameDue = false;
let shownSteps = 0;
let computeTime = 0;
let unkept = 0;
let quietSteps = 0;
const standing = new Standing();
let opened = 0; // commands that belong to the opened document
const historyBytes = 48 * 2 ** 20; // of memory of states that the session before keeps where another cannot be opened

/** What can be handed over instead of copied. */
const buffersOf = (answer: unknown): ArrayBuffer[] =>
  (ArrayBuffer.isView(answer) ? [answer] : typeof answer === 'object' ? Object.values(answer ?? {}) : []).filter(ArrayBuffer.isView).map((view) => view.buffer as ArrayBuffer);

const post = (reply: Reply, transfer: Transferable[] = []) => self.postMessage(reply, { transfer });

function errorInfo(error: unknown): EngineErrorInfo {
  if (error instanceof KneadError) return error.info;
  const message = error instanceof Error ? error.message : String(error);
  return errorOf('internal', message, 'save what you can and reload the page');
}

/** What the engine refuses is an `KneadError`; anything else has stopped it half-way. The page ends this worker then. */
function died(error: unknown): boolean {
  if (error instanceof KneadError) return false;
  post({ kind: 'died', message: String(error) });
  return true;
}

/** What a tool does and where it is; the rest of its fields is its shape. */
const besideShape = new Set(['name', 'mode', 'stiffness', 'range', 'rigid', 'friction', 'plasticity', 'direction', 'position', 'rotation', 'scale', 'size']);
let shownShapes = new Map<string, string>(); // by the names of the tools of the last frame

/** Pictures of the shapes that the page does not have yet. */
function newToolPictures(engine: Engine, tools: readonly ToolInfo[]): Record<string, ToolPicture> {
  const shapes = new Map(tools.map((tool) => [tool.name, JSON.stringify(Object.entries(tool).filter(([field]) => !besideShape.has(field)))]));
  const pictures = Object.fromEntries(tools.flatMap(({ name }, k) =>
    (shapes.get(name) === shownShapes.get(name) ? [] : [[name, engine.query('tool_picture', { tool: k })]])));
  shownShapes = shapes;
  return pictures;
}

const between = 200; // milliseconds from one report of many steps to the next
const many = 100;
let told = 0;

/** How far the command is: from within it, while nothing else can be said. */
function tellProgress(done: number, total: number): void {
  const now = performance.now();
  if (total > many && now - told < between) return;
  told = now;
  post({ kind: 'progress', done, total });
}

const travels = (command: Command) => command.do === 'undo' || command.do === 'redo';

function execute(engine: Engine, commands: Command[], join: boolean, keep = false): void {
  const start = performance.now();
  told = start;
  resting = false;
  try {
    if (commands.length > 0) engine.query('act', { commands, join, keep });
  } finally {
    if (commands.some(travels)) shownSteps = 0; // the steps are others now
    computeTime = performance.now() - start;
    unkept += computeTime;
  }
}

/** What the present session began with, for going back to it. */
let source: { bytes: Uint8Array; name: string } | null = null;

/** The page does not know yet where the parts of the session stand. */
let assemblyDue = false;

const restore = (engine: Engine, from: typeof source, name: string, snapshot: Uint8Array) =>
  engine.query('restore', { ...(from ? { source: from.bytes } : {}), name: from?.name ?? name, snapshot });

/** Begins another session; where that fails the one before goes on. */
function begin(engine: Engine, next: typeof source, act: () => void): void {
  stopPlaying(engine);
  resting = false; // windows and colours are those of the document before
  kept = null;
  const before = hasSession(engine) ? { snapshot: engine.query('snapshot', { history_bytes: historyBytes }), source, opened, name: engine.query('state').name } : null;
  try {
    act();
  } catch (error) {
    if (before && error instanceof KneadError) {
      restore(engine, before.source, before.name, before.snapshot);
      opened = engine.query('begin_history', { commands: before.opened });
    }
    throw error;
  }
  source = next;
  standing.renew(engine.query('state'));
  preparation.renew();
  frameDrawn = true; // what the page has not drawn yet is of the session before: this one is on the page when it is asked about
  assemblyDue = true;
  shownSteps = 0;
}

/** As `Frame.moved`. */
function movedBy(engine: Engine, { selection, surfaces, tools, last }: SessionInfo): number {
  if (playing !== 'no' || tools.some((tool) => tool.name === 'brush')) return last?.largest_displacement ?? 0;
  const moved = selection.filter((k) => surfaces[k]!.moved > 0);
  return moved.flatMap((k) => [...engine.query('picture', { surface: k, detail: settings.detail, display: 'deviation' }).values])
    .reduce((most, x) => Math.max(most, Math.abs(x)), 0);
}

/** Names of the displays that take longer than a frame may, once asked for; and what one last gave. */
let slowDisplays: Set<string> | null = null;
let kept: { display: string; values: Float32Array[]; range: DisplayRange | null } | null = null;

/** All surfaces, and where their colours end. While something moves, slow colours stay as they were, and are late. */
function picturesOf(engine: Engine, state: SessionInfo): { pictures: Picture[]; range: DisplayRange | null; late: boolean } {
  const { display, detail, opened } = settings;
  slowDisplays ??= new Set(engine.query('displays').filter((d) => d.sees_model).map((d) => d.name));
  const slow = slowDisplays.has(display.display);
  const late = slow && !resting;
  const pictures = state.surfaces.map((_, surface) => {
    const window = resting ? settings.windows?.[surface] : null;
    return engine.query('picture', { surface, detail, ...(late ? plain : display), opened, ...(window ? { window } : {}) });
  });
  if (!slow) return { pictures, range: engine.query('range'), late };
  const asked = JSON.stringify(display);
  if (!late) {
    kept = { display: asked, values: pictures.map((p) => p.values.slice()), range: engine.query('range') };
    return { pictures, range: kept.range, late };
  }
  const known = kept?.display === asked ? kept : null;
  pictures.forEach((p, k) => {
    const size = p.counts[0] * p.counts[1];
    const before = known?.values[k];
    p.values = before?.length === size ? before.slice() : new Float32Array(size).fill(noValue);
  });
  return { pictures, range: known?.range ?? null, late };
}

/** Sends the present state, or notes that it is due if the page has not drawn the one before. */
function sendFrame(engine: Engine): void {
  if (!frameDrawn) {
    frameDue = true;
    return;
  }
  frameDue = false;
  const start = performance.now();
  const state = engine.query('state');
  const { pictures, range, late } = picturesOf(engine, state);
  const { combs: asked, sectionCombs = [] } = settings;
  const combs = state.selection.flatMap((k) => [
    ...(asked ? [engine.query('combs', { surface: k, ...asked })] : []),
    ...sectionCombs.map((plane) => engine.query('section_combs', { surface: k, plane })),
  ]);
  const bodies = state.bodies.map((_, body) => engine.query('body_picture', { body }));
  const lattice = settings.lattice && state.selection.length > 0 ? engine.query('lattice_picture', settings.lattice) : null;
  const toolPictures = newToolPictures(engine, state.tools);
  if (state.steps < shownSteps) shownSteps = 0;
  const firstStep = Math.max(shownSteps, state.steps - 400);
  const steps = engine.query('steps', { first: firstStep });
  shownSteps = state.steps;
  frameDrawn = false;
  const shapes = state.body !== null ? [bodies[state.body]!.points] : state.selection.map((k) => pictures[k]!.net);
  const frame = {
    state, stands: standing.stands(state, settings.opened ? null : shapes), pictures, range, late, combs, bodies, lattice, toolPictures, firstStep, steps, origin: engine.query('origin'), playing: playing !== 'no', moved: movedBy(engine, state),
    computeTime, pictureTime: performance.now() - start, memory: engine.memorySize, unkept,
    ...(assemblyDue ? { assembly: engine.query('assembly') } : {}),
  };
  assemblyDue = false;
  post(
    { kind: 'frame', frame },
    [...pictures, ...combs, ...bodies, lattice, ...Object.values(toolPictures)].flatMap(buffersOf),
  );
}

/** Steps that have moved nothing are no entry of the history. */
function stopPlaying(engine: Engine): void {
  if (playing !== 'no' && ownEntry) engine.query('drop_unchanged');
  playing = 'no';
}

function playOn(engine: Engine): void {
  if (playing === 'no') return;
  if (!frameDrawn) return; // `drawn` calls this again
  try {
    execute(engine, [{ do: 'step' }], ownEntry, true);
    ownEntry = true;
    const last = engine.query('state').last;
    if (playing === 'toRest' && last) {
      quietSteps = last.residual < 1e-4 ? quietSteps + 1 : 0;
      if (quietSteps >= 2) stopPlaying(engine);
    }
  } catch (error) {
    if (died(error)) return;
    stopPlaying(engine);
    post({ kind: 'failed', id: 0, error: errorInfo(error) });
  }
  sendFrame(engine);
}

async function handle(engine: Engine, id: number, request: Request): Promise<void> {
  switch (request.kind) {
    case 'open':
    case 'fresh': {
      computeTime = 0;
      const start = performance.now();
      const { commands, opened: opening = commands.length } = request;
      begin(engine, request.kind === 'open' ? { bytes: request.bytes, name: request.name } : null, () => {
        if (request.kind === 'open') engine.query('open', { file: request.bytes, name: request.name });
        else engine.query('fresh', { name: request.name });
        for (const command of commands.slice(0, opening)) engine.execute(command);
        opened = engine.query('begin_history');
        for (const command of commands.slice(opening)) engine.execute(command);
      });
      unkept = performance.now() - start;
      sendFrame(engine);
      break;
    }
    case 'execute':
      // A command from outside ends the entry that playing has begun.
      if (!request.join) ownEntry = false;
      execute(engine, request.commands, request.join);
      if (request.opening) opened = engine.query('begin_history');
      sendFrame(engine);
      break;
    case 'pictures':
      settings = request.settings;
      resting = playing === 'no';
      if (hasSession(engine)) sendFrame(engine);
      break;
    case 'play':
      engine.query('state');
      playing = request.toRest ? 'toRest' : 'on';
      ownEntry = false;
      quietSteps = 0;
      playOn(engine);
      break;
    case 'stop':
      stopPlaying(engine);
      sendFrame(engine);
      break;
    case 'drawn':
      frameDrawn = true;
      if (frameDue) sendFrame(engine);
      else setTimeout(() => playOn(engine), 0);
      return;
    case 'context': {
      const context = engine.query('context');
      const trims = engine.query('state').surfaces.map((_, surface) => {
        const trim = engine.query('trims', { surface });
        return trim && { ...trim, tree: trimTree(trim)! };
      });
      post({ kind: 'done', id, answer: { context, trims } }, [context, ...trims.map((t) => t?.tree)].flatMap(buffersOf));
      return;
    }
    case 'query': {
      const answer = engine.query(request.query, ...([request.request] as Asked<Query>));
      post({ kind: 'done', id, answer }, buffersOf(answer));
      return;
    }
    case 'restore': {
      const from = request.source && { bytes: request.source, name: request.name };
      begin(engine, from, () => {
        restore(engine, from, request.name, request.snapshot);
        opened = engine.query('begin_history', { commands: request.opened });
      });
      computeTime = unkept = 0;
      sendFrame(engine);
      break;
    }
    case 'snapshot': {
      const journal = engine.query('journal');
      const snapshot = engine.query('snapshot', { history_bytes: request.historyBytes });
      if (request.kept) unkept = 0;
      post({ kind: 'done', id, answer: { snapshot, journal, opened } }, buffersOf({ snapshot }));
      return;
    }
  }
  post({ kind: 'done', id });
}

function hasSession(engine: Engine): boolean {
  try {
    engine.query('state');
    return true;
  } catch {
    return false;
  }
}

self.onmessage = async (event: MessageEvent<{ id: number; request: Request }>) => {
  const { id, request } = event.data;
  const engine = await engineLoaded;
  preparation.interrupt(works.has(request.kind === 'query' ? request.query : request.kind));
  try {
    await handle(engine, id, request);
  } catch (error) {
    if (died(error)) return;
    post({ kind: 'failed', id, error: errorInfo(error) });
    if (hasSession(engine)) sendFrame(engine); // part of an act may have taken effect
  }
  preparation.interrupt(false);
};

/** A browser that ends a worker tells nobody; its locks are free then. */
async function live(): Promise<string> {
  const lock = `knead engine ${Math.random()}`;
  if (!navigator.locks) return '';
  await new Promise<void>((held) => void navigator.locks.request(lock, () => {
    held();
    return new Promise(() => {});
  }));
  return lock;
}

engineLoaded.then(
  async (engine) => post({ kind: 'ready', displays: engine.query('displays'), lock: await live() }),
  (error) => post({ kind: 'failed', id: 0, error: errorInfo(error) }),
);
