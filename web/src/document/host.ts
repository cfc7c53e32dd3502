import type { Client } from '../engine/client';
import type { Context, Trim } from '../engine/context';
import type { SessionInfo } from '../engine/session_types';

/** A message to the user at the lower edge of the page. */
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
  /** Milliseconds that the worker has spent on this session's commands. */
  readonly computedTime: number;
  /** Lines of the pictures per direction. */
  readonly detail: number;
  notify: (notice: Notice) => void;
  /** Null where something went wrong; the user has been told then. */
  attempt(act: () => Promise<void>): Promise<true | null>;
  /** Panels and marks are redrawn. */
  changed(): void;
  /** The next frame belongs to another session. Returns a function that reverts this. */
  begin(): () => void;
  /** The brush becomes no larger than this, file units. */
  sizeBrush(radius: number): void;
  /** The surroundings of the surfaces, and the visible part of each. */
  showContext(context: Context | null, trims: Trim[]): void;
  /** The view as a PNG file, with `scale` pixels for each of the page's. */
  picture(scale: number): Promise<Blob>;
}
