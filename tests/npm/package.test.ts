import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';

import { installed, tarball } from './support';

// What the package is made of.

const dist = () => readdirSync(installed('dist'));
const text = (name: string) => readFileSync(installed(`dist/${name}`), 'utf8');

it('is at most 4.5 MB, and has every file that it names', () => {
  expect(statSync(tarball()).size).toBeLessThan(4.5e6);
  const { exports, version } = JSON.parse(readFileSync(installed('package.json'), 'utf8')) as { exports: Record<string, string | Record<string, string>>; version: string };
  expect(version).toMatch(/^[1-9]|^0\.[1-9]/);
  for (const files of Object.values(exports)) for (const file of typeof files === 'string' ? [files] : Object.values(files)) statSync(join(installed(), file));
  expect(readdirSync(installed()).sort()).toEqual(['LICENSE', 'README.md', 'dist', 'package.json']);
});

it('asks for no module of Node but in the entry that is for Node', () => {
  const scripts = dist().filter((name) => name.endsWith('.js'));
  expect(scripts.length).toBeGreaterThan(5);
  expect(scripts.filter((name) => /\b(from|import|require)\s*\(?\s*["']node:/.test(text(name)))).toEqual(['worker_node.js']);
});

it('has the engine once in its scripts', () => {
  const large = dist().filter((name) => name.endsWith('.js') && statSync(installed(`dist/${name}`)).size > 1e6);
  expect(large.length).toBe(1);
  for (const name of ['lean', 'thread']) expect(text(`${name}.js`)).not.toContain(large[0]!);
});

it('hides what is its own from types', () => {
  expect(text('document.d.ts')).not.toMatch(/\bask\b|runUntil|\bwork\(/);
});
