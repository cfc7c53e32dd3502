import type { Host } from './host';

const mostListed = 3;

/** What the file holds beside what is shown; empty if that is all. */
export function notShown(leftOut: string[]): string {
  if (leftOut.length === 0) return '';
  const more = leftOut.length > mostListed ? ` And ${leftOut.length - mostListed} more, which knead info lists.` : '';
  return `Not shown: ${leftOut.slice(0, mostListed).join('. ')}.${more} Nothing of the file is lost.`;
}

/** Requests the surroundings of the surfaces of the opened file; `current` is false once another file is open. */
export async function loadContext(host: Host, current: () => boolean): Promise<void> {
  await host.attempt(async () => {
    const { context, trims } = await host.client.context();
    if (!current()) return;
    host.showContext(context, trims);
    const notice = notShown(context?.left_out ?? []);
    if (notice) host.notify({ kind: 'info', text: notice });
  });
}
