import type { Client } from '../engine/client';
import type { Context, Trim } from '../engine/context';
import type { SessionInfo } from '../engine/session_types';

/** What the user is told at the lower edge of the page. */
export interface Notice {
  kind: 'error' | 'info';
  text: string;
  remedy?: string;
  actions?: { label: string; act: () => void }[];
}

/** What opening, saving and keeping a document need of the page round them. */
export interface Host {
  readonly client: Client;
  /** Of the newest frame. */
  readonly state: SessionInfo | null;
  /** Milliseconds that the worker took for this session's commands. */
  readonly computedTime: number;
  /** Lines of the pictures per direction. */
  readonly detail: number;
  notify: (notice: Notice) => void;
  /** Null where something went wrong; the user has been told then. */
  attempt(act: () => Promise<void>): Promise<true | null>;
  /** Panels and marks are drawn anew. */
  changed(): void;
  /** The next frame is of another session. Gives back what takes that back. */
  begin(): () => void;
  /** The brush becomes no larger than this, file units. */
  sizeBrush(radius: number): void;
  /** What stands round the surfaces, and what of each is seen. */
  showContext(context: Context | null, trims: Trim[]): void;
  /** The view as a PNG file, with `scale` pixels for each of the page's. */
  picture(scale: number): Promise<Blob>;
}
