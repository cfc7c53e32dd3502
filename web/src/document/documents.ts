import type { End } from '../engine/client';
import type { NewCommand } from '@knead/generated';
import { type Command, KneadError } from '../engine/session_types';
import { autosave, isReadable, type Kept, olderDocument } from './autosave';
import { loadContext } from './context';
import type { OnDisk } from './disk';
import { download } from './download';
import { isDataName, isTableOfPoints } from './data_files';
import { cadFormat, isCompressed, isStep, readFormats } from './formats';
import type { Host } from './host';
import { Keeper } from './keeper';
import { isNet, type KneadDocument, readKnead, type Source } from './knead_file';
import { makeReady } from './ready';
import type { SavedView } from './saved_views';

/** Opening: a file, a scene, or what a tab left behind. Saving is in `saving.ts`. */
export class Documents {
  readonly keeper: Keeper;
  /** The file that the session began with; null if it began without one. */
  file: Source | null = null;
  name = 'sheet';
  /** What the user wants to see again. */
  views: readonly SavedView[] = [];
  /** How many sessions there were: what was said about one before is of no use any more. */
  sessions = 0;
  /** Files and scenes that the user chose, opened or refused. */
  handled = 0;

  constructor(private readonly host: Host) {
    this.keeper = new Keeper(host, this);
  }

  /** The bytes of the CAD file that was opened, unpacked; null where there is none. */
  opened = async (): Promise<Uint8Array | null> => (this.file?.kind === 'step' ? plain(this.file.bytes) : null);

  /** Data that the faces of the open document may follow; false where there is none to follow them. */
  follow: (file: File) => Promise<boolean> = () => Promise.resolve(false);
  /** Saves a Knead document; false where nothing was saved. */
  saveDocument: () => Promise<boolean> = () => Promise.resolve(false);
  private disk: { source: Source; place: OnDisk } | null = null;
  private worked = false;
  private picked = false;
  /** What the session began with, once more. */
  private reopen: (() => Promise<unknown>) | null = null;

  /** What the session has selected of an opened file is not yet what the user has chosen: the next click chooses. */
  get waiting(): boolean {
    const { state } = this.host;
    if (!this.file || !state) return false;
    // The surfaces of a Rhino file are made one after the other: the last one happens to be selected.
    const atStart = this.file.kind === 'rhino' && state.surfaces.length > 1 && !state.undo;
    return !this.picked || atStart;
  }

  /** The user has chosen a surface. */
  pick(): void {
    this.picked = true;
  }

  /** These commands are the user's work, which opening something else must not lose. */
  work(commands: readonly Command[]): void {
    this.worked ||= commands.some((c) => !['undo', 'redo', 'select'].includes(c.do));
    this.keeper.touch();
  }

  /** Keeps a view, in the place of one of the same name; null forgets it. */
  keepView(name: string, view: SavedView | null): void {
    const known = this.views.some((v) => v.name === name);
    if (!view) this.views = this.views.filter((v) => v.name !== name);
    else this.views = known ? this.views.map((v) => (v.name === name ? view : v)) : [...this.views, view];
    this.keeper.touch();
    this.host.changed();
  }

  /** The CAD file on the disk that is open, and may be replaced. */
  get place(): OnDisk | null {
    return this.disk && this.disk.source === this.file ? this.disk.place : null;
  }
  set place(place: OnDisk | null) {
    this.disk = place && this.file ? { source: this.file, place } : null;
  }

  /** All work is in a file. */
  saved(): void {
    this.worked = false;
  }

  /** Asks before something else is opened over unsaved work. */
  private async mayLeave(): Promise<boolean> {
    if (!this.worked || !this.host.state?.undo) return true;
    const choice = await this.host.ask({
      title: 'Open something else?',
      text: `“${this.name}” has changes that are not saved. Its session stays in the list of recent ones.`,
      choices: [{ id: 'save', label: 'Save and open', about: 'as a Knead document' }, { id: 'open', label: 'Open without saving' }],
    });
    return choice === 'save' ? this.saveDocument() : choice === 'open';
  }

  /** `handle`: the file on the disk, where the browser gives one. */
  async openFile(file: File, handle: FileSystemFileHandle | null = null): Promise<void> {
    const before = this.file;
    await this.read(file);
    if (this.file !== before) this.disk = this.file?.kind === 'step' && handle ? { source: this.file, place: { file, handle } } : null;
    ++this.handled;
    this.host.changed();
  }

