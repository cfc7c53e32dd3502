// Modules that build.mjs makes.
declare module 'packed:engine' {
  /** knead.wasm, by gzip, in base 64. */
  const text: string;
  export default text;
}
declare module 'packed:thread' {
  /** thread.ts with all that it imports, a script for a worker. */
  const text: string;
  export default text;
}
