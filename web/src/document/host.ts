import type { Client } from '../engine/client';
import type { Context, Trim } from '../engine/context';
import type { SessionInfo } from '../engine/session_types';

/** A message to the user at the lower edge of the page. */
export interface Notice {
  kind: 'error' | 'info';
  text: string;
  /** What it is about: it takes the place of the one before about the same. Default: its text. */
  topic?: string;
  /** It leaves by itself, though it offers something. */
  passing?: boolean;
  /** Of the page, not of its document: it stays where another is opened. */
  ofPage?: boolean;
  remedy?: string;
  actions?: { label: string; act: () => void }[];
}

/** What the user is asked before something is done. */
export interface Question {
  title: string;
  text: string;
  /** The first one is what Enter means. “Cancel” is always there. */
  choices: { id: string; label: string; about?: string }[];
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
  /** What a message about this says is not so any more. */
  settle: (topic: string) => void;
  /** The id of the choice; null where the user wants none of them. */
  ask: (question: Question) => Promise<string | null>;
  /** Null where something went wrong; the user has been told then. */
  attempt(act: () => Promise<void>): Promise<true | null>;
  /** Panels and marks are redrawn. */
  changed(): void;
  /** The next frame is of another session, or, with `again`, of the same one in another engine. Gives back what takes that back. */
  begin(again?: boolean): () => void;
  /** The brush becomes no larger than this, file units. */
  sizeBrush(radius: number): void;
  /** The surroundings of the surfaces, and the visible part of each. */
  showContext(context: Context | null, trims: Trim[]): void;
  /** Contours in an image: another part of the page. */
  openImage(file: File): Promise<void>;
  /** The table of edges is opened. */
  showEdges(): void;
  /** The edges of faces are to be asked for again. */
  forgetEdges(): void;
  /** The view as a PNG file, with `scale` pixels for each of the page's. */
  picture(scale: number): Promise<Blob>;
}
