import type { Host } from './host';

/** Requests the surroundings of the surfaces of the opened file; `current` is false once another file is open. */
export async function loadContext(host: Host, current: () => boolean): Promise<void> {
  await host.attempt(async () => {
    const { context, trims } = await host.client.context();
    if (!current()) return;
    host.showContext(context, trims);
    const skipped = context?.skipped.length ?? 0;
    if (skipped > 0) {
      host.notify({ kind: 'info', text: `${skipped === 1 ? 'One face' : `${skipped} faces`} round the surfaces could not be drawn (${context!.skipped[0]!.id}: ${context!.skipped[0]!.reason}). Nothing of the file is lost.` });
    }
  });
}
