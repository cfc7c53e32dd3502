import type { Command } from '../engine/session_types';
import { fromBase64, toBase64 } from './base64';
import { readViews, type SavedView } from './saved_views';

/** A file that a session began with. */
export interface Source {
  kind: 'step' | 'rhino';
  name: string;
  bytes: Uint8Array;
}

/** A Knead document: where the session began, its commands, and its state (docs/knead-document.md). */
export interface KneadDocument {
  name: string;
  source: Source | null;
  commands: Command[];
  /** Commands alone. */
  script: boolean;
  /** The session as bytes; what it holds follows from source and commands, but takes no computing. */
  snapshot: Uint8Array | null;
  /** What the user wants to see again. */
  views: SavedView[];
}

/** The versions that are read and written: of documents, and of scripts. */
const documentVersion = 3, scriptVersion = 2;

export function writeKnead({ journal, ...rest }: { name: string; source: Source | null; journal: string; snapshot?: Uint8Array | null; views?: readonly SavedView[] }): string {
  return documentOf({ ...rest, commands: JSON.parse(journal) as Command[] }, documentVersion);
}

export function documentOf(
  { name, source, commands, snapshot, views = [] }: { name: string; source: Source | null; commands: readonly Command[]; snapshot?: Uint8Array | null; views?: readonly SavedView[] },
  version: number,
): string {
  const lines = commands.map((c) => `  ${JSON.stringify(c)}`).join(',\n');
  return [
    `{"knead": ${version}`,
    `"name": ${JSON.stringify(name)}`,
    ...(source ? [`"source": {"kind": "${source.kind}", "name": ${JSON.stringify(source.name)}, "bytes": "${toBase64(source.bytes)}"}`] : []),
    `"commands": [${lines && `\n${lines}\n`}]`,
    ...(views.length > 0 ? [`"views": [\n${views.map((v) => `  ${JSON.stringify(v)}`).join(',\n')}\n]`] : []),
    ...(snapshot ? [`"snapshot": "${toBase64(snapshot)}"`] : []),
  ].join(',\n') + '}\n';
}

const isObject = (x: unknown): x is Record<string, unknown> => typeof x === 'object' && x !== null && !Array.isArray(x);
const fields = ['knead', 'name', 'source', 'commands', 'views', 'snapshot'];

/** Whether this JSON is a net of control points (docs/formats.md) rather than a document or a script. */
export function isNet(text: string): boolean {
  try {
    const json: unknown = JSON.parse(text);
    return Array.isArray(json) || (isObject(json) && json.net !== undefined && json.knead === undefined);
  } catch {
    return false; // `readKnead` says what is wrong
  }
}

/** Throws an Error whose message says where the document is wrong, and what would be right. */
export function readKnead(text: string): KneadDocument {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch (error) {
    throw new Error(`this is no Knead document: it is not JSON (${(error as Error).message})`);
  }
  if (!isObject(json) || json.knead === undefined) throw new Error('this is no Knead document: its "knead", the version, is missing');
  const script = json.knead !== documentVersion && json.name === undefined && json.source === undefined;
  checkVersion(json.knead, script);
  const unknown = Object.keys(json).find((key) => !fields.includes(key));
  if (unknown !== undefined) throw new Error(`"${unknown}": a Knead document has no such field; they are ${fields.join(', ')}`);
  if (!Array.isArray(json.commands)) throw new Error('"commands": the list of commands is missing');
  const commands = json.commands.map((c: unknown, k): Command => {
    if (!isObject(c)) throw new Error(`commands[${k}]: a command is an object like {"do": "step"}`);
    if (typeof c.do !== 'string') throw new Error(`commands[${k}].do: the name of the command is missing`);
    return c as Command;
  });
  if (json.name !== undefined && typeof json.name !== 'string') throw new Error('"name": this is no text');
  const name = json.name ?? 'document';
  const source = json.source === undefined ? null : readSource(json.source);
  const snapshot = json.snapshot === undefined ? null : bytesOf(json.snapshot, '"snapshot"');
  const views = json.views === undefined ? [] : readViews(json.views);
  return { name, source, commands, script, snapshot, views };
}

function checkVersion(version: unknown, script: boolean): void {
  const [what, read] = script ? ['script', scriptVersion] : ['Knead document', documentVersion];
  if (version === read) return;
  const older = typeof version === 'number' && version < read;
  throw new Error(`"knead": the ${what} is of version ${JSON.stringify(version)}, and this studio reads ${read}: ${
    older ? 'docs/scripts.md says how its commands are translated' : 'reload the page for a newer one'}`);
}

function readSource(source: unknown): Source {
  if (!isObject(source)) throw new Error('"source": write {"kind": …, "name": …, "bytes": …}');
  const { kind, name, bytes } = source;
  if (kind !== 'step' && kind !== 'rhino') throw new Error(`source.kind: ${JSON.stringify(kind)} is not known; it is "step" or "rhino"`);
  if (typeof name !== 'string') throw new Error('source.name: the name of the file is missing');
  return { kind, name, bytes: bytesOf(bytes, 'source.bytes') };
}

function bytesOf(text: unknown, where: string): Uint8Array {
  if (typeof text !== 'string') throw new Error(`${where}: this is no text`);
  try {
    return fromBase64(text);
  } catch {
    throw new Error(`${where}: this is not base64`);
  }
}
