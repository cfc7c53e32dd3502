import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { type Browser, type BrowserContext, chromium, type Download, type JSHandle, type Page } from 'playwright-core';

import { Engine } from '@knead/engine';
import type { Command, Vector3 } from '@studio/engine/session_types';

export const root = fileURLToPath(new URL('../../..', import.meta.url));
export const native = process.env.KNEAD_CLI || join(root, 'build/release/knead');

interface Server {
  url: string;
  close(): Promise<void>;
}

/** The built page in a headless browser, and everything that went wrong in it. */
export interface Studio {
  browser: Browser;
  url: string;
  page: Page;
  problems: string[];
  /** Requests that left the page's own origin. */
  foreign: string[];
  close(): Promise<void>;
}

/** A server of a copy of the page, which a test may change and close. */
export async function serve(directory: string): Promise<Server> {
  const module = join(root, 'web/serve.mjs');
  return ((await import(/* @vite-ignore */ module)) as { serve(directory: string): Promise<Server> }).serve(directory);
}

interface Visit {
  width?: number;
  height?: number;
  /** The page offers its tour; otherwise it takes the visitor for one who has seen it. */
  first?: boolean;
  /** Of another build than the one that all files share. */
  server?: Server;
}

/** What tests put into the page, and what they draw by. */
interface Drawing {
  /** Whether what the page draws reaches its canvas. */
  drawing: boolean;
  studio: { viewer: { draw(): void; redraw(): void } };
}

/**
 * In the page: calls of WebGL that draw do nothing unless a test looks (`picture`, `draws`), since the processor draws here; shaders,
 * buffers and textures are made as ever. What is drawn is drawn once per pixel, not four times for smooth edges.
 */
function drawWhenLookedAt(): void {
  const page = window as never as Drawing;
  page.drawing = false;
  const canvas = HTMLCanvasElement.prototype as { getContext: (kind: string, settings?: object) => unknown };
  const made = canvas.getContext;
  canvas.getContext = function (kind, settings) {
    return made.call(this, kind, kind.startsWith('webgl') ? { ...settings, antialias: false } : settings);
  };
  const context = WebGL2RenderingContext.prototype as never as Record<string, (...rest: unknown[]) => void>;
  for (const name of ['clear', 'drawArrays', 'drawArraysInstanced', 'drawElements', 'drawElementsInstanced', 'drawRangeElements']) {
    const draw = context[name]!;
    context[name] = function (...rest) {
      if (page.drawing) draw.apply(this, rest);
    };
  }
}

