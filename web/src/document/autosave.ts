import type { Command } from '../engine/session_types';
import { documentOf, type Source } from './knead_file';
import type { SavedView } from './saved_views';

/** A session as it is kept in the browser: what a closed tab or a crash leaves behind. */
export interface Kept {
  /** What the rest is written in; sessions of the first studios do not say. */
  form?: number;
  id: string;
  name: string;
  when: number;
  /** Number of commands in effect. */
  commands: number;
  /** How many of them belong to the opened document. */
  opened: number;
  journal: string;
  snapshot: Uint8Array;
  hasSource: boolean;
  views: SavedView[];
}

/** What is written, and the only form that is read. */
export const keptForm = 2;
export const isReadable = (kept: Kept): boolean => kept.form === keptForm;

/** A session of an older studio as that one saved documents, so that nothing of it is lost. */
export function olderDocument(kept: Kept, source: Source | null): string {
  const { commands } = JSON.parse(kept.journal) as { commands: Command[] };
  return documentOf({ ...kept, source, commands }, 2);
}

const stores = ['sessions', 'sources'] as const;
type Store = (typeof stores)[number];

function database(): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    // Version 1 kept a single session under the key "last", without a snapshot.
    const request = indexedDB.open('knead', 2);
    request.onupgradeneeded = () => {
      for (const name of [...request.result.objectStoreNames]) request.result.deleteObjectStore(name);
      for (const name of stores) request.result.createObjectStore(name);
    };
    request.onblocked = () => reject(new Error('an older version of the studio is open in another tab'));
    request.onsuccess = () => {
      request.result.onversionchange = () => request.result.close();
      resolve(request.result);
    };
    request.onerror = () => reject(request.error);
  });
}

/** One transaction: all of it is written, or nothing. */
async function transact<T>(mode: IDBTransactionMode, act: (store: (name: Store) => IDBObjectStore) => IDBRequest<T>): Promise<T> {
  const db = await database();
  try {
    return await new Promise<T>((resolve, reject) => {
      const transaction = db.transaction(stores, mode);
      const request = act((name) => transaction.objectStore(name));
      transaction.oncomplete = () => resolve(request.result);
      transaction.onerror = () => reject(transaction.error);
      transaction.onabort = () => reject(transaction.error);
    });
  } finally {
    db.close();
  }
}

export const autosave = {
  /** The source, which never changes, is written only the first time. */
  write: (kept: Kept, source: Source | null) =>
    transact('readwrite', (store) => {
      if (source) store('sources').put(source, kept.id);
      return store('sessions').put(kept, kept.id);
    }),
  source: (id: string) => transact('readonly', (store) => store('sources').get(id) as IDBRequest<Source | undefined>),
  one: (id: string) => transact('readonly', (store) => store('sessions').get(id) as IDBRequest<Kept | undefined>),
  all: () => transact('readonly', (store) => store('sessions').getAll() as IDBRequest<Kept[]>),
  forget: (id: string) =>
    transact('readwrite', (store) => {
      store('sources').delete(id);
      return store('sessions').delete(id);
    }),
};

/** The mark of a session that is open in some tab: held as long as the tab is open, released however it closes. */
const lockOf = (id: string) => `knead session ${id}`;

/** Marks a session as this tab's; returns a function that ends this. */
export function hold(id: string): () => void {
  let release = () => {};
  const until = new Promise<void>((resolve) => (release = resolve));
  void navigator.locks?.request(lockOf(id), () => until);
  return release;
}

/** As `hold`, of a session that may be another tab's: null then. */
export async function claim(id: string): Promise<(() => void) | null> {
  if (!navigator.locks) return () => {};
  let release = () => {};
  const until = new Promise<void>((resolve) => (release = resolve));
  const mine = await new Promise<boolean>((resolve) => void navigator.locks.request(lockOf(id), { ifAvailable: true }, (lock) => {
    resolve(lock !== null);
    return lock ? until : undefined;
  }));
  return mine ? release : null;
}

/** Ids of the sessions that some tab has open. */
export async function heldIds(): Promise<Set<string>> {
  const { held = [] } = (await navigator.locks?.query()) ?? {};
  return new Set(held.map((lock) => lock.name ?? '').filter((name) => name.startsWith(lockOf(''))).map((name) => name.slice(lockOf('').length)));
}
