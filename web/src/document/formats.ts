import { fileFormats } from '../engine/generated';

/** CAD formats that are opened, and written back as they came. */
const opened = fileFormats.filter(({ opens }) => opens);

/** The ending of the file's name, lower case, and its format. */
export function cadFormat(name: string): { ending: string; format: (typeof opened)[number] } | null {
  const ending = /\.[^.]*$/.exec(name)?.[0].toLowerCase() ?? '';
  const format = opened.find(({ endings }) => (endings as readonly string[]).includes(ending));
  return format ? { ending, format } : null;
}

/** Endings of all files that the studio reads. */
export const readEndings: readonly string[] = [...opened.flatMap(({ endings }) => endings), '.3dm', '.knead', '.png', '.jpg', '.jpeg'];

/** "STEP (.step, .stp, .p21), IGES (.igs, .iges), …". */
export const readFormats = opened.map(({ name, endings }) => `${name} (${endings.join(', ')})`).join(', ');
