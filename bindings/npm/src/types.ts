// What every entry exports beside its doors.
export { KneadError, type Values } from './errors.js';
export type { Working } from './commands.js';
export type { FileOptions, PictureOptions, Report, Script, Snapshot, SurfaceShape } from './document.js';
export type { CreateOptions, FileBytes, OpenOptions } from './opening.js';
export { fileFormats } from './generated.js';
export type * from './generated.js';
