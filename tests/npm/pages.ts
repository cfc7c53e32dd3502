import { readFileSync } from 'node:fs';
import { createServer, type IncomingMessage, type ServerResponse } from 'node:http';
import type { AddressInfo } from 'node:net';
import { extname, join } from 'node:path';

import { type Browser, type BrowserContext, chromium, type Page } from 'playwright-core';

import { sample } from './support';

// Pages of a fresh directory in a browser.

const types: Record<string, string> = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.step': 'model/step' };

export interface Site {
  url: string;
  /** Of every answer, by path. */
  headers: (path: string) => Record<string, string>;
  close(): Promise<void>;
}

/** Serves a directory, and the sample as /bonnet.step; what is not there is a page, as of many hosts, but under /none/ a 404. */
export async function serve(directory: string): Promise<Site> {
  const site: Site = { url: '', headers: () => ({}), close: () => new Promise((closed) => { server.close(() => closed()); server.closeAllConnections(); }) };
  const answer = ({ url }: IncomingMessage, response: ServerResponse) => {
    const path = new URL(url!, 'http://here').pathname;
    if (path.startsWith('/none/')) return void response.writeHead(404).end('not here');
    try {
      const body = readFileSync(path === '/bonnet.step' ? sample : join(directory, path));
      response.writeHead(200, { 'content-type': types[extname(path)] ?? 'application/octet-stream', ...site.headers(path) }).end(body);
    } catch {
      response.writeHead(200, { 'content-type': 'text/html', ...site.headers(path) }).end('<!doctype html>\n<title>Welcome</title>');
    }
  };
  const server = createServer(answer);
  await new Promise<void>((listening) => server.listen(0, '127.0.0.1', listening));
  site.url = `http://127.0.0.1:${(server.address() as AddressInfo).port}`;
  return site;
}

export const launch = (): Promise<Browser> => chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'],
});

/** A page, and the requests that leave its own origin, which must be none. */
export async function visit(context: BrowserContext, url: string): Promise<{ page: Page; foreign: string[] }> {
  const page = await context.newPage();
  const foreign: string[] = [];
  page.on('request', (request) => {
    const asked = request.url();
    if (!asked.startsWith(new URL(url).origin) && !/^(blob|data):/.test(asked)) foreign.push(asked);
  });
  await page.goto(url);
  return { page, foreign };
}

/** What a program says at its end, by `globalThis.result`. */
export async function result<T = unknown>(page: Page, timeout = 60_000): Promise<T> {
  const said = await page.waitForFunction(() => (globalThis as { result?: unknown }).result, null, { timeout });
  return (await said.jsonValue()) as T;
}

/** A file sculpted with the package from `entry`. */
export const program = (entry: string, after = ''): string => `import { open, KneadError } from '${entry}';
try {
  const bytes = new Uint8Array(await (await fetch('/bonnet.step')).arrayBuffer());
  const doc = await open(bytes, { name: 'bonnet.step' });
  await doc.select('#285').hold({ mode: 'position' });
  await doc.tool({ name: 'ball', radius: 160, at: [0.4, 0.5] });
  await doc.step(5);
  const out = await doc.save();
  const told = { begins: new TextDecoder().decode(out.subarray(0, 13)), moved: (await doc.report).control_points_moved };
  ${after}
  globalThis.result = told;
} catch (error) {
  globalThis.result = { failed: String(error), known: error instanceof KneadError };
}
`;

export const done = { begins: 'ISO-10303-21;', moved: 309 };
