import { readdirSync, readFileSync } from 'node:fs';
import { dirname, join, normalize, relative } from 'node:path';

/** The folders of the page's code, from the ground up. A file may import its own folder and those before it. */
export const layers = ['engine', 'document', 'view', 'tools', 'panels', 'app'] as const;

/** Imports of any kind, workers, and re-exports; not those in comments. */
const imported = /(?:\bfrom\s*|\bimport\s*\(\s*|\bimport\s+|\bnew\s+URL\(\s*)(['"])(\.[^'"]*)\1/g;

/** Per file the files of the same tree that it imports. Paths relative to `root`, with slashes. */
export type Imports = ReadonlyMap<string, readonly string[]>;

const withoutComments = (text: string): string => text.replace(/\/\*[\s\S]*?\*\//g, '').replace(/(^|\s)\/\/.*$/gm, '$1');

export function importsBelow(root: string): Imports {
  const files = readdirSync(root, { recursive: true, encoding: 'utf8' }).filter((f) => /\.ts$/.test(f)).sort();
  const known = new Set(files);
  return new Map(files.map((file) => {
    const text = withoutComments(readFileSync(join(root, file), 'utf8'));
    const targets = [...text.matchAll(imported)].map(([, , name]) => relative(root, normalize(join(root, dirname(file), name!.replace(/\?.*$/, '')))));
    return [file, [...new Set(targets.map((t) => (known.has(t) ? t : `${t}.ts`)).filter((t) => known.has(t)))]];
  }));
}

const layerOf = (file: string): number => layers.indexOf(file.split('/')[0] as (typeof layers)[number]);

/** Files outside of every layer, and imports of a layer by one below it. */
export function wrongImports(imports: Imports): string[] {
  const wrong: string[] = [];
  for (const [file, targets] of imports) {
    if (layerOf(file) < 0) wrong.push(`${file}: the file stands outside of every layer`);
    else for (const t of targets) if (layerOf(t) > layerOf(file)) wrong.push(`${file}: the layer ${layers[layerOf(file)]} must not import ${t}, which is built on it`);
  }
  return wrong;
}

/** Groups of files that import each other in a circle: the strongly connected components of more than one file (Tarjan). */
export function cycles(imports: Imports): string[][] {
  const index = new Map<string, number>(), low = new Map<string, number>();
  const stack: string[] = [];
  const found: string[][] = [];
  const visit = (file: string): void => {
    index.set(file, index.size);
    low.set(file, index.get(file)!);
    stack.push(file);
    for (const target of imports.get(file) ?? []) {
      if (!index.has(target)) {
        visit(target);
        low.set(file, Math.min(low.get(file)!, low.get(target)!));
      } else if (stack.includes(target)) low.set(file, Math.min(low.get(file)!, index.get(target)!));
    }
    if (low.get(file) !== index.get(file)) return;
    const group = stack.splice(stack.indexOf(file));
    if (group.length > 1 || imports.get(file)?.includes(file)) found.push(group.sort());
  };
  for (const file of imports.keys()) if (!index.has(file)) visit(file);
  return found;
}
