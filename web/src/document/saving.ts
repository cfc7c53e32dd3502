import { type EdgesInfo, fileFormats } from '@knead/generated';
import { type Command, KneadError, type MeshFormat } from '../engine/session_types';
import { closedEdges, partedEdges } from './closed_edges';
import type { Documents } from './documents';
import { changedSince, replaceFile } from './disk';
import { download } from './download';
import { cadFormat, isCompressed, uncompressedName } from './formats';
import type { Host } from './host';
import { writeKnead } from './knead_file';
import { format, unitInWords } from './units';

const historyBytes = 16 * 2 ** 20; // of memory that states take, in a document
const longSession = 2000; // milliseconds of steps from which a document includes its snapshot

const openEdges = 'open edges'; // topic of messages

interface Saved {
  bytes: Uint8Array;
  edges: EdgesInfo[];
}

/** What a Rhino file does not hold of a document that began with a file of this kind; empty if nothing is lost. */
export function lostInRhino(kind: 'step' | 'rhino' | null, within: readonly string[], beside: readonly string[]): string {
  const some = (names: readonly string[]) => `“${names.slice(0, 3).join('”, “')}${names.length > 3 ? '”, “…' : ''}”`;
  return [
    kind === 'step' ? 'Trims, solids, and faces on planes, cylinders and the like are not written.' : '',
    within.length > 0 ? `${some(within)}: the edges stay where they were in the file. RebuildEdges in Rhino brings them back to the surface.` : '',
    beside.length > 0 ? `${some(beside)}: the polysurface keeps its old face. The new surface is written beside it, on the same layer.` : '',
  ].filter(Boolean).join(' ');
}

/** Saving: the downloads, in the formats of the menu. */
export class Saving {
  constructor(private readonly host: Host, private readonly documents: Documents) {
    documents.saveDocument = async () => (await this.knead()) !== null;
  }

  /** Where the file that was opened is known, into it; else as a download. */
  cad = () => (this.documents.place ? this.inPlace() : this.copy());

  /** As a download of the kind that was opened. */
  copy = () => (this.documents.file?.kind === 'rhino' ? this.rhino() : this.step());

  /** `open`: also where edges of its faces are. */
  inPlace = async (open = false): Promise<true | null> => {
    const { host, documents } = this;
    const place = documents.place!;
    const { name } = place.file;
    if (await changedSince(place)) {
      const choice = await host.ask({
        title: `Replace “${name}”?`,
        text: 'Another program has changed it since it was opened; what it wrote would be lost.',
        choices: [{ id: 'copy', label: 'Save a copy', about: 'as a download' }, { id: 'replace', label: 'Replace it' }],
      });
      if (choice !== 'replace') return choice === 'copy' ? this.step() : null;
    }
    return this.work(async () => {
      const found = await this.closed(open, () => this.inPlace(true));
      if (!found) return null;
      const { bytes, edges } = found;
      documents.place = await replaceFile(place, bytes);
      return [`Saved in “${name}”.`, closedEdges(edges, this.unit)].filter(Boolean).join(' ');
    });
  };

  step = (open = false): Promise<true | null> => this.work(() => this.download(open));

  private async download(open: boolean): Promise<string | null> {
    const stem = this.stem();
    const found = await this.closed(open, () => this.step(true));
    if (!found) return null;
    const { bytes, edges } = found;
    const { file } = this.documents;
    const cad = file?.kind === 'step' ? cadFormat(file.name) : null; // it comes back as what it was
    const type = isCompressed(bytes) ? (bytes[0] === 0x1f ? 'application/gzip' : 'application/zip') : cad?.format.media_type;
    download(bytes, `${stem}-sculpted${cad?.ending ?? '.step'}`, type ?? 'model/step');
    return closedEdges(edges, this.unit);
  }

  private get unit(): string {
    return this.host.state!.surfaces[0]?.unit ?? '';
  }

  /** The file as it is now; null where edges are open, which nobody has said that they may be. `again` saves it with them. */
  private async closed(open: boolean, again: () => Promise<unknown>): Promise<Saved | null> {
    const { host } = this;
    const refuse = (what: string, commands: Command[] | null) => {
      const anyway = () => void host.attempt(async () => {
        if (commands) await host.client.execute(commands);
        await again();
      });
      host.notify({ kind: 'error', topic: openEdges, text: `Not saved: ${what}.`,
        actions: [...(commands ? [] : [{ label: 'Show them', act: () => host.showEdges() }]), { label: 'Save with open edges', act: anyway }] });
      return null;
    };
    try {
      const found = await this.saved();
      const parted = open ? '' : partedEdges(found.edges, this.unit);
      return parted ? refuse(parted, null) : found;
    } catch (error) {
      if (!(error instanceof KneadError) || error.info.code !== 'edge_left_open') throw error;
      const { values, fixes } = error.info, commands = fixes.find(({ code }) => code === 'let_open')?.commands;
      if (open && commands) { // allowed: one face after the other
        await host.client.execute(commands);
        return this.closed(open, again);
      }
      return refuse(`edge ${values!.edge} parted by ${format(values!.distance!)} ${unitInWords(this.unit)}`, commands ?? []);
    }
  }