  /** The first of several files that is a document, then the data that it may follow. */
  async openFiles(files: readonly File[], handles: readonly Promise<FileSystemFileHandle | null>[]): Promise<void> {
    const isData = (file: File) => files.length > 1 && isDataName(file.name);
    const document = files.find((file) => !isData(file));
    for (const file of [...(document ? [document] : []), ...files.filter(isData)]) await this.openFile(file, await handles[files.indexOf(file)]!);
  }

  private async read(file: File): Promise<void> {
    const { host } = this;
    const bytes = async () => new Uint8Array(await file.arrayBuffer());
    const net = /\.json$/i.test(file.name) && isNet(await file.text().catch(() => ''));
    if (!net && /\.(knead|json)$/i.test(file.name)) {
      await host.attempt(async () => {
        const document = readKnead(await file.text());
        if (document.script) await this.openScript(document.commands, file.name);
        else if (await this.mayLeave()) await this.openDocument(document);
      });
    } else if (await this.isData(file)) {
      if (await this.follow(file)) return;
      host.notify({ kind: 'error', text: `“${file.name}” is data that faces can follow, and no CAD file is open.`, remedy: 'Open the CAD file first, then drop the data.' });
    } else if (cadFormat(file.name)) {
      if (await this.mayLeave()) await this.openStep(await bytes(), file.name);
    } else if (/\.3dm$/i.test(file.name)) {
      if (await this.mayLeave()) await this.openRhino(await bytes(), file.name);
    } else if (/\.(png|jpe?g)$/i.test(file.name)) {
      await host.openImage(file);
    } else {
      host.notify({ kind: 'error', text: `“${file.name}” is not a kind of file that the studio reads.`,
        remedy: `Open a ${readFormats} or Rhino file, a Knead document or an image.` });
    }
  }

  /** Points and meshes; a table in CSV may also be the net of a surface. */
  private async isData(file: File): Promise<boolean> {
    if (!isDataName(file.name)) return false;
    return !cadFormat(file.name) || isTableOfPoints(new Uint8Array(await file.arrayBuffer()));
  }

  /** Commands alone: only the user knows what they are meant for. */
  private async openScript(commands: Command[], name: string): Promise<void> {
    const { host } = this;
    const lost = this.worked && host.state?.undo ? `; “${this.name}” stays in the list of recent sessions` : '';
    const choice = !host.state ? 'fresh' : await host.ask({
      title: `Run the script “${name}”?`,
      text: `It holds ${commands.length === 1 ? 'one command' : `${commands.length} commands`}, and no document of its own.`,
      choices: [
        { id: 'apply', label: `Apply to “${this.name}”`, about: 'One undo takes all of it back' },
        { id: 'fresh', label: 'New document', about: `Runs it on an empty document${lost}` },
      ],
    });
    if (choice === 'fresh') await this.replay(name, null, commands);
    if (choice !== 'apply') return;
    await host.client.execute([...(await host.client.query('script_opening')), ...commands]);
    this.work(commands);
  }

  /** A ready scene: commands on an empty document, or on a file of the page; without them its first surface is chosen. False where the work before is to stay. */
  async openScene(name: string, commands: Command[], fetchFile?: () => Promise<Uint8Array | null>): Promise<boolean> {
    const opened = await this.readScene(name, commands, fetchFile);
    ++this.handled;
    return opened;
  }

  private async readScene(name: string, commands: Command[], fetchFile?: () => Promise<Uint8Array | null>): Promise<boolean> {
    if (!(await this.mayLeave())) return false;
    if (!fetchFile) return (await this.startFresh(name, commands)) !== null;
    const bytes = await fetchFile();
    return bytes !== null && (await this.openStep(bytes, name, commands)) !== null;
  }

  private async openStep(bytes: Uint8Array, name: string, scene: Command[] | null = null): Promise<true | null> {
    const { host } = this;
    return host.attempt(async () => {
      await this.begin(name, { kind: 'step', name, bytes }, async () => openedAs(await plain(bytes), name, (content) => host.client.open(content, name)));
      if (!scene) {
        await this.firstLook();
        return;
      }
      if (scene.length > 0) await host.client.execute(scene, false, true);
      else await makeReady(host, 0, true);
      this.pick();
      host.changed();
    });
  }

