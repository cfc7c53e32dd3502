import { autosave, type Kept } from '../document/autosave';
import type { App } from './app';
import { extent, when } from './recent_menu';

/** Shows at the lower edge what closed tabs have left behind: the last session first, the older ones on request. */
export async function offerRecovery(app: App): Promise<void> {
  const left = await app.documents.keeper.left().catch(() => []);
  const offer = (kept: Kept, older: Kept[]) =>
    app.notify({
      kind: 'info',
      ofPage: true,
      text: `“${kept.name}”, ${extent(kept)}, from ${when(kept)}, is still here.`,
      actions: [
        { label: 'Recover', act: () => void app.documents.recover(kept) },
        { label: 'Forget it', act: () => void autosave.forget(kept.id) },
        ...(older.length > 0 ? [{ label: `Older (${older.length})`, act: () => offer(older[0]!, older.slice(1)) }] : []),
      ],
    });
  if (left.length > 0) offer(left[0]!, left.slice(1));
}
