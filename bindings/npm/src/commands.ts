import { kneadError } from './errors.js';
import { type AnyCommand, type CommandMethods, documentQueries, firstFields, type QueryMethods } from './generated.js';

/** How long work is watched. */
export interface Working {
  /** Called after each step of a command: how many are done, of how many. With false the command ends there. */
  progress?: (done: number, total: number) => boolean | void;
  /** Ends a command between or within steps: the steps that were whole stay, and the signal's reason is thrown. */
  signal?: AbortSignal;
}

export type CommandName = keyof typeof firstFields;

type FieldsOf<C> = C extends unknown ? keyof C : never;
type None<T extends never> = T;
/** Fields of commands that `Working` would hide: does not compile if there are any. */
export type Hidden = None<Extract<FieldsOf<AnyCommand>, keyof Working>>;

/** A value as JSON can say it; `where`: its place in the command. */
function plain(value: unknown, where: string): unknown {
  if (typeof value === 'number' && !Number.isFinite(value)) throw kneadError('input', `${value} is no number`, 'use a finite one', where);
  if (ArrayBuffer.isView(value)) return plain([...(value as Float64Array)], where);
  if (Array.isArray(value)) return value.map((part, k) => plain(part, `${where}[${k}]`));
  if (typeof value !== 'object' || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([field, part]) => [field, plain(part, where ? `${where}.${field}` : field)]));
}

/** What a method of `CommandMethods` is called with, as a command. */
export function commandOf(name: CommandName, [one, more]: readonly unknown[]): { command: AnyCommand; working: Working } {
  const named = typeof one === 'object' && one !== null && !Array.isArray(one) && !ArrayBuffer.isView(one);
  const { progress, signal, ...fields } = { ...(named ? one : (more as object | undefined)) } as Working & Record<string, unknown>;
  if (!named && one !== undefined) fields[firstFields[name]] = one;
  return { command: plain({ do: name, ...fields }, '') as AnyCommand, working: { progress, signal } };
}

/** Gives objects of a class the methods of all commands. */
export function defineCommands<Target extends object>(prototype: Target & Partial<CommandMethods<unknown, Working>>,
  act: (target: Target, command: AnyCommand, working: Working) => unknown): void {
  for (const name of Object.keys(firstFields) as CommandName[]) {
    const value = function (this: Target, ...given: unknown[]) {
      const { command, working } = commandOf(name, given);
      return act(this, command, working);
    };
    Object.defineProperty(prototype, name, { value, writable: true, configurable: true });
  }
}

export type QueryName = keyof QueryMethods;
/** The queries of a document as promises. */
export type PromisedQueries = { [Name in QueryName]: (...given: Parameters<QueryMethods[Name]>) => Promise<ReturnType<QueryMethods[Name]>> };

/** Gives objects of a class the methods of all queries of a document. Numbers that are not finite are refused as in commands. */
export function defineQueries<Target extends object>(prototype: Target, ask: (target: Target, name: QueryName, request: Parameters<QueryMethods[QueryName]>[0] & object) => unknown): void {
  for (const name of documentQueries) {
    const value = function (this: Target, request: Parameters<QueryMethods[QueryName]>[0] = {}) {
      return ask(this, name, Object.fromEntries(Object.entries(request).map(([field, part]) => [field, part instanceof Uint8Array ? part : plain(part, field)])));
    };
    Object.defineProperty(prototype, name, { value, writable: true, configurable: true });
  }
}
