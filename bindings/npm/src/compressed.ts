/**
 * Files that are compressed by gzip, or as the one entry of a ZIP archive (docs/formats.md#compressed-files), by the streams of
 * the browser. The data of an entry become those of a gzip file whose end the directory of the archive states, so that the browser
 * checks size and checksum of both.
 */

const mostBytes = 2 ** 30; // as the library allows (docs/safety.md)
const largestRatio = 1032; // DEFLATE: two bits stand for at most 258 bytes
const again = 'have it written or sent again';
const outside = 'unpack it, and open the CAD file in it';

interface Archive {
  kind: 'gzip' | 'ZIP';
  /** The data, without a frame. */
  packed: Uint8Array;
  deflated: boolean;
  size: number;
  crc: number;
  /** gzip: the header. */
  header: Uint8Array;
  /** ZIP: the head of the entry in the directory, with its name. */
  entry: Uint8Array;
}

const gzipHeader = Uint8Array.of(0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 0xff);
const viewOf = (bytes: Uint8Array) => new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);

function joined(...parts: Uint8Array[]): Uint8Array {
  const all = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

function numbers(...values: [value: number, bytes: 2 | 4][]): Uint8Array {
  const all = new Uint8Array(values.reduce((sum, [, count]) => sum + count, 0));
  let at = 0;
  for (const [value, count] of values) {
    if (count === 2) viewOf(all).setUint16(at, value, true);
    else viewOf(all).setUint32(at, value, true);
    at += count;
  }
  return all;
}

function readGzip(bytes: Uint8Array): Archive {
  const short = () => new Error(`the file is gzip, and ends too early; ${again}`);
  if (bytes.length < 18) throw short();
  const view = viewOf(bytes);
  const flags = bytes[3]!;
  if (bytes[2] !== 8 || (flags & 0xe0) !== 0) throw new Error(`the file is gzip of a kind that is not known; ${outside}`);
  let at = 10;
  if (flags & 4) at += 2 + view.getUint16(at, true);
  for (const text of [8, 16]) {
    if (!(flags & text)) continue;
    const end = bytes.indexOf(0, at);
    at = end < 0 ? bytes.length : end + 1;
  }
  if (flags & 2) at += 2;
  if (at + 8 > bytes.length) throw short();
  const end = bytes.length - 8;
  return { kind: 'gzip', packed: bytes.subarray(at, end), deflated: true, crc: view.getUint32(end, true), size: view.getUint32(end + 4, true),
    header: bytes.subarray(0, at), entry: new Uint8Array() };
}

/** Where the record that ends a ZIP archive begins: with its comment it reaches to the end of the file. */
function endOfDirectory(view: DataView): number {
  for (let at = view.byteLength - 22; at >= Math.max(0, view.byteLength - 22 - 0xffff); --at) {
    if (view.getUint32(at, true) === 0x06054b50 && at + 22 + view.getUint16(at + 20, true) === view.byteLength) return at;
  }
  throw new Error(`the file is ZIP, and ends too early; ${again}`);
}

function readZip(bytes: Uint8Array): Archive {
  const view = viewOf(bytes);
  const end = endOfDirectory(view);
  const [count, length, head] = [view.getUint16(end + 10, true), view.getUint32(end + 12, true), view.getUint32(end + 16, true)];
  if (count === 0xffff || length === 0xffffffff || head === 0xffffffff) throw new Error(`the archive is a ZIP64; ${outside}`);
  if (view.getUint32(end + 4, true) !== 0 || view.getUint16(end + 8, true) !== count) throw new Error(`the ZIP archive is one part of several; ${outside}`);
  if (count !== 1) throw new Error(`the ZIP archive ${count === 0 ? 'is empty' : `holds ${count} files`}; ${outside}`);
  const wrong = () => new Error(`the ZIP archive is damaged; ${again}`);
  if (head + length > end || length < 46 || view.getUint32(head, true) !== 0x02014b50) throw wrong();
  const [flags, method, packed, size] = [view.getUint16(head + 8, true), view.getUint16(head + 10, true), view.getUint32(head + 20, true), view.getUint32(head + 24, true)];
  const [name, begin] = [view.getUint16(head + 28, true), view.getUint32(head + 42, true)];
  if ([packed, size, begin].includes(0xffffffff)) throw new Error(`the archive is a ZIP64; ${outside}`);
  if (flags & 0x2041) throw new Error(`the ZIP archive is encrypted; ${outside}`);
  if (method !== 0 && method !== 8) throw new Error(`the ZIP archive uses the method ${method}; ${outside}`);
  if (46 + name > length || begin + 30 > head || view.getUint32(begin, true) !== 0x04034b50 || view.getUint16(begin + 8, true) !== method) throw wrong();
  const data = begin + 30 + view.getUint16(begin + 26, true) + view.getUint16(begin + 28, true);
  if (data + packed > head || (method === 0 && packed !== size)) throw wrong();
  return { kind: 'ZIP', packed: bytes.subarray(data, data + packed), deflated: method === 8, crc: view.getUint32(head + 16, true), size,
    header: gzipHeader, entry: bytes.subarray(head, head + 46 + name) };
}

const readArchive = (bytes: Uint8Array): Archive => (bytes[0] === 0x1f ? readGzip(bytes) : readZip(bytes));

const through = (bytes: Uint8Array, stream: CompressionStream | DecompressionStream): ReadableStreamDefaultReader<Uint8Array> =>
  (new Blob([bytes as BlobPart]).stream() as ReadableStream<Uint8Array>).pipeThrough(stream as ReadableWritablePair<Uint8Array, Uint8Array>).getReader();

/** The data in a frame of gzip that states what they must be. */
async function inflated({ packed, size, crc, header }: Archive): Promise<Uint8Array> {
  const reader = through(joined(header, packed, numbers([crc, 4], [size, 4])), new DecompressionStream('gzip'));
  const all = new Uint8Array(size);
  let filled = 0;
  for (;;) {
    const { done, value } = await reader.read().catch(() => {
      throw new Error(`the compressed file is damaged; ${again}`);
    });
    if (done) break;
    if (filled + value.length > size) {
      await reader.cancel().catch(() => undefined);
      throw new Error(`the compressed data go on beyond the size that the file states; ${again}, or unpack it`);
    }
    all.set(value, filled);
    filled += value.length;
  }
  if (filled < size) throw new Error(`the compressed data end before the size that the file states; ${again}`);
  return all;
}

/** A gzip file of the data, which has their checksum. */
async function gzipped(bytes: Uint8Array): Promise<Uint8Array> {
  const reader = through(bytes, new CompressionStream('gzip'));
  const parts: Uint8Array[] = [];
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return joined(...parts);
    parts.push(value);
  }
}

