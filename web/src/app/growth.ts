import type { Notice } from '../document/host';
import { format, unitInWords } from '../document/units';
import type { Command, SessionInfo } from '../engine/session_types';

/** What telling needs of the page. */
interface Page {
  readonly diagonal: number;
  notify(notice: Notice): void;
  settle(topic: string): void;
  execute(commands: Command[]): Promise<true | null>;
}

const topic = 'refined';
const tolerance = 1e-4; // of the diagonal: how far reducing a net may move its surface

/** Says so where a stroke or steps have refined nets by themselves, and offers to reduce them again. */
export class Growth {
  private sizes = new Map<string, number>();
  private said = '';
  private busy = false;

  constructor(private readonly page: Page) {}

  /** Another session. */
  forget(): void {
    this.sizes.clear();
    this.busy = false;
  }

  /** `busy`: a stroke or steps are under way. */
  follow({ surfaces }: SessionInfo, busy: boolean): void {
    if (busy) {
      this.busy = true;
      return;
    }
    const { page } = this;
    const now = new Map(surfaces.map((s) => [s.id, s.net.join(' × ')]));
    const grown = this.busy ? surfaces.filter((s) => s.net[0]! * s.net[1]! > (this.sizes.get(s.id) ?? Infinity)) : [];
    if (this.said && this.said !== [...now].join()) {
      page.settle(topic);
      this.said = '';
    }
    if (grown.length > 0) {
      const within = Number((tolerance * page.diagonal).toPrecision(1));
      const names = grown.slice(0, 3).map((s) => `${s.name || s.id} was refined to ${now.get(s.id)} points`).join(', ');
      this.said = [...now].join();
      page.notify({
        kind: 'info', topic, passing: true, text: `${names}${grown.length > 3 ? `, and ${grown.length - 3} more` : ''}.`,
        actions: [
          { label: `Reduce within ${format(within)} ${unitInWords(grown[0]!.unit)}`, act: () => void page.execute([{ do: 'coarsen', tolerance: within }]) },
          { label: 'Undo', act: () => void page.execute([{ do: 'undo' }]) },
        ],
      });
    }
    this.busy = false;
    this.sizes = new Map(surfaces.map((s) => [s.id, s.net[0]! * s.net[1]!]));
  }
}
