import type { Plugin } from 'vite';

export function withoutEval(code: string, forNode?: boolean): string;
export function rhinoWithoutEval(options?: { forNode?: boolean }): Plugin;
