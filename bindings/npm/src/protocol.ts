import type { Beginning, Script } from './document.js';
import type { AnyCommand, EngineErrorInfo } from './generated.js';

/** What the thread is asked for. */
export type Call =
  | { call: 'begin'; engine: WebAssembly.Module | Uint8Array; from: Beginning; stop: Int32Array | null }
  | { call: 'act'; command: AnyCommand; told: boolean }
  | { call: 'run'; script: Script; name?: string; told: boolean }
  /** A property or a method of the document, or of one of its surfaces. */
  | { call: 'read'; surface?: string; member: string; given: unknown[] };

export type Question = Call & { id: number };

export type Answer =
  | { id: number; value: unknown }
  | { id: number; error: { info: EngineErrorInfo; file: string; line: number } | { message: string } }
  | { id: number; done: number; total: number };
