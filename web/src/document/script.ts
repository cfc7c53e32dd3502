import type { Command } from '../engine/session_types';

const isDefaultHold = (c: Command | undefined): boolean => c?.do === 'hold' && c.mode === 'trim' && c.all === true;

/**
 * The script of a journal, in the version that does the same. Version 2 begins with the edges of all faces held: that changes
 * nothing in a document that began without a file (`fresh`), nor where the journal begins with that hold. Anything else is
 * of version 1, in which nothing is held but what the commands say.
 */
export function scriptOf(journal: string, fresh: boolean): string {
  const { commands } = JSON.parse(journal) as { commands: Command[] };
  const held = isDefaultHold(commands[0]);
  const lines = (held ? commands.slice(1) : commands).map((c) => `\n  ${JSON.stringify(c)}`);
  return `{"knead": ${fresh || held ? 2 : 1}, "commands": [${lines.join(',')}${lines.length > 0 ? '\n' : ''}]}\n`;
}
