import type { App } from '../app';

/** Asks for what stands round the surfaces of the opened file, once its first picture is there. */
export async function loadContext(app: App): Promise<void> {
  const { file } = app.documents;
  await app.attempt(async () => {
    const { context, trims } = await app.client.context();
    if (app.documents.file !== file) return; // another file by now
    app.viewer.showContext(context, trims);
    const skipped = context?.skipped.length ?? 0;
    if (skipped > 0) {
      app.notify({ kind: 'info', text: `${skipped === 1 ? 'One face' : `${skipped} faces`} round the surfaces could not be drawn (${context!.skipped[0]!.id}: ${context!.skipped[0]!.reason}). Nothing of the file is lost.` });
    }
  });
}
