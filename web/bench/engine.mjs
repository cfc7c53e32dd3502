// The page's own Engine (bindings/npm/src/engine.ts), for node.
import { fileURLToPath } from 'node:url';

import { build } from 'vite';

const source = (path) => fileURLToPath(new URL(path, import.meta.url));

export async function engineClass() {
  const result = await build({
    configFile: false,
    logLevel: 'error',
    build: { write: false, minify: false, lib: { entry: source('../../bindings/npm/src/engine.ts'), formats: ['es'] } },
  });
  const code = result[0].output[0].code;
  return (await import(`data:text/javascript;base64,${Buffer.from(code).toString('base64')}`)).Engine;
}
