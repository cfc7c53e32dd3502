import type { DiagnosticValues, EngineErrorInfo, FixInfo } from './generated.js';

/** What errors outside of the engine do not say. */
export const uncoded = { where: '', place: '', code: 'none', values: null, fixes: [] } satisfies Partial<EngineErrorInfo>;

/** What goes wrong outside of the engine. */
export const errorOf = (kind: string, what: string, remedy: string): EngineErrorInfo => ({ ...uncoded, kind, what, remedy, message: what });

/** What an error speaks of, by name: what has no value is left out. */
export type Values = { [V in keyof DiagnosticValues]?: NonNullable<DiagnosticValues[V]> };

/** A failure that has changed nothing. */
export class KneadError extends Error {
  /** What has happened, for programs (docs/errors.md); "none" if only the text is known. */
  readonly code: EngineErrorInfo['code'];
  /** "usage", "input", "numerical"; "internal" where the engine is no longer there. */
  readonly kind: string;
  readonly what: string;
  /** The place in the input. */
  readonly where: string;
  readonly remedy: string;
  readonly values: Values;
  /** What can be done, the most likely first: `doc.run(fix)` does it. */
  readonly fixes: FixInfo[];

  /** All of it as the engine says it. */
  declare readonly info: EngineErrorInfo;

  /** `file`: which is wrong, and its line (0: unknown). */
  constructor(info: EngineErrorInfo, readonly file = '', readonly line = 0) {
    super(info.message);
    Object.defineProperty(this, 'info', { value: info }); // not shown with the fields that say the same
    this.name = 'KneadError';
    ({ code: this.code, kind: this.kind, what: this.what, where: this.where, remedy: this.remedy, fixes: this.fixes } = info);
    const known = Object.entries(info.values ?? {}).filter(([, value]) => value !== null && !(Array.isArray(value) && value.length === 0));
    this.values = Object.fromEntries(known) as Values;
  }
}

/** One of what the package itself finds wrong: the message is the whole sentence. */
export const kneadError = (kind: string, what: string, remedy: string, where = ''): KneadError =>
  new KneadError({ ...errorOf(kind, what, remedy), where, message: `${where && `${where}: `}${what}; ${remedy}` });
