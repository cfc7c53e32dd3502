import type { App } from '../app';
import { h } from '../dom';

/** The panel *Follow data*: its code comes over the network when it is first opened, or when data are dropped. */
export function followDoor(app: App): HTMLElement {
  const element = h('details', { class: 'panel', data: { panel: 'Follow data' } }, h('summary', {}, 'Follow data'));
  let opened: ReturnType<typeof enter> | null = null;
  const enter = async () => (await import('./panel')).showFollowing(app, element);
  const open = async () => {
    try {
      return await (opened ??= enter());
    } catch (error) {
      opened = null;
      element.open = false;
      app.notify({ kind: 'error', text: `The panel of data could not be opened: ${error instanceof Error ? error.message : String(error)}`,
        remedy: 'check the connection and try again' });
      return null;
    }
  };
  const canFollow = () => (app.state?.surfaces.length ?? 0) + app.viewer.context.pieces.length > 0;
  element.addEventListener('toggle', () => {
    if (element.open) void open();
  });
  app.documents.follow = async (file) => {
    if (!canFollow()) return false;
    await (await open())?.add(file);
    return true;
  };
  app.onChange.push(() => (element.hidden = !canFollow()));
  return element;
}
