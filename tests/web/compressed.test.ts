// Compressed CAD files: opened as what they hold, saved as they came.
import { gunzipSync, gzipSync } from 'node:zlib';

import { packedLike, unpacked } from '@knead/compressed';
import type { Documents } from '@studio/document/documents';
import { cadFormat, isCompressed, uncompressedName } from '@studio/document/formats';
import type { Host } from '@studio/document/host';
import { Saving } from '@studio/document/saving';

const bytesOf = (text: string) => new Uint8Array(Buffer.from(text));
const model = bytesOf(`ISO-10303-21;\n${'#1=CARTESIAN_POINT((0.,0.,0.));\n'.repeat(50)}`);
const changed = bytesOf(`ISO-10303-21;\n${'#1=CARTESIAN_POINT((0.,0.,1.));\n'.repeat(60)}`);
const gzip = new Uint8Array(gzipSync(model));
const plain = (bytes: Uint8Array) => Buffer.from(bytes).toString('latin1');

const little = (...values: [number, 2 | 4][]) => Buffer.concat(values.map(([value, count]) => {
  const bytes = Buffer.alloc(count);
  if (count === 2) bytes.writeUInt16LE(value);
  else bytes.writeUInt32LE(value);
  return bytes;
}));

/** An archive as other programs write it: with extra fields, a date, attributes and a comment. */
function zip(entries: { name: string; bytes: Uint8Array; stored?: boolean; size?: number; flags?: number }[]): Uint8Array {
  const files: Buffer[] = [];
  const heads: Buffer[] = [];
  let at = 0;
  for (const { name, bytes, stored = false, size = bytes.length, flags = 0 } of entries) {
    const made = gzipSync(bytes);
    const packed = stored ? Buffer.from(bytes) : made.subarray(10, -8);
    const crc = made.readUInt32LE(made.length - 8);
    const common = little([20, 2], [flags, 2], [stored ? 0 : 8, 2], [0x4321, 2], [0x5765, 2], [crc, 4], [packed.length, 4], [size, 4], [name.length, 2], [4, 2]);
    const file = Buffer.concat([little([0x04034b50, 4]), common, Buffer.from(name), Buffer.from('extr'), packed]);
    heads.push(Buffer.concat([little([0x02014b50, 4], [20, 2]), common, little([0, 2], [0, 2], [0, 2], [0x81a40000, 4], [at, 4]), Buffer.from(name), Buffer.from('extr')]));
    files.push(file);
    at += file.length;
  }
  const directory = Buffer.concat(heads);
  return new Uint8Array(Buffer.concat([...files, directory,
    little([0x06054b50, 4], [0, 4], [entries.length, 2], [entries.length, 2], [directory.length, 4], [at, 4], [3, 2]), Buffer.from('end')]));
}

describe('a compressed file', () => {
  const archive = zip([{ name: 'part.stp', bytes: model }]);
  const stored = zip([{ name: 'part.stp', bytes: model, stored: true }]);

  it('holds what was put in', async () => {
    for (const bytes of [gzip, archive, stored]) {
      expect(isCompressed(bytes)).toBe(true);
      expect(plain(await unpacked(bytes))).toBe(plain(model));
    }
    expect(isCompressed(model)).toBe(false);
  });

  it('keeps its bytes where nothing has changed, and its names, dates and attributes elsewhere', async () => {
    for (const bytes of [gzip, archive, stored]) {
      expect(plain(await packedLike(model, bytes))).toBe(plain(bytes));
      const made = await packedLike(changed, bytes);
      expect(plain(await unpacked(made))).toBe(plain(changed));
      expect(made[0]).toBe(bytes[0]);
    }
    const made = plain(await packedLike(changed, archive));
    expect(made.slice(10, 14)).toBe('\x21\x43\x65\x57');
    expect(made.slice(30, 38)).toBe('part.stp');
    const named = joinedHeader('part.step\0');
    expect(plain(await packedLike(changed, named)).slice(0, 20)).toBe(plain(named).slice(0, 20));
  });

  /** gzip with a name. */
  function joinedHeader(name: string): Uint8Array {
    const header = Buffer.from(gzip.slice(0, 10));
    header[3] = 8;
    return new Uint8Array(Buffer.concat([header, Buffer.from(name), gzip.slice(10)]));
  }

  it('that is damaged, cut, of several files or encrypted is refused', async () => {
    for (const bytes of [gzip, archive]) {
      for (let size = 4; size < bytes.length; ++size) await expect(unpacked(bytes.slice(0, size))).rejects.toThrow();
    }
    const wrong = gzip.slice();
    ++wrong[wrong.length - 8]!;
    await expect(unpacked(wrong)).rejects.toThrow(/damaged/);
    await expect(unpacked(zip([{ name: 'a', bytes: model }, { name: 'b', bytes: model }]))).rejects.toThrow(/holds 2 files; unpack/);
    await expect(unpacked(zip([{ name: 'a', bytes: model, flags: 1 }]))).rejects.toThrow(/encrypted/);
  });

  it('that holds more than is allowed is refused by what it states, and one that lies as soon as it goes on', async () => {
    await expect(unpacked(gzip, model.length - 1)).rejects.toThrow(/more than the/);
    const bomb = gzipSync(Buffer.alloc(2 ** 26));
    bomb.writeUInt32LE(1000, bomb.length - 4);
    await expect(unpacked(new Uint8Array(bomb))).rejects.toThrow(/go on beyond|damaged/);
    bomb.writeUInt32LE(2 ** 30 + 1, bomb.length - 4);
    await expect(unpacked(new Uint8Array(bomb))).rejects.toThrow(/1024 MiB, more/);
    await expect(unpacked(zip([{ name: 'a', bytes: model, size: 2 ** 29 }]))).rejects.toThrow(/cannot have/);
  });

  it('is known by its name', () => {
    expect(cadFormat('part.step.gz')).toMatchObject({ ending: '.step.gz', format: { id: 'step' } });
    expect(cadFormat('part.P21.GZ')).toMatchObject({ ending: '.p21.gz', format: { id: 'step' } });
    expect(cadFormat('part.stpZ')).toMatchObject({ ending: '.stpZ', format: { id: 'step' } });
    expect(cadFormat('picture.gz')).toBeNull();
    expect(uncompressedName('part.stpZ')).toBe('part.stp');
  });
});

describe('the download of a compressed file', () => {
  afterEach(() => vi.unstubAllGlobals());

  it('is compressed as the file that was opened, and named like it', async () => {
    const names: string[] = [];
    const blobs: Blob[] = [];
    vi.stubGlobal('document', { createElement: () => ({ href: '', download: '', click() { names.push(this.download); } }) });
    vi.stubGlobal('URL', { createObjectURL: (blob: Blob) => { blobs.push(blob); return 'blob:'; }, revokeObjectURL: () => undefined });
    const host = {
      client: { query: async () => ({ file: changed, edges: [] }) }, state: { tools: [], last: null, surfaces: [] },
      notify: () => undefined, settle: () => undefined, attempt: async (act: () => Promise<void>) => { await act(); return true as const; },
    };
    const documents = { name: 'hood.step.gz', file: { kind: 'step', name: 'hood.step.gz', bytes: gzip }, place: null, saved: () => undefined };
    await new Saving(host as never as Host, documents as never as Documents).step();
    expect(names).toEqual(['hood-sculpted.step.gz']);
    expect(blobs[0]!.type).toBe('application/gzip');
    expect(gunzipSync(Buffer.from(await blobs[0]!.arrayBuffer())).toString()).toBe(Buffer.from(changed).toString());
  });
});
