import type { Host } from '../document/host';
import type { Command } from '../engine/session_types';
import type { Viewer } from '../view/viewer';

/** What the pointer's tools need of the page round them. */
export interface ToolHost extends Host {
  readonly viewer: Viewer;
  /** Counts the frames, so that what follows from one is made once. */
  readonly changes: number;
  /** Called when something has changed. */
  readonly onChange: (() => void)[];
  playing(): boolean;
  /** Executes commands as one entry of the history, or with `join` as part of the entry before them. */
  execute(commands: Command[], join?: boolean): Promise<true | null>;
  /** Selects a surface; one that nothing was said about is made ready to sculpt. */
  select(surface: number): Promise<void>;
}

/** What a click in the mode `place` puts into the scene. */
export interface Placing {
  shape: string;
  /** Id of the surface that is the tool, of the shape `surface`. */
  surface?: string;
}
