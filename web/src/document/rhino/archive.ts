/**
 * Control points of NURBS surfaces in the bytes of a .3dm file (openNURBS), exchanged in their place. rhino3dm gives a face of a
 * polysurface only as a copy; but a face keeps its trims, and the polysurface all else, if nothing but these numbers changes.
 *
 * A surface lies in a chunk of class data, in files of version 2 in that of its polysurface: a type code, a length (4 bytes, 8 from
 * version 50 on), the data, and the CRC-32 of what of them is no object of its own. It is checked before anything is written,
 * and renewed.
 */

const ofObject = 0x00027ffa; // TCODE_OPENNURBS_CLASS
const objectId = 0x0002fffb; // TCODE_OPENNURBS_CLASS_UUID, its first part
const classData = 0x0002fffc; // TCODE_OPENNURBS_CLASS_DATA
const headSize = 32; // "3D Geometry File Format " and the version
const longLengths = 50; // from this version on

/** The number in the head of the file: 2, 3, 4, 50, 60 and so on. */
const versionOf = (bytes: Uint8Array): number => Number(new TextDecoder('ascii').decode(bytes.subarray(24, headSize)).trim());

const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c;
});

/** As zlib has it, from 0, of pieces one after the other. */
export function crc32(...pieces: Uint8Array[]): number {
  let c = 0xffffffff;
  for (const bytes of pieces) for (const byte of bytes) c = crcTable[(c ^ byte) & 255]! ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

/** Where these numbers stand one after the other, as bytes of doubles. */
export function placesOf(bytes: Uint8Array, numbers: Float64Array): number[] {
  const wanted = littleEndian(numbers);
  const places: number[] = [];
  for (let at = bytes.indexOf(wanted[0]!, headSize); at >= 0 && at + wanted.length <= bytes.length; at = bytes.indexOf(wanted[0]!, at + 1)) {
    let k = 1;
    while (k < wanted.length && bytes[at + k] === wanted[k]) ++k;
    if (k === wanted.length) places.push(at);
  }
  return places;
}

function littleEndian(numbers: Float64Array): Uint8Array {
  const bytes = new Uint8Array(8 * numbers.length);
  const view = new DataView(bytes.buffer);
  numbers.forEach((x, k) => view.setFloat64(8 * k, x, true));
  return bytes;
}

interface Archive {
  bytes: Uint8Array;
  view: DataView;
  lengthSize: 4 | 8;
}

const archiveOf = (bytes: Uint8Array): Archive =>
  ({ bytes, view: new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), lengthSize: versionOf(bytes) >= longLengths ? 8 : 4 });

const lengthAt = ({ view, lengthSize }: Archive, at: number): number => (lengthSize === 8 ? Number(view.getBigUint64(at, true)) : view.getUint32(at, true));

/** The CRC of the data of a chunk without the objects in it. */
function crcOf(archive: Archive, begin: number, end: number): number {
  const { bytes, view, lengthSize } = archive;
  const own: Uint8Array[] = [];
  let from = begin;
  for (let at = begin; at + 8 + 2 * lengthSize <= end;) {
    const inner = at + 4 + lengthSize;
    const object = view.getUint32(at, true) === ofObject && view.getUint32(inner, true) === objectId;
    const next = object ? inner + lengthAt(archive, at + 4) : at + 1;
    if (object && next <= end) {
      own.push(bytes.subarray(from, at));
      from = at = next;
    } else ++at;
  }
  return crc32(...own, bytes.subarray(from, end));
}

/** The data of the innermost chunk with these bytes, whose CRC, behind them, is right; null where there is none. */
function chunkAround(archive: Archive, first: number, end: number): { begin: number; end: number } | null {
  const { bytes, view, lengthSize } = archive;
  for (let at = first - 4 - lengthSize; at >= headSize; --at) {
    if (view.getUint32(at, true) !== classData) continue;
    const begin = at + 4 + lengthSize;
    const stop = begin + lengthAt(archive, at + 4) - 4;
    if (stop < end || stop + 4 > bytes.length) continue;
    return crcOf(archive, begin, stop) === view.getUint32(stop, true) ? { begin, end: stop } : null;
  }
  return null;
}

/** Puts numbers in the place of others, in a copy; null where that is not safe. `at`: one of `placesOf`. */
export function exchanged(bytes: Uint8Array, at: number, numbers: Float64Array): Uint8Array | null {
  const chunk = chunkAround(archiveOf(bytes), at, at + 8 * numbers.length);
  if (!chunk) return null;
  const result = bytes.slice();
  result.set(littleEndian(numbers), at);
  const archive = archiveOf(result);
  archive.view.setUint32(chunk.end, crcOf(archive, chunk.begin, chunk.end), true);
  return result;
}
