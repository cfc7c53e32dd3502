import type { Documents } from '../document/documents';
import type { Saving } from '../document/saving';
import type { Frame } from '../engine/protocol';
import type { Command, StepInfo, SurfaceNumbers } from '../engine/session_types';
import type { Hand } from '../tools/hand';
import type { ToolHost } from '../tools/host';
import type { Display, Theme } from '../view/display';

/** What panels, bars and keys show and set: the page, implemented by app/studio.ts. */
export interface App extends ToolHost {
  readonly hand: Hand;
  readonly documents: Documents;
  readonly saving: Saving;
  readonly display: Readonly<Display>;
  readonly theme: Theme;
  readonly frame: Frame | null;
  /** The newest steps, for the plot. */
  readonly steps: readonly StepInfo[];
  /** While the session plays; 0 otherwise. */
  readonly framesPerSecond: number;
  /** Of the selected surfaces, or of all; file units. */
  readonly diagonal: number;
  /** Executes commands as one entry of the history; answers why not where the engine refuses them, and tells nobody else. */
  offer(commands: Command[]): Promise<string | null>;
  setDisplay(change: Partial<Display>): void;
  setTheme(theme: Theme): void;
  /** While a key is held: the surfaces as they were opened. */
  compare(opened: boolean): void;
  togglePlay(toRest?: boolean): void;
  /** The numbers of a surface as it is now. */
  surfaceData(surface: number): Promise<SurfaceNumbers>;
}
