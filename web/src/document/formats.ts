import { fileFormats } from '@knead/generated';

/** CAD formats that are opened, and written back as they came. */
const opened = fileFormats.filter(({ opens }) => opens);

/** How names of compressed files end, after what they would end in otherwise. */
const gzipEnding = /\.gz$/i;
const zipEnding = /(\.stp)z$/i;

/** The name of what a compressed file holds: "a.step" for "a.step.gz", "a.stp" for "a.stpZ". */
export const uncompressedName = (name: string): string => name.replace(gzipEnding, '').replace(zipEnding, '$1');

/** Whether bytes are a gzip file or a ZIP archive. */
export const isCompressed = (bytes: Uint8Array): boolean =>
  (bytes[0] === 0x1f && bytes[1] === 0x8b) || (bytes[0] === 0x50 && bytes[1] === 0x4b && bytes[2] === 3 && bytes[3] === 4);

/** The ending of the file's name, lower case but for ".stpZ", and its format. */
export function cadFormat(name: string): { ending: string; format: (typeof opened)[number] } | null {
  const plain = /\.[^.]*$/.exec(uncompressedName(name))?.[0].toLowerCase() ?? '';
  const format = opened.find(({ endings }) => (endings as readonly string[]).includes(plain));
  const ending = gzipEnding.test(name) ? `${plain}.gz` : zipEnding.test(name) ? '.stpZ' : plain;
  return format ? { ending, format } : null;
}

/** Endings of all files that the studio reads. */
export const readEndings: readonly string[] = [...opened.flatMap(({ endings }) => endings), '.stpz', '.gz', '.3dm', '.knead', '.png', '.jpg', '.jpeg'];

/** "STEP, IGES, …". */
export const readFormats = opened.map(({ name }) => name).join(', ');

/** Whether a file begins as those of STEP do, after what may stand before. */
export const isStep = (bytes: Uint8Array): boolean => new TextDecoder('latin1').decode(bytes.subarray(0, 4096)).includes('ISO-10303-21');