  private async openRhino(bytes: Uint8Array, name: string): Promise<true | null> {
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
        return { do: 'new', name: label, unit: unit as NewCommand['unit'], ...rest, ...(weights ? { weights } : {}) };
      });
      await this.begin(name, { kind: 'rhino', name, bytes }, () => host.client.fresh(name, create));
      if (left) host.notify({ kind: 'info', text: left });
      await this.firstLook();
    });
  }

  private async startFresh(name: string, commands: Command[]): Promise<true | null> {
    const { host } = this;
    return host.attempt(() => this.begin(name, null, () => host.client.fresh(name, commands)));
  }

  private async openDocument(document: KneadDocument): Promise<void> {
    await this.begunDocument(document);
    this.views = document.views;
    if (document.commands.length > 0) this.pick();
  }

  private async begunDocument({ name, source, commands, snapshot }: KneadDocument): Promise<void> {
    if (snapshot && (await this.restored(name, source, snapshot, preparation(commands)))) {
      // What the snapshot holds must be what the commands say.
      const same = canonical(JSON.parse(await this.host.client.query('journal')) as Command[]) === canonical(commands);
      if (same) return;
    }
    await this.replay(name, source, commands);
  }

  private replay(name: string, source: Source | null, commands: Command[]): Promise<void> {
    const { client } = this.host;
    // The surfaces of a Rhino file are among the commands.
    return this.begin(name, source, async () =>
      source?.kind === 'step' ? client.open(await plain(source.bytes), source.name, commands, preparation(commands)) : client.fresh(name, commands, preparation(commands)));
  }

  private async restored(name: string, source: Source | null, snapshot: Uint8Array, opened: number, again = false): Promise<boolean> {
    const step = source?.kind === 'step' ? source : null;
    try {
      await this.begin(name, source, async () => this.host.client.restore(step && (await plain(step.bytes)), step?.name ?? name, snapshot, opened), again);
      return true;
    } catch {
      return false; // of another version, or damaged: the commands suffice
    }
  }

  /** What a tab left behind continues here, as the same session. */
  async recover(kept: Kept): Promise<void> {
    if (!isReadable(kept)) this.sayUnreadable(kept);
    else if (await this.mayLeave()) await this.host.attempt(() => this.goOn(kept));
  }

  /** It stays where it is kept, and can be taken out of the browser. */
  private sayUnreadable(kept: Kept): void {
    const take = async () => {
      const source = kept.hasSource ? ((await autosave.source(kept.id)) ?? null) : null;
      download(olderDocument(kept, source), `${kept.name.replace(/\.[^.]*$/, '')}.knead`, 'application/json');
    };
    this.host.notify({ kind: 'error', text: `“${kept.name}” was kept by an older studio, whose sessions this one does not read. It stays in the list of recent ones.`,
      remedy: 'Download it: the studio that kept it opens it, and docs/scripts.md says how its commands are translated.',
      actions: [{ label: 'Download', act: () => void this.host.attempt(take) }] });
  }

  private async goOn(kept: Kept, again = false): Promise<void> {
    const { host } = this;
    const mine = again || (await this.keeper.claim(kept.id));
    const commands = JSON.parse(kept.journal) as Command[];
    const source = kept.hasSource ? ((await autosave.source(kept.id)) ?? null) : null;
    if (!(await this.restored(kept.name, source, kept.snapshot, kept.opened, again))) {
      await this.replay(kept.name, source, commands);
      host.notify({ kind: 'info', text: 'The snapshot is of another version of the studio: the commands were done again.' });
    }
    this.pick();
    this.views = kept.views;
    if (mine) this.keeper.begin(kept.id, true);
    else {
      this.keeper.touch(); // under an id of its own
      host.notify({ kind: 'info', text: `“${kept.name}” is open in another tab: this is a copy, which is kept on its own.` });
    }
    if (!again) await this.endStroke();
    host.changed();
  }

  /** A stroke that was cut off ends here: its ball does not stay in the scene. */
  private async endStroke(): Promise<void> {
    const { client } = this.host;
    // Asked of the engine: the frame on the screen may be an earlier one.
    const commands = JSON.parse(await client.query('journal')) as Command[];
    const last = commands.filter((c) => (c.do === 'tool' && c.name === 'brush') || (c.do === 'remove' && c.tool === 'brush')).at(-1);
    if (last?.do === 'tool') await client.execute([{ do: 'remove', tool: 'brush' }], true);
  }

  /** What the engine had done after the copy that it goes on from. False where something is missing. */
  private async repeat(): Promise<boolean> {
    const { client } = this.host;
    const { acts, all } = client.acts.toRepeat;
    for (const { commands, join, opening } of acts) {
      try {
        await client.execute(commands, join, opening);
      } catch (error) {
        if (!(error instanceof KneadError) || error.info.kind === 'died') throw error; // else it failed before, too
      }
    }
    return all;
  }

  /** The engine has stopped, and an empty one is there: the session goes on from its last copy, or as it was opened. */
  async revive(end: End): Promise<void> {
    const { host, reopen, worked, picked } = this;
    if (!reopen) return;
    await host.attempt(async () => {
      const copy = await this.keeper.lastCopy();
      if (copy) await this.goOn(copy, true);
      else await this.begin(this.name, this.file, reopen, true);
      const all = await this.repeat();
      await this.endStroke();
      host.client.acts.repeated();
      Object.assign(this, { worked, picked });
      const from = copy ? `the copy of ${new Date(copy.when).toLocaleTimeString()}` : 'the document as it was opened';
      if (end === 'stopped') host.notify({ kind: 'info', text: all ? 'Stopped: the document is as it was before.' : `Stopped: the document is that of ${from}.` });
      else host.notify({ kind: 'info', text: `The engine stopped, and was started again with ${all ? 'everything that was done before' : from}.` });
      this.keeper.touch();
      host.changed();
    });
  }

  /** Begins a session; where `act` fails the one before goes on. */
  private async begin(name: string, file: Source | null, act: () => Promise<unknown>, again = false): Promise<void> {
    await this.keeper.finish();
    const goOn = this.host.begin(again);
    try {
      await act();
    } catch (error) {
      goOn();
      throw error;
    }
    this.name = name;
    this.file = file;
    if (!again) this.views = [];
    this.reopen = act;
    ++this.sessions;
    this.worked = this.picked = false;
    this.keeper.begin();
    this.host.showContext(null, []);
    this.askForContext();
    this.host.changed();
  }

  /** The surroundings are others: another file, or faces of it that have become surfaces of the session. */
  askForContext(): void {
    const { file } = this;
    this.host.forgetEdges();
    if (file?.kind === 'step') void loadContext(this.host, () => this.file === file);
  }

  /** A single surface is made ready to sculpt; among several the user chooses. */
  private async firstLook(): Promise<void> {
    const { host } = this;
    const { surfaces, bodies, body } = host.state!;
    if (surfaces.length === 0 && bodies.length > 0) {
      const text = `${bodies.length} curves and no spline surface: choose a curve in the list of surfaces.`;
      host.notify({ kind: 'info', text: body === null ? text : 'The file’s only curve is selected: put a tool beside it, and step.' });
    } else if (surfaces.length === 0) {
      host.notify({ kind: 'info', text: 'None of the faces is a spline surface yet: click one to make it one.' });
    } else if (surfaces.length === 1) {
      await makeReady(host, 0, true);
      host.notify({ kind: 'info', text: 'Click the surface to sculpt it.' });
    } else if (host.state!.selection.length === 0 || this.file?.kind === 'rhino') {
      host.notify({ kind: 'info', text: `${surfaces.length} surfaces: click the one to sculpt.` });
    }
  }
}

