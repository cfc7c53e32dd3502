import type { App } from '../app';
import { writeKnead } from './knead_file';

const historyBytes = 16 * 2 ** 20; // of shapes, in a document
const longSession = 2000; // milliseconds of steps from which on a document carries its snapshot

/** Saving: what the browser downloads, in the formats of the menu. */
export class Saving {
  constructor(private readonly app: App) {}

  step = () => this.save(async (stem) => {
    download(await this.app.client.save(), `${stem}-sculpted.step`, 'model/step');
  });

  knead = () => this.save(async (stem) => {
    const { app } = this;
    const { snapshot, journal } = await app.client.snapshot(historyBytes, false);
    const { name, file } = app.documents;
    const long = app.computedTime > longSession;
    download(writeKnead({ name, source: file, journal, snapshot: long ? snapshot : null }), `${stem}.knead`, 'application/json');
  }, false);

  /** Into the Rhino file that was opened, or a new one. */
  rhino = () => this.save(async (stem) => {
    const { client, documents, state } = this.app;
    const { rhino } = await import('./rhino/client');
    const surfaces = [];
    for (const [k, { name, id }] of state!.surfaces.entries()) surfaces.push({ name: name || id, patch: await client.surface(k) });
    const source = documents.file?.kind === 'rhino' ? documents.file.bytes : null;
    const { bytes, beside } = await rhino.write(source, surfaces, state!.surfaces[0]?.unit ?? 'mm');
    download(bytes, `${stem}${source ? '-sculpted' : ''}.3dm`, 'model/vnd.3dm');
    if (beside.length > 0) {
      const some = beside.slice(0, 3).join('”, “') + (beside.length > 3 ? '”, “…' : '');
      return `Saved. Faces of a polysurface, or trimmed ones, cannot be exchanged: “${some}” lie beside it as surfaces on its layer.`;
    }
    return undefined;
  });

  script = () => this.save(async (stem) => {
    download(await this.app.client.journal(), `${stem}.json`, 'application/json');
  }, false);

  picture = (scale: number) => this.save(async (stem) => {
    download(await this.app.viewer.picture(scale), scale === 1 ? `${stem}.png` : `${stem}@${scale}x.png`, 'image/png');
  }, false);

  /** Says where a tool still holds the shape: `shape` is false for what holds the tools as well. */
  private async save(act: (stem: string) => Promise<string | undefined | void>, shape = true): Promise<void> {
    const { app } = this;
    await app.attempt(async () => {
      const stem = app.documents.name.replace(/\.[^.]*$/, '').replace(/[^\w.-]+/g, '_') || 'surface';
      const said = await act(stem);
      const { tools, last } = app.state!;
      const touched = tools.length > 0 && last !== null && (last.gap > 0 || last.contact > 0);
      const contact = 'Saved with a tool still in contact: the shape is the one it holds.';
      app.notify({ kind: 'info', text: [shape && touched ? contact : '', said ?? ''].filter(Boolean).join(' ') || 'Saved.' });
    });
  }
}

function download(content: Blob | Uint8Array | string, name: string, type: string): void {
  const blob = content instanceof Blob ? content : new Blob([content instanceof Uint8Array ? (content.slice().buffer as ArrayBuffer) : content], { type });
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
