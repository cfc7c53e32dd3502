import type { Host } from '../document/host';
import type { Command, LatticeSettings } from '../engine/session_types';
import type { Viewer } from '../view/viewer';

/** What the pointer's tools need from the page. */
export interface ToolHost extends Host {
  readonly viewer: Viewer;
  /** Counts the frames, so that what depends on one is computed once. */
  readonly changes: number;
  /** Called when something has changed. */
  readonly onChange: (() => void)[];
  playing(): boolean;
  /** Executes commands as one history entry, or with `join` as part of the previous entry. */
  execute(commands: Command[], join?: boolean): Promise<true | null>;
  /** Shows the block of the command `lattice` round what is selected, whose points are dragged in place of the surface's; null: none. */
  showLattice(lattice: LatticeSettings | null): void;
  /** The block that is shown has been pulled: it is shown as it was pulled from now on. */
  latticePulled(): void;
  /** Selects a surface; one without settings is made ready to sculpt. */
  select(surface: number): Promise<void>;
  /** Selects several surfaces; those without settings are made ready first. */
  selectTogether(surfaces: number[]): Promise<void>;
}

/** What a click in the mode `place` adds to the scene. */
export interface Placing {
  shape: string;
  /** Id of the surface that is the tool, of the shape `surface`. */
  surface?: string;
}
