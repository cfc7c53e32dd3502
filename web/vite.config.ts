import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

import { offline } from './plugins/offline.mjs';
import { rhinoWithoutEval } from './plugins/rhino_without_eval.mjs';

export default defineConfig({
  base: './',
  resolve: { alias: { '@knead': fileURLToPath(new URL('../bindings/npm/src', import.meta.url)), '@studio': fileURLToPath(new URL('./src', import.meta.url)) } },
  // A module preload polyfill would be an inline script, a data: asset a second origin: neither passes the page's policy.
  plugins: [offline({ lazy: /rhino/ })],
  build: {
    rollupOptions: {
      input: { index: fileURLToPath(new URL('index.html', import.meta.url)), 'service-worker': fileURLToPath(new URL('src/app/offline/service_worker.ts', import.meta.url)) },
      output: { entryFileNames: (chunk) => (chunk.name === 'service-worker' ? '[name].js' : 'assets/[name]-[hash].js') },
    },
    target: 'es2022', modulePreload: { polyfill: false }, assetsInlineLimit: 0, chunkSizeWarningLimit: 1200,
  },
  worker: { format: 'es', plugins: () => [rhinoWithoutEval()] },
});
