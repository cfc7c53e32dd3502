import { type Command, KneadError } from '../engine/session_types';
import { autosave, claim, heldIds, hold, isReadable, type Kept, keptForm } from './autosave';
import type { Host } from './host';
import type { Source } from './knead_file';
import type { SavedView } from './saved_views';

const pause = 800; // milliseconds without a change after which the session is kept
const mostUnkept = 1200; // milliseconds of computing after which it is kept in any case
const mostPlayed = 4000; // milliseconds of playing after which it is kept, however little was computed
const historyBytes = 48 * 2 ** 20; // of memory of states that undo can go back to after a recovery
const mostSessions = 6;
const retryTime = 20_000; // milliseconds after which it is tried again to keep what could not be kept

/**
 * Keeps the session in the browser: source, commands, and a snapshot of all states. A recovery recomputes only
 * what came after the last snapshot, which is never much more than `mostUnkept`.
 */
export class Keeper {
  private id = '';
  private release = () => {};
  private dirty = false;
  private sourceKept = false;
  private playing = false;
  private written = 0; // when writing last began
  private timer = 0;
  private writing: Promise<void> | null = null;
  private failed = 0; // when it could not be kept; 0: it could
  private claimed: { id: string; release: () => void } | null = null;

  constructor(private readonly host: Host, private readonly documents: { readonly file: Source | null; readonly name: string; readonly views: readonly SavedView[] }) {
    // Whatever is not saved yet when the page goes away: the browser completes a transaction that has begun.
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'hidden') void this.keep();
    });
  }

  /** From here on the session is another one: new, or restored. */
  begin(id: string = crypto.randomUUID(), sourceKept = false): void {
    clearTimeout(this.timer);
    const { claimed } = this;
    this.claimed = null;
    if (id !== this.id) {
      this.release();
      this.release = claimed?.id === id ? claimed.release : hold(id);
    }
    this.id = id;
    delete document.documentElement.dataset.kept;
    this.dirty = false;
    this.failed = 0;
    this.sourceKept = sourceKept;
  }

  /** Makes a session that was left behind this tab's; false where another tab has it open. */
  async claim(id: string): Promise<boolean> {
    this.claimed?.release();
    const release = await claim(id);
    this.claimed = release && { id, release };
    return release !== null;
  }

  /** Something changed. */
  touch(): void {
    this.dirty = true;
    delete document.documentElement.dataset.kept;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.keep(), pause);
  }

  /** A frame has arrived: so much has been computed since the last snapshot, including strokes and playing. */
  computed(unkept: number, playing: boolean): void {
    if (this.playing && !playing) this.touch();
    this.playing = playing;
    if (unkept <= mostUnkept && !(playing && performance.now() - this.written > mostPlayed)) return;
    this.dirty = true;
    void this.keep();
  }

  /** The copy of this session, if there is one. What is not in it is lost. */
  async lastCopy(): Promise<Kept | null> {
    clearTimeout(this.timer);
    this.dirty = false;
    await this.writing;
    return (await autosave.one(this.id)) ?? null;
  }

  /** Nothing of the session is left to keep: another may begin. */
  async finish(): Promise<void> {
    clearTimeout(this.timer);
    await this.writing;
    await this.keep();
  }

  /** One at a time; what changes meanwhile waits for the next. */
  async keep(): Promise<void> {
    if (!this.dirty) return;
    if (this.writing) return this.writing;
    if (this.failed > 0 && performance.now() - this.failed < retryTime) return;
    this.dirty = false;
    this.written = performance.now();
    this.writing = this.write();
    await this.writing;
    this.writing = null;
    if (this.dirty && this.failed === 0) this.touch();
  }

  private async write(): Promise<void> {
    const { id, host } = this;
    try {
      const { snapshot, journal, opened, mark } = await host.client.snapshot(historyBytes, true);
      if (id !== this.id) return; // another document since
      const commands = (JSON.parse(journal) as Command[]).length;
      const { file, name, views } = this.documents;
      const kept: Kept = { form: keptForm, id, name, when: Date.now(), commands, opened, journal, snapshot, hasSource: file !== null, views: [...views] };
      await autosave.write(kept, this.sourceKept ? null : file);
      this.sourceKept = true;
      host.client.acts.kept(mark);
      if (this.failed > 0) host.notify({ kind: 'info', text: 'The browser keeps a copy of this session again.' });
      this.failed = 0;
      if (id === this.id) document.documentElement.dataset.kept = String(commands);
    } catch (error) {
      if (error instanceof KneadError && error.info.kind === 'died') return; // goes on from the copy before
      this.dirty = true;
      const first = this.failed === 0;
      this.failed = performance.now();
      if (!first) return;
      const full = error instanceof DOMException && error.name === 'QuotaExceededError';
      host.notify(full
        ? { kind: 'error', text: 'The browser’s storage is full: no copy of this session is kept. The work goes on, and nothing that was kept before is lost.',
          remedy: 'Save a Knead document, and remove sessions from Recent.' }
        : { kind: 'error', text: `The browser could not keep a copy: ${String(error)}`, remedy: 'save a Knead document from time to time' });
    }
  }

  /** Sessions that no tab has open, newest first; those that are too old are dropped, but none that cannot be read. */
  async left(): Promise<Kept[]> {
    const held = await heldIds();
    const all = (await autosave.all()).filter((k) => k.id !== this.id && !held.has(k.id) && k.commands > 0).sort((a, b) => b.when - a.when);
    const old = all.filter(isReadable).slice(mostSessions);
    for (const { id } of old) await autosave.forget(id);
    return all.filter((k) => !old.includes(k));
  }
}