/** The bytes for the engine, which unpacks nothing. */
const plain = async (bytes: Uint8Array): Promise<Uint8Array> => (isCompressed(bytes) ? (await import('@knead/compressed')).unpacked(bytes) : bytes);

/** Says of a file that is none of STEP what its name promises; `open` throws for every file that the engine does not read. */
async function openedAs(content: Uint8Array, name: string, open: (content: Uint8Array) => Promise<unknown>): Promise<unknown> {
  try {
    return await open(content);
  } catch (error) {
    if (!(error instanceof KneadError) || cadFormat(name)?.format.id !== 'step' || isStep(content)) throw error;
    throw new KneadError({ ...error.info, place: '', what: `“${name}” is not a STEP file.`, remedy: 'Export the model again, as a STEP file.' });
  }
}

/** How many commands at the start only make and prepare what is sculpted: they are the document as it is opened. */
function preparation(commands: readonly Command[]): number {
  const prepares = (c: Command) => ['new', 'select', 'convert', 'hold', 'edge', 'material', 'evolve', 'load', 'refine', 'elevate', 'freeze', 'pin', 'symmetry', 'seams', 'limit',
    'scaling'].includes(c.do) || (c.do === 'tool' && c.name !== 'brush');
  const first = commands.findIndex((c) => !prepares(c));
  return first < 0 ? commands.length : first;
}

const canonical = (commands: Command[]): string =>
  JSON.stringify(commands.map((c) => Object.entries(c).sort(([a], [b]) => (a < b ? -1 : 1))));
