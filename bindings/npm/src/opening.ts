import { unpacked } from './compressed.js';
import type { Beginning } from './document.js';
import { kneadError } from './errors.js';

export interface OpenOptions {
  /** What errors call the file, and whose ending tells the format where its bytes do not. */
  name?: string;
  /** Bytes that a compressed file may hold. */
  maxUnpacked?: number;
}

export interface CreateOptions {
  name?: string;
  /** Of lengths. */
  unit?: string;
}

export type FileBytes = Uint8Array | ArrayBuffer | Blob;

/** The bytes of a file, a copy, unpacked, and as they were compressed. */
async function bytesOf(file: FileBytes, { name, maxUnpacked }: OpenOptions): Promise<{ file: Uint8Array; packed: Uint8Array | null }> {
  const isBytes = file instanceof Uint8Array || file instanceof ArrayBuffer || file instanceof Blob;
  if (!isBytes) throw kneadError('usage', 'a file is opened from its bytes', 'give a Uint8Array, an ArrayBuffer or a Blob', 'file');
  const bytes = file instanceof Blob ? new Uint8Array(await file.arrayBuffer()) : new Uint8Array(file).slice();
  const packed = (bytes[0] === 0x1f && bytes[1] === 0x8b) || (bytes[0] === 0x50 && bytes[1] === 0x4b);
  if (!packed) return { file: bytes, packed: null };
  const inside = await unpacked(bytes, maxUnpacked).catch((error: unknown) => {
    throw error instanceof Error ? kneadError('input', ...(error.message.split(/; (?=[^;]*$)/) as [string, string]), name) : error;
  });
  return { file: inside, packed: bytes };
}

export const beginOpened = async (file: FileBytes, options: OpenOptions = {}): Promise<Beginning> =>
  ({ ...await bytesOf(file, options), name: options.name ?? ('name' in file && typeof file.name === 'string' ? file.name : 'document') });

export const beginFresh = ({ name = 'sheet', unit }: CreateOptions = {}): Beginning => ({ name, unit });

