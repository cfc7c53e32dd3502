import type { Plugin } from 'vite';

export function offline(options: { lazy: RegExp }): Plugin;