  /** The file as it is now, compressed as it came. */
  private async saved(): Promise<Saved> {
    const { client } = this.host;
    const { file: bytes, edges } = await client.query('save');
    const { file } = this.documents;
    if (file?.kind !== 'step' || !isCompressed(file.bytes)) return { bytes, edges };
    const { packedLike } = await import('@knead/compressed');
    return { bytes: await packedLike(bytes, file.bytes), edges };
  }

  private stem(): string {
    return uncompressedName(this.documents.name).replace(/\.[^.]*$/, '').replace(/[^\w.-]+/g, '_') || 'surface';
  }

  knead = () => this.work(async (stem) => {
    const { host } = this;
    const { snapshot, journal } = await host.client.snapshot(historyBytes, false);
    const { name, file, views } = this.documents;
    const long = host.computedTime > longSession;
    download(writeKnead({ name, source: file, journal, snapshot: long ? snapshot : null, views }), `${stem}.knead`, 'application/json');
  }, false);

  /** Into the Rhino file that was opened, or a new one. */
  rhino = () => this.work(async (stem) => {
    const { client, state } = this.host;
    const { file } = this.documents;
    const { patchOfNumbers, rhino } = await import('./rhino/client');
    const surfaces = [];
    for (const [k, { name, id }] of state!.surfaces.entries()) surfaces.push({ name: name || id, patch: patchOfNumbers(await client.query('surface', { surface: k })) });
    const source = file?.kind === 'rhino' ? file.bytes : null;
    const { bytes, beside, within } = await rhino.write(source, surfaces, state!.surfaces[0]?.unit ?? 'mm');
    const lost = lostInRhino(file?.kind ?? null, within, beside);
    if (lost) {
      const choice = await this.host.ask({ title: 'Save the Rhino file?', text: lost,
        choices: [{ id: 'rhino', label: 'Save the Rhino file' }, { id: 'step', label: 'Save a STEP file instead' }] });
      if (choice === 'step') await this.step();
      if (choice !== 'rhino') return null;
    }
    download(bytes, `${stem}${source ? '-sculpted' : ''}.3dm`, 'model/vnd.3dm');
    return undefined;
  });

  /** All surfaces as one mesh, as fine as the pictures are. */
  mesh = (format: MeshFormat) => this.save(async (stem) => {
    const { endings, media_type } = fileFormats.find(({ id }) => id === format)!;
    download((await this.host.client.query('file', { name: stem + endings[0], detail: this.host.detail })).file, stem + endings[0], media_type);
  });

  script = () => this.save(async (stem) => {
    download(await this.host.client.query('script'), `${stem}.json`, 'application/json');
  }, false);

  picture = (scale: number) => this.save(async (stem) => {
    download(await this.host.picture(scale), scale === 1 ? `${stem}.png` : `${stem}@${scale}x.png`, 'image/png');
  }, false);

  /** What saves all work. */
  private async work(...how: Parameters<Saving['save']>): Promise<true | null> {
    const done = await this.save(...how);
    if (done) this.documents.saved();
    return done;
  }

  /** Says where a tool still holds the shape: `shape` is false for what holds the tools as well. */
  private async save(act: (stem: string) => Promise<string | null | undefined | void>, shape = true): Promise<true | null> {
    const { host } = this;
    let saved = true;
    const done = await host.attempt(async () => {
      const said = await act(this.stem());
      if (said === null) { // the user has been told
        saved = false;
        return;
      }
      const { tools, last } = host.state!;
      const touched = tools.length > 0 && last !== null && (last.gap > 0 || last.contact > 0);
      const contact = 'Saved with a tool still in contact: the shape is the one it holds.';
      if (shape) host.settle(openEdges);
      host.notify({ kind: 'info', text: [shape && touched ? contact : '', said ?? ''].filter(Boolean).join(' ') || 'Saved.' });
    });
    return done && saved ? done : null;
  }
}
