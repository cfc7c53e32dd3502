import type { Command } from '../engine/session_types';

const isDefaultHold = (c: Command | undefined): boolean => c?.do === 'hold' && c.mode === 'trim' && c.all === true;

/**
 * The script that does what a journal did. Scripts begin with the edges of all faces held: a journal that begins so needs not
 * say it, one that begins with a new surface has none, and any other first lets them go.
 */
export function scriptOf(journal: string): string {
  const commands = JSON.parse(journal) as Command[];
  const [first] = commands;
  const free: Command[] = first && !isDefaultHold(first) && first.do !== 'new' ? [{ do: 'hold', rows: 0, all: true }] : [];
  const lines = [...free, ...(isDefaultHold(first) ? commands.slice(1) : commands)].map((c) => `\n  ${JSON.stringify(c)}`);
  return `{"knead": 2, "commands": [${lines.join(',')}${lines.length > 0 ? '\n' : ''}]}\n`;
}