/** What the driver says where the picture is not drawn by a graphics card: so it is in this browser (setup.ts). */
const readBack = /GL Driver Message \(OpenGL, Performance, .*GPU stall due to ReadPixels/;

/** A context in which nothing was done yet. */
export async function contextOf(browser: Browser, { width = 900, height = 560, first = false }: Visit = {}): Promise<BrowserContext> {
  const context = await browser.newContext({ viewport: { width, height }, acceptDownloads: true });
  if (!first) await context.addInitScript(() => localStorage.setItem('knead-tour', '1'));
  await context.addInitScript(drawWhenLookedAt);
  return context;
}

/** The page in a context of its own, so that nothing is kept from another file, in the browser of this worker. */
export async function openStudio({ width = 900, height = 560, first = false, server }: Visit = {}): Promise<Studio> {
  const browsers = process.env.STUDIO_BROWSERS!.split(' '); // setup.ts
  const browser = await chromium.connect(browsers[(Number(process.env.VITEST_POOL_ID) - 1) % browsers.length]!);
  const url = server?.url ?? process.env.STUDIO_PAGE!;
  const context = await contextOf(browser, { width, height, first });
  const page = await context.newPage();
  const problems: string[] = [];
  const foreign: string[] = [];
  page.on('console', (m) => {
    if ((m.type() === 'error' || m.type() === 'warning') && !readBack.test(m.text())) problems.push(m.text());
  });
  page.on('pageerror', (e) => problems.push(e.message));
  context.on('request', (r) => {
    if (!r.url().startsWith(url) && !r.url().startsWith('blob:')) foreign.push(r.url());
  });
  const studio: Studio = {
    browser, url, page, problems, foreign,
    close: async () => {
      await context.close();
      await browser.close(); // this end of the line alone
    },
  };
  await page.goto(url);
  await ready(page);
  return studio;
}

/**
 * The page of all tests in a file: open before the first (and not usable earlier), closed after the last. A message on the
 * console, a request to another origin, or something that cannot be drawn fails the test.
 */
export function studioOfFile(visit: Visit = {}): Studio {
  const studio = {} as Studio;
  beforeAll(async () => {
    Object.assign(studio, await openStudio(visit));
  });
  afterAll(() => studio.close());
  afterEach(async () => {
    expect(await drawingErrors(studio.page)).toBe(0);
    expect(studio.problems).toEqual([]);
    expect(studio.foreign).toEqual([]);
  });
  return studio;
}

/** A directory for the files that tests write, removed after the last of the file. */
export function directoryOfFile(): string {
  const directory = mkdtempSync(join(tmpdir(), 'knead-studio-'));
  afterAll(() => rmSync(directory, { recursive: true }));
  return directory;
}

export const ready = (page: Page) => page.waitForSelector('html[data-ready]', { state: 'attached', timeout: 60_000 });

/** From now on what the page draws is to be seen, or not. */
export const draws = (page: Page, on: boolean): Promise<void> => page.evaluate((now) => {
  const { studio } = Object.assign(window as never as Drawing, { drawing: now });
  if (now) studio.viewer.redraw();
}, on);

/** The picture of the scene, drawn now, for functions in the page: its size, and the colours of its pixels, 4 numbers each. */
export async function picture(page: Page): Promise<JSHandle<ImageData>> {
  await page.evaluate(() => {
    const it = window as never as Drawing;
    const before = it.drawing;
    it.drawing = true;
    it.studio.viewer.draw();
    it.drawing = before;
  });
  return screen(page);
}

/** What WebGL has to say of all that the page draws now: 0 for nothing. No pixel is filled. */
export const drawingErrors = (page: Page): Promise<number> => page.evaluate(() => {
  const it = window as never as Drawing;
  const context = document.querySelector<HTMLCanvasElement>('.viewer-canvas')!.getContext('webgl2')!;
  const before = it.drawing;
  context.enable(context.RASTERIZER_DISCARD);
  it.drawing = true;
  it.studio.viewer.draw();
  it.drawing = before;
  context.disable(context.RASTERIZER_DISCARD);
  return context.getError();
});

/** As `picture`, but of what the page has drawn by itself: for tests of when it draws. */
export const screen = (page: Page): Promise<JSHandle<ImageData>> => page.evaluateHandle(() => {
  const canvas = document.querySelector<HTMLCanvasElement>('.viewer-canvas')!;
  const context = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d')!;
  context.drawImage(canvas, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height);
});

/** Number of commands that stand. */
export const commands = (page: Page): Promise<Command[]> =>
  page.evaluate(async () => (JSON.parse(await (window as never as { studio: { client: { query(name: 'journal'): Promise<string> } } }).studio.client.query('journal')) as Command[]));

interface App {
  frame: { origin: number[]; pictures: { positions: Float32Array; normals: Float32Array }[]; state: { selection: number[]; undo: boolean }; memory: number };
  client: { followed(): Promise<void>; query(name: 'journal'): Promise<string>; busySince: number | null };
}

/** What the page asks before it opens something. */
export const question = (page: Page) => page.locator('dialog.question');

/** Answers what the page asks, if it does. */
async function answer(page: Page, choice = 'Open without saving'): Promise<void> {
  if (await question(page).isVisible()) await question(page).locator('button', { hasText: choice }).click();
}

/** How many files and scenes the page has opened or refused. */
export const handled = (page: Page): Promise<number> =>
  page.evaluate(() => (window as never as { studio: { documents: { handled: number } } }).studio.documents.handled);

/** Acts, and waits until the page has opened or refused what that asks for, whatever becomes of the document before. */
async function whenOpened(page: Page, act: () => Promise<void>, choice?: string): Promise<void> {
  await question(page).waitFor({ state: 'detached' }); // what was answered just now is counted when the question goes
  const before = await handled(page);
  await act();
  for (const end = Date.now() + 20_000; (await handled(page)) === before;) { // hooks may not poll by `expect`
    if (Date.now() > end) throw new Error('nothing was opened or refused within 20 s');
    await answer(page, choice);
    await page.waitForTimeout(20);
  }
  await settled(page);
}

/** Opens a scene of the gallery. */
export const scene = (page: Page, name: string): Promise<void> => whenOpened(page, async () => {
  await page.locator('summary[aria-label^=Gallery]').click();
  await page.locator('details[open] .menu-item').filter({ has: page.locator(`b:text-is("${name}")`) }).click();
});

/** Opens a file. `choice`: of what the page asks about a script. */
export const openFile = (page: Page, path: string, choice?: string): Promise<void> =>
  whenOpened(page, () => page.locator('input[aria-label="File to open"]').setInputFiles(path), choice);

/** Numbers that come out of the page as the bytes of a Float64Array: thousands of them one by one take the browser long. */
export const numbersOf = (bytes: Uint8Array): number[] => Array.from(new Float64Array(bytes.slice().buffer));

/** All positions that the page draws, file units, in one list. */
export const positions = async (page: Page): Promise<number[]> =>
  numbersOf(await page.evaluate(() => {
    const { pictures, origin } = (window as never as { studio: App }).studio.frame;
    return new Uint8Array(Float64Array.from(pictures.flatMap((p) => [...p.positions].map((x, k) => x + origin[k % 3]!))).buffer);
  }));

/** Carries out commands as the page's own buttons do, and waits until nothing is pending. */
export async function execute(page: Page, ...list: Command[]): Promise<void> {
  await page.evaluate((all) => (window as never as { studio: { execute(c: Command[]): Promise<unknown> } }).studio.execute(all), list);
  await settled(page);
}

/** Waits until the session has done everything that the page has asked for, and the page has shown it. */
export async function settled(page: Page): Promise<void> {
  await page.evaluate(async () => {
    const { studio } = window as never as { studio: App };
    // Twice in a row nothing came of it; where steps run on, frames never end.
    for (let k = 0, quiet = 0; k < 10 && quiet < 2; ++k) {
      const before = studio.frame;
      await studio.client.followed();
      await studio.client.query('journal');
      await new Promise(requestAnimationFrame);
      quiet = studio.frame === before && studio.client.busySince === null ? quiet + 1 : 0;
    }
  });
}

/** Middle of the perspective view, moved by pixels. */
export async function spot(page: Page, dx = 0, dy = 0): Promise<[number, number]> {
  const box = (await page.locator('.view-perspective').boundingBox())!;
  return [box.x + box.width / 2 + dx, box.y + box.height / 2 + dy];
}

export async function stroke(page: Page, ...places: [number, number][]): Promise<void> {
  await page.mouse.move(...(await spot(page, ...places[0]!)));
  await page.mouse.down();
  for (const place of places) {
    await page.mouse.move(...(await spot(page, ...place)), { steps: 3 });
    await page.waitForTimeout(40);
  }
  await page.mouse.up();
  await settled(page);
}

/** One drag from a place of the middle view to another, by so many moves of the pointer. */
export async function drag(page: Page, from: [number, number], to: [number, number], moves: number): Promise<void> {
  await page.mouse.move(...(await spot(page, ...from)));
  await page.mouse.down();
  await page.mouse.move(...(await spot(page, ...to)), { steps: moves });
  await page.mouse.up();
  await settled(page);
}

export const distance = (a: number[], b: number[]): number =>
  a.length === b.length ? a.reduce((most, x, k) => Math.max(most, Math.abs(x - b[k]!)), 0) : Infinity;

/** Saves the document by an entry of the page's menu into a directory, under the name that the page gives it. */
export async function saveAs(page: Page, directory: string, entry: string): Promise<string> {
  await page.locator('summary[aria-label=Save]').click();
  const item = page.locator('details[open] .menu-item').filter({ has: page.locator(`b:text-is("${entry}")`) });
  const [download] = await Promise.all([page.waitForEvent('download'), item.click()]);
  const path = join(directory, download.suggestedFilename());
  await download.saveAs(path);
  return path;
}

/** A STEP file as the engine reads it. */
export async function engineOf(path: string): Promise<Engine> {
  const engine = await Engine.load(readFileSync(join(root, 'web/src/engine/knead_studio.wasm')));
  engine.query('open', { file: new Uint8Array(readFileSync(path)), name: basename(path) });
  return engine;
}

/** The points at which an engine draws its first surface, in so many lines per direction; file units. */
export function drawnBy(engine: Engine, detail: number): Vector3[] {
  const { positions: drawn } = engine.query('picture', { surface: 0, detail });
  const origin = engine.query('origin');
  return Array.from({ length: drawn.length / 3 }, (_, k) => [0, 1, 2].map((d) => drawn[3 * k + d]! + origin[d]!) as Vector3);
}

/** The text of a file that the page gave away. */
export async function downloaded(download: Download): Promise<string> {
  let text = '';
  for await (const part of await download.createReadStream()) text += String(part);
  return text;
}
