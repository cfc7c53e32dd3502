import { plain } from './displays';
import { Engine } from './engine';
import wasmUrl from './knead_studio.wasm?url';
import type { PictureSettings, Reply, Request } from './protocol';
import { type Command, EngineError, type EngineErrorInfo, type ToolInfo, type ToolPicture } from './session_types';

/** The one place where the session lives. It works through the requests in order and draws what it has changed. */

const engineLoaded = Engine.load(fetch(wasmUrl));
let settings: PictureSettings = { detail: 96, display: plain };
let playing: 'no' | 'on' | 'toRest' = 'no';
let ownEntry = false; // the steps of this play have begun their history entry
let frameDrawn = true;
let frameDue = false;
let shownSteps = 0;
let computeTime = 0;
let unkept = 0;
let quietSteps = 0;

const post = (reply: Reply, transfer: Transferable[] = []) => self.postMessage(reply, { transfer });

function errorInfo(error: unknown): EngineErrorInfo {
  if (error instanceof EngineError) return error.info;
  const message = error instanceof Error ? error.message : String(error);
  return { kind: 'internal', what: message, where: '', remedy: 'save what you can and reload the page', message };
}

/** What a tool does and where it is; the rest of its fields is its shape. */
const besideShape = new Set(['name', 'mode', 'stiffness', 'range', 'rigid', 'friction', 'plasticity', 'direction', 'position', 'rotation', 'scale', 'size']);
let shownShapes = new Map<string, string>(); // by the names of the tools of the last frame

/** Pictures of the shapes that the page does not have yet. */
function newToolPictures(engine: Engine, tools: readonly ToolInfo[]): Record<string, ToolPicture> {
  const shapes = new Map(tools.map((tool) => [tool.name, JSON.stringify(Object.entries(tool).filter(([field]) => !besideShape.has(field)))]));
  const pictures = Object.fromEntries(tools.flatMap(({ name }, k) =>
    (shapes.get(name) === shownShapes.get(name) ? [] : [[name, engine.toolPicture(k)]])));
  shownShapes = shapes;
  return pictures;
}

/** Goes through the history instead of adding to it: nothing can be joined with it. */
const travels = (command: Command) => command.do === 'undo' || command.do === 'redo';

function execute(engine: Engine, commands: Command[], join: boolean): void {
  const start = performance.now();
  try {
    for (const [k, command] of commands.entries()) {
      const joined = k === 0 ? join : !travels(commands[k - 1]!);
      engine.execute(command, joined && !travels(command));
      if (travels(command)) shownSteps = 0; // the steps are others now
    }
  } finally {
    computeTime = performance.now() - start;
    unkept += computeTime;
  }
}

/** Sends the present state, or notes that it is due if the page has not drawn the one before. */
function sendFrame(engine: Engine): void {
  if (!frameDrawn) {
    frameDue = true;
    return;
  }
  frameDue = false;
  const start = performance.now();
  const state = engine.state();
  const pictures = state.surfaces.map((_, k) => engine.picture(k, settings.detail, settings.display, settings.opened));
  const toolPictures = newToolPictures(engine, state.tools);
  if (state.steps < shownSteps) shownSteps = 0;
  const firstStep = Math.max(shownSteps, state.steps - 400);
  const steps = engine.steps(firstStep);
  shownSteps = state.steps;
  frameDrawn = false;
  const frame = {
    state, pictures, toolPictures, firstStep, steps, origin: engine.origin, playing: playing !== 'no',
    computeTime, pictureTime: performance.now() - start, memory: engine.memorySize, unkept,
  };
  post(
    { kind: 'frame', frame },
    [
      ...pictures.flatMap((p) => [p.positions, p.normals, p.values, p.s, p.t, p.linesU, p.linesV, p.net, p.held]),
      ...Object.values(toolPictures).flatMap((p) => [p.positions, p.normals, p.indices]),
    ].map((a) => a.buffer as ArrayBuffer),
  );
}

