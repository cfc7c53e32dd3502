import { type Command, EngineError } from '../engine/session_types';
import { autosave, type Kept } from './autosave';
import { clay } from './clay';
import { loadContext } from './context';
import type { Host } from './host';
import { Keeper } from './keeper';
import { type KneadDocument, readKnead, type Source } from './knead_file';

/** Opening: a file, a scene, or what a tab left behind. Saving is in `saving.ts`. */
export class Documents {
  readonly keeper: Keeper;
  /** The file that the session began with; null if it began without one. */
  file: Source | null = null;
  name = 'sheet';
  /** Files that the user gave, opened or refused. */
  handled = 0;

  constructor(private readonly host: Host) {
    this.keeper = new Keeper(host, this);
  }

  async openFile(file: File): Promise<void> {
    await this.read(file);
    ++this.handled;
    this.host.changed();
  }

  private async read(file: File): Promise<void> {
    const { host } = this;
    const bytes = new Uint8Array(await file.arrayBuffer());
    if (/\.(knead|json)$/i.test(file.name)) {
      await host.attempt(async () => this.openDocument(readKnead(new TextDecoder().decode(bytes))));
    } else if (/\.(stp|step|p21)$/i.test(file.name)) {
      await this.openStep(bytes, file.name);
    } else if (/\.3dm$/i.test(file.name)) {
      await this.openRhino(bytes, file.name);
    } else {
      host.notify({ kind: 'error', text: `“${file.name}” is not a kind of file that the studio reads`,
        remedy: 'open a STEP file (.step, .stp), a Rhino file (.3dm) or a Knead document (.knead)' });
    }
  }

  async openStep(bytes: Uint8Array, name: string, commands: Command[] = []): Promise<true | null> {
    const { host } = this;
    return host.attempt(async () => {
      await this.begin(name, { kind: 'step', name, bytes }, () => host.client.open(bytes, name, JSON.stringify({ knead: 1, commands })));
      if (commands.length === 0) await this.firstLook();
    });
  }

  async openRhino(bytes: Uint8Array, name: string): Promise<true | null> {
    const { host } = this;
    return host.attempt(async () => {
      const { rhino } = await import('./rhino/client');
      const { surfaces, unit, otherUnit, skipped } = await rhino.read(bytes);
      const left = [
        skipped.length > 0 ? `Not sculptable, and left as they are: ${skipped.join(', ')}.` : '',
        otherUnit ? `The file's unit, ${otherUnit.toLowerCase()}, is not known here: its numbers are kept, and shown as ${unit}.` : '',
      ].filter(Boolean).join(' ');
      if (surfaces.length === 0) throw new Error(`“${name}” holds no surface. ${left} Open a file with surfaces or polysurfaces`);
      const create = surfaces.map(({ name: label, patch }): Command => {
        const { weights, ...rest } = patch;
        return { do: 'new', name: label, unit, ...rest, ...(weights ? { weights } : {}) };
      });
      await this.begin(name, { kind: 'rhino', name, bytes }, () => host.client.fresh(name, create));
      if (left) host.notify({ kind: 'info', text: left });
      await this.firstLook();
    });
  }

  async startFresh(name: string, commands: Command[]): Promise<true | null> {
    const { host } = this;
    return host.attempt(() => this.begin(name, null, () => host.client.fresh(name, commands)));
  }

  private async openDocument({ name, source, commands, snapshot }: KneadDocument): Promise<void> {
    if (snapshot && (await this.restored(name, source, snapshot))) {
      // What the snapshot holds must be what the commands say.
      const same = canonical((JSON.parse(await this.host.client.journal()) as { commands: Command[] }).commands) === canonical(commands);
      if (same) return;
    }
    await this.replay(name, source, commands);
  }

  private replay(name: string, source: Source | null, commands: Command[]): Promise<void> {
    const { client } = this.host;
    // The surfaces of a Rhino file are among the commands.
    return this.begin(name, source, () =>
      source?.kind === 'step' ? client.open(source.bytes, source.name, JSON.stringify({ knead: 1, commands })) : client.fresh(name, commands));
  }

  private async restored(name: string, source: Source | null, snapshot: Uint8Array): Promise<boolean> {
    const step = source?.kind === 'step' ? source : null;
    try {
      await this.begin(name, source, () => this.host.client.restore(step?.bytes ?? null, step?.name ?? name, snapshot));
      return true;
    } catch {
      return false; // of another version, or damaged: the commands suffice
    }
  }

  /** What a tab left behind continues here, as the same session. */
  async recover(kept: Kept): Promise<void> {
    const { host } = this;
    await host.attempt(async () => {
      const source = kept.hasSource ? ((await autosave.source(kept.id)) ?? null) : null;
      if (!(await this.restored(kept.name, source, kept.snapshot))) {
        host.notify({ kind: 'info', text: 'The snapshot is of another version of the studio: the commands are done again.' });
        await this.replay(kept.name, source, (JSON.parse(kept.journal) as { commands: Command[] }).commands);
      }
      this.keeper.begin(kept.id, true);
      // An interrupted stroke ends here: its ball does not stay in the scene.
      if (host.state?.tools.some((t) => t.name === 'brush')) await host.client.execute([{ do: 'remove', tool: 'brush' }], true);
      host.changed();
    });
  }

  /** Begins a session; if `act` fails, the previous one continues. */
  private async begin(name: string, file: Source | null, act: () => Promise<unknown>): Promise<void> {
    const goOn = this.host.begin();
    try {
      await act();
    } catch (error) {
      goOn();
      throw error;
    }
    this.name = name;
    this.file = file;
    this.keeper.begin();
    this.host.showContext(null, []);
    if (file?.kind === 'step') void loadContext(this.host, () => this.file === file);
    this.host.changed();
  }

  /** A single surface is made ready to sculpt; among several the user chooses. */
  private async firstLook(): Promise<void> {
    const { host } = this;
    const surfaces = host.state!.surfaces;
    if (surfaces.length === 1) await makeReady(host, 0, false);
    else if (host.state!.selection.length === 0 || this.file?.kind === 'rhino') {
      host.notify({ kind: 'info', text: `${surfaces.length} surfaces: click the one to sculpt.` });
    }
  }
}

const canonical = (commands: Command[]): string =>
  JSON.stringify(commands.map((c) => Object.entries(c).sort(([a], [b]) => (a < b ? -1 : 1))));

/**
 * Makes clay that is held at its edges of a selected surface as it came. What faces lie on is held along their edges, so
 * that they go on meeting their neighbours, and the brush fits between them; a surface alone by its outer rows. `join`: with
 * the act before.
 */
export async function makeReady(host: Host, index: number, join: boolean): Promise<void> {
  const surface = host.state!.surfaces[index]!;
  const room = surface.faces > 0 ? await host.client.room(index) : null;
  if (room) host.sizeBrush(0.5 * room);
  if (surface.hold > 0 || surface.pins > 0 || surface.constraints.length > 0 || surface.moved > 0) return;
  const rows = Math.min(2, Math.floor((Math.min(...surface.net) - 2) / 2));
  const alone: Command[] = [...(rows > 0 ? [{ do: 'hold', rows } as const] : []), ...clay];
  if (surface.faces === 0) {
    await host.client.execute(alone, join);
    return;
  }
  try {
    await host.client.execute([{ do: 'hold', mode: 'trim' }, ...clay], join);
  } catch (error) {
    if (!(error instanceof EngineError)) throw error;
    await host.client.execute(alone, join);
    host.notify({ kind: 'info', text: `Only the outer rows of control points are held: ${error.info.what}. Neighbouring faces may part from this one.` });
  }
}