/** What a compressed file holds. Throws an Error that says what is wrong; sizes are checked before anything is unpacked. */
export async function unpacked(bytes: Uint8Array, most = mostBytes): Promise<Uint8Array> {
  const archive = readArchive(bytes);
  const { kind, size, packed, deflated } = archive;
  const mebibytes = (count: number) => (count / 2 ** 20).toFixed(0);
  if (size > most) throw new Error(`unpacked the file has ${mebibytes(size)} MiB, more than the ${mebibytes(most)} that are allowed; open a smaller file`);
  if (deflated && Math.floor(size / largestRatio) > packed.length) throw new Error(`the compressed file states a size that its data cannot have; ${again}`);
  if (deflated) return inflated(archive);
  const made = readGzip(await gzipped(packed));
  if (made.crc !== archive.crc) throw new Error(`the ${kind} archive is damaged: its checksum differs; ${again}`);
  return packed;
}

function zipOf(entry: Uint8Array, packed: Uint8Array, deflated: boolean, crc: number, size: number): Uint8Array {
  const old = viewOf(entry);
  const name = entry.subarray(46);
  const common = numbers([20, 2], [old.getUint16(8, true) & 0x800, 2], [deflated ? 8 : 0, 2], [old.getUint16(12, true), 2], [old.getUint16(14, true), 2],
    [crc, 4], [packed.length, 4], [size, 4], [name.length, 2], [0, 2]);
  const directory = joined(numbers([0x02014b50, 4], [old.getUint16(4, true), 2]), common,
    numbers([0, 2], [0, 2], [old.getUint16(36, true), 2], [old.getUint32(38, true), 4], [0, 4]), name);
  const before = joined(numbers([0x04034b50, 4]), common, name, packed);
  return joined(before, directory, numbers([0x06054b50, 4], [0, 4], [1, 2], [1, 2], [directory.length, 4], [before.length, 4], [0, 2]));
}

/** The bytes compressed as the file `like` is: with its names, dates and attributes; itself if it holds them. */
export async function packedLike(bytes: Uint8Array, like: Uint8Array): Promise<Uint8Array> {
  const archive = readArchive(like);
  const made = readGzip(await gzipped(bytes));
  if (made.crc === archive.crc && archive.size === bytes.length) {
    const held = await unpacked(like, archive.size);
    if (held.every((value, k) => value === bytes[k])) return like;
  }
  if (archive.kind === 'ZIP') return zipOf(archive.entry, archive.deflated ? made.packed : bytes, archive.deflated, made.crc, bytes.length);
  return joined(archive.header, made.packed, numbers([made.crc, 4], [bytes.length, 4]));
}

/** The bytes compressed anew, as the ending of a name says: by gzip (.gz), or as the one entry of a ZIP archive (.stpZ), without a date. */
export async function packedAs(bytes: Uint8Array, name: string): Promise<Uint8Array> {
  const packed = await gzipped(bytes);
  if (!name.toLowerCase().endsWith('.stpz')) return packed;
  const entry = new TextEncoder().encode(unpackedName(name).split(/[/\\]/).at(-1)!);
  const head = numbers([0x02014b50, 4], [20, 2], [20, 2], [0x800, 2], [8, 2], [0, 2], [0x21, 2], [0, 4], [0, 4], [0, 4], [entry.length, 2],
    [0, 2], [0, 2], [0, 2], [0, 2], [0, 4], [0, 4]);
  const { packed: data, crc } = readGzip(packed);
  return zipOf(joined(head, entry), data, true, crc, bytes.length);
}

/** What a file of that name is called unpacked: bonnet.step of bonnet.step.gz, bonnet.stp of bonnet.stpZ; itself where it tells of no compression. */
export function unpackedName(name: string): string {
  const lower = name.toLowerCase();
  return lower.endsWith('.gz') ? name.slice(0, -3) : lower.endsWith('.stpz') ? name.slice(0, -1) : name;
}
