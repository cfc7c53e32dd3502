/** The last session, kept in the browser: what a closed tab or a crash leaves behind. */
export interface Saved {
  name: string;
  source: Uint8Array | null;
  journal: string;
  when: number;
  commands: number;
}

function database(): Promise<IDBDatabase> {
  return new Promise((resolve, reject) => {
    const request = indexedDB.open('knead', 1);
    request.onupgradeneeded = () => request.result.createObjectStore('sessions');
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}

async function inStore<T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest<T>): Promise<T> {
  const db = await database();
  try {
    return await new Promise<T>((resolve, reject) => {
      const transaction = db.transaction('sessions', mode);
      const request = act(transaction.objectStore('sessions'));
      transaction.oncomplete = () => resolve(request.result);
      transaction.onerror = () => reject(transaction.error);
      transaction.onabort = () => reject(transaction.error);
    });
  } finally {
    db.close();
  }
}

export const autosave = {
  write: (saved: Saved) => inStore('readwrite', (store) => store.put(saved, 'last')),
  read: () => inStore('readonly', (store) => store.get('last') as IDBRequest<Saved | undefined>),
  forget: () => inStore('readwrite', (store) => store.delete('last')),
};