function playOn(engine: Engine): void {
  if (playing === 'no') return;
  if (!frameDrawn) return; // `drawn` calls this again
  try {
    execute(engine, [{ do: 'step' }], ownEntry);
    ownEntry = true;
    const last = engine.state().last;
    if (playing === 'toRest' && last) {
      quietSteps = last.residual < 1e-4 ? quietSteps + 1 : 0;
      if (quietSteps >= 2) playing = 'no';
    }
  } catch (error) {
    playing = 'no';
    post({ kind: 'failed', id: 0, error: errorInfo(error) });
  }
  sendFrame(engine);
}

async function handle(engine: Engine, id: number, request: Request): Promise<void> {
  switch (request.kind) {
    case 'open':
    case 'fresh': {
      playing = 'no';
      shownSteps = 0;
      computeTime = 0;
      const start = performance.now();
      if (request.kind === 'open') engine.openStep(request.bytes, request.name);
      else engine.fresh(request.name);
      const commands =
        request.kind === 'fresh' ? request.commands
        : request.script ? (JSON.parse(request.script) as { commands: Command[] }).commands
        : [];
      for (const command of commands) engine.execute(command);
      unkept = performance.now() - start;
      sendFrame(engine);
      break;
    }
    case 'execute':
      // A command from outside ends the entry that playing has begun.
      if (!request.join) ownEntry = false;
      execute(engine, request.commands, request.join);
      sendFrame(engine);
      break;
    case 'pictures':
      settings = request.settings;
      if (hasSession(engine)) sendFrame(engine);
      break;
    case 'play':
      engine.state();
      playing = request.toRest ? 'toRest' : 'on';
      ownEntry = false;
      quietSteps = 0;
      playOn(engine);
      break;
    case 'stop':
      playing = 'no';
      sendFrame(engine);
      break;
    case 'drawn':
      frameDrawn = true;
      if (frameDue) sendFrame(engine);
      else setTimeout(() => playOn(engine), 0);
      return;
    case 'context': {
      const context = engine.context();
      const text = JSON.stringify(engine.state().surfaces.map((_, k) => engine.trims(k)));
      post({ kind: 'done', id, context, text },
        context ? [context.positions, context.normals, context.indices].map((a) => a.buffer as ArrayBuffer) : []);
      return;
    }
    case 'room':
      post({ kind: 'done', id, text: JSON.stringify(engine.room(request.surface)) });
      return;
    case 'save':
      post({ kind: 'done', id, bytes: engine.save(), text: JSON.stringify(engine.edges()) });
      return;
    case 'mesh':
      post({ kind: 'done', id, bytes: engine.mesh(request.format, request.detail) });
      return;
    case 'restore':
      engine.restore(request.source, request.name, request.snapshot);
      playing = 'no';
      shownSteps = computeTime = unkept = 0;
      sendFrame(engine);
      break;
    case 'snapshot': {
      const text = engine.journal();
      const bytes = engine.snapshot(request.historyBytes);
      if (request.kept) unkept = 0;
      post({ kind: 'done', id, bytes, text }, [bytes.buffer as ArrayBuffer]);
      return;
    }
    case 'surface':
      post({ kind: 'done', id, text: JSON.stringify(engine.surface(request.surface)) });
      return;
    case 'material':
      post({ kind: 'done', id, material: engine.material(request.surface, request.counts) });
      return;
    case 'journal':
      post({ kind: 'done', id, text: engine.journal() });
      return;
  }
  post({ kind: 'done', id });
}

function hasSession(engine: Engine): boolean {
  try {
    engine.state();
    return true;
  } catch {
    return false;
  }
}

self.onmessage = async (event: MessageEvent<{ id: number; request: Request }>) => {
  const { id, request } = event.data;
  const engine = await engineLoaded;
  try {
    await handle(engine, id, request);
  } catch (error) {
    post({ kind: 'failed', id, error: errorInfo(error) });
    if (hasSession(engine)) sendFrame(engine); // part of an act may have taken effect
  }
};

engineLoaded.then(
  (engine) => post({ kind: 'ready', displays: engine.displays() }),
  (error) => post({ kind: 'failed', id: 0, error: errorInfo(error) }),
);
