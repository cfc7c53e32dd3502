import type { App } from '../app';

/** The panel's code and its module come over the network when it is first opened. */
export async function openLab(app: App): Promise<void> {
  try {
    const { toggleLab } = await import('./panel');
    await toggleLab(app);
  } catch (error) {
    app.notify({ kind: 'error', text: `The panel of basis functions could not be opened: ${error instanceof Error ? error.message : String(error)}`,
      remedy: 'check the connection and try again' });
  }
}
