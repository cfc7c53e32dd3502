/** Files of the user's disk that are written in place, where the browser gives access to them (File System Access). */

type OpenPicker = (options: { id: string }) => Promise<FileSystemFileHandle[]>;
type DroppedItem = DataTransferItem & { getAsFileSystemHandle?(): Promise<FileSystemHandle | null> };

const openPicker = () => (window as { showOpenFilePicker?: OpenPicker }).showOpenFilePicker;

export interface OnDisk {
  file: File;
  handle: FileSystemFileHandle;
}

export const canPick = (): boolean => openPicker() !== undefined;

/** Asks for a file; null if the user gives none. */
export async function pickFile(): Promise<OnDisk | null> {
  try {
    const [handle] = await openPicker()!({ id: 'knead' });
    return handle ? { file: await handle.getFile(), handle } : null;
  } catch (error) {
    if (error instanceof DOMException && error.name === 'AbortError') return null;
    throw error;
  }
}

/** The handle of a file that is dropped; null where the browser has none. To be called while the event is handled. */
export async function droppedHandle(item: DataTransferItem | undefined): Promise<FileSystemFileHandle | null> {
  const handle = await (item as DroppedItem | undefined)?.getAsFileSystemHandle?.().catch(() => null);
  return handle?.kind === 'file' ? (handle as FileSystemFileHandle) : null;
}

/** Whether another program has written the file since it was opened. */
export async function changedSince({ file, handle }: OnDisk): Promise<boolean> {
  return (await handle.getFile()).lastModified !== file.lastModified;
}

/** Replaces the file: the browser writes beside it and exchanges both when all is written. Returns it as it is now. */
export async function replaceFile({ handle }: OnDisk, bytes: Uint8Array): Promise<OnDisk> {
  const writable = await handle.createWritable();
  try {
    await writable.write(bytes.slice().buffer as ArrayBuffer);
  } catch (error) {
    await writable.abort().catch(() => undefined);
    throw error;
  }
  await writable.close();
  return { file: await handle.getFile(), handle };
}
