import type { Notice } from '../document/host';
import { creaseIn, looseIn, throughIn } from '../document/words';
import type { Command, NoteInfo } from '../engine/session_types';

/** What telling needs of the page. */
interface Page {
  notify(notice: Notice): void;
  settle(topic: string): void;
  execute(commands: Command[]): Promise<true | null>;
  /** The last act again, changed, after commands that undo it. */
  again(before: Command[], change?: (command: Command) => Command): Promise<void>;
}

/** What the notes of the session say to the user: each once, and no longer than it is so. */
export class Notes {
  private topics = new Set<string>();

  constructor(private readonly page: Page) {}

  /** `quiet`: nothing new is said, as a stroke or steps are under way. */
  tell(notes: readonly NoteInfo[], quiet: boolean): void {
    if (quiet) return;
    const { page } = this;
    const all = notes.flatMap((note): Notice[] => {
      const crease = creaseIn(note), loose = looseIn(note), through = throughIn(note);
      if (crease) {
        const { text, remedy, seam, actions } = crease;
        return [{ kind: 'info', text, topic: `crease ${seam}`, remedy, actions: actions.map(({ label, commands }) => ({ label, act: () => void page.again(commands) })) }];
      }
      if (loose) {
        const { text, actions, surfaces } = loose;
        return [{ kind: 'info', text, topic: `loose ${surfaces}`, actions: actions.map(({ label, commands }) => ({ label, act: () => void page.execute(commands) })) }];
      }
      if (!through) return [];
      const goOn = { label: 'Go through', act: () => void page.again([{ do: 'undo' }], (c) => ('allow' in c ? { ...c, allow: 'through' } as Command : c)) };
      return [{ kind: 'info', text: through.text, topic: `through ${through.text}`, actions: through.stopped ? [goOn] : [] }];
    });
    const crease = all.find(({ topic }) => topic!.startsWith('crease ') && !this.topics.has(topic!)); // one of several seams at a time
    for (const notice of all) {
      if (!this.topics.has(notice.topic!) && (notice === crease || !notice.topic!.startsWith('crease '))) page.notify(notice);
    }
    const now = new Set(all.map(({ topic }) => topic!));
    for (const topic of this.topics) if (!now.has(topic)) page.settle(topic);
    this.topics = now;
  }
}
