import type { Command } from '../engine/session_types';

/** A scene of the gallery: commands on an empty document, or on a file served with the page. */
export interface Scene {
  name: string;
  about: string;
  /** Of the document. */
  document: string;
  commands?: Command[];
  file?: string;
}
