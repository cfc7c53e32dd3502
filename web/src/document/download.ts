/** Has the browser save a file. */
export function download(content: Blob | Uint8Array | string, name: string, type: string): void {
  const blob = content instanceof Blob ? content : new Blob([content instanceof Uint8Array ? (content.slice().buffer as ArrayBuffer) : content], { type });
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
