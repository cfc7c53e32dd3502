import type { App } from '../app';

/** The panel's code, its worker and its module come over the network when it is first opened; `file`: an image to show. */
export async function openSnakes(app: App, file?: File): Promise<void> {
  try {
    const { showSnakes } = await import('./panel');
    await showSnakes(app, file);
  } catch (error) {
    app.notify({ kind: 'error', text: `The panel of images could not be opened: ${error instanceof Error ? error.message : String(error)}`,
      remedy: 'check the connection and try again' });
  }
}

/** Whether keys are the panel's. */
export const snakesAreOpen = (): boolean => document.querySelector('.snakes') !== null;
