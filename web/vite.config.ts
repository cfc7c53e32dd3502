import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

import { rhinoWithoutEval } from './plugins/rhino_without_eval.mjs';

export default defineConfig({
  base: './',
  resolve: { alias: { '@studio': fileURLToPath(new URL('./src', import.meta.url)) } },
  // A module preload polyfill would be an inline script, a data: asset a second origin: neither passes the page's policy.
  build: { target: 'es2022', modulePreload: { polyfill: false }, assetsInlineLimit: 0, chunkSizeWarningLimit: 1200 },
  worker: { format: 'es', plugins: () => [rhinoWithoutEval()] },
});
