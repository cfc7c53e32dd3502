import type { Command } from '../engine/session_types';

/** A Knead document: where the session began, and its commands (docs/studio.md). */
export interface KneadDocument {
  knead: 1;
  name: string;
  /** The STEP file as it was opened, base64; left out for a document that began empty. */
  source?: string;
  commands: Command[];
}

export function writeKnead(name: string, source: Uint8Array | null, journal: string): string {
  const { commands } = JSON.parse(journal) as { commands: Command[] };
  const lines = commands.map((c) => `  ${JSON.stringify(c)}`).join(',\n');
  const base64 = source ? `,\n"source": "${toBase64(source)}"` : '';
  return `{"knead": 1,\n"name": ${JSON.stringify(name)}${base64},\n"commands": [\n${lines}\n]}\n`;
}

/** Throws an Error whose message says what is wrong with the file. */
export function readKnead(text: string): { name: string; source: Uint8Array | null; commands: Command[] } {
  let json: Partial<KneadDocument>;
  try {
    json = JSON.parse(text) as Partial<KneadDocument>;
  } catch {
    throw new Error('this is no Knead document: it is not JSON');
  }
  if (json === null || typeof json !== 'object' || json.knead !== 1) {
    throw new Error('this is no Knead document of version 1: "knead": 1 is missing');
  }
  if (!Array.isArray(json.commands) || json.commands.some((c) => typeof c?.do !== 'string')) {
    throw new Error('the Knead document has no list of commands');
  }
  if (json.source !== undefined && typeof json.source !== 'string') throw new Error('"source" of the Knead document is no text');
  let source: Uint8Array | null = null;
  try {
    source = json.source !== undefined ? fromBase64(json.source) : null;
  } catch {
    throw new Error('"source" of the Knead document is not base64');
  }
  return { name: typeof json.name === 'string' ? json.name : 'document', source, commands: json.commands };
}

export function toBase64(bytes: Uint8Array): string {
  let text = '';
  for (let k = 0; k < bytes.length; k += 0x8000) text += String.fromCharCode(...bytes.subarray(k, k + 0x8000));
  return btoa(text);
}

export function fromBase64(text: string): Uint8Array {
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
}
