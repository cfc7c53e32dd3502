import { execFile } from 'node:child_process';
import { mkdirSync, readdirSync, readFileSync, statSync, symlinkSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { promisify } from 'node:util';

export const root = fileURLToPath(new URL('../..', import.meta.url));
export const native = process.env.KNEAD_CLI || join(root, 'build/release/knead');
export const sample = join(root, 'samples/bonnet.step');
export const bonnet = (): Uint8Array => new Uint8Array(readFileSync(sample));

/** The newest package in out/dist. */
export function tarball(): string {
  const folder = join(root, 'out/dist');
  const found = readdirSync(folder).filter((name) => /^knead-cad-.*\.tgz$/.test(name)).map((name) => join(folder, name));
  if (found.length === 0) throw new Error('there is no package in out/dist: run make npm');
  return found.reduce((newest, name) => (statSync(name).mtimeMs > statSync(newest).mtimeMs ? name : newest));
}

/** A directory beside the installed package. */
export function directory(name: string): string {
  const path = join(process.env.KNEAD_FRESH!, name);
  mkdirSync(path, { recursive: true });
  return path;
}

export const installed = (path = ''): string => join(process.env.KNEAD_FRESH!, 'node_modules/knead-cad', path);

/** The package itself, in this process. Its types are those of its source. */
export const knead = async (entry = 'index'): Promise<typeof import('../../bindings/npm/src/index')> =>
  (await import(/* @vite-ignore */ pathToFileURL(installed(`dist/${entry}.js`)).href)) as never;

export const run = async (cwd: string, program: string, ...given: string[]): Promise<string> =>
  (await promisify(execFile)(program, given, { cwd, encoding: 'utf8', maxBuffer: 2 ** 26 })).stdout;

/** A tool of the project's, for a program in a fresh directory. */
export function lend(where: string, ...tools: string[]): void {
  mkdirSync(join(where, 'node_modules'), { recursive: true });
  for (const tool of tools) symlinkSync(join(root, 'web/node_modules', tool), join(where, 'node_modules', tool));
}
