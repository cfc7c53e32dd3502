import type { EngineErrorInfo } from '../../engine/session_types';
import type { ContourKind, PictureKind, Pixels, Pull, Snakes } from './module';

/** What the panel asks of its worker; each request is answered by one reply of the same id. */
export type Request =
  | { kind: 'image'; pixels: Pixels }
  | { kind: 'mask'; pixels: Pixels | null }
  | { kind: 'script'; text: string; again: boolean }
  | { kind: 'clear' }
  | { kind: 'keep' }
  /** Goes back to what was kept, and keeps what there was before. */
  | { kind: 'restore'; kept: number }
  | { kind: 'forget'; kept: number[] }
  | { kind: 'run'; on: boolean }
  | { kind: 'step'; iterations: number }
  | { kind: 'pull'; pull: Pull | null }
  | { kind: 'move'; snake: number; point: number; to: [number, number] }
  | { kind: 'contours'; as: ContourKind; image: string }
  | { kind: 'picture'; of: PictureKind }
  | { kind: 'drawn' };

export interface Result {
  text?: string;
  /** By which it can be restored. */
  kept?: number;
  picture?: { width: number; height: number; data: Uint8Array };
}

export type Reply =
  | { kind: 'done'; id: number; result: Result }
  | { kind: 'failed'; id: number; error: EngineErrorInfo }
  /** The snakes have moved, or are others; `running`: more is to come. */
  | { kind: 'snakes'; snakes: Snakes; running: boolean };
