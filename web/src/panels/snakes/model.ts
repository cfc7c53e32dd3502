import { download } from '../../document/download';
import { KneadError } from '../../engine/session_types';
import type { App } from '../app';
import { SnakeClient } from './client';
import { greyImage, openImage, type Opened } from './files';
import type { ContourKind, Snakes } from './module';
import { Past } from './past';
import { type Place, type Preset, presetOf, presets, type Script, scriptText, type Spring, type Start, type Volcano } from './script';

export const tools = ['draw', 'ellipse', 'points', 'pull', 'volcano'] as const;
export type Tool = (typeof tools)[number];

/** What a script becomes. */
export type Change = (script: Script) => Script;

const none: Snakes = { states: [], ended: true, points: new Float32Array(), offsets: new Uint32Array([0]), net: new Float32Array(), netFrom: new Uint32Array([0]) };

const withSprings = (script: Script, k: number, springs: Spring[]): Script =>
  ({ ...script, snakes: script.snakes.map(({ springs: before, ...start }, i) => {
    const held = i === k ? springs : before ?? [];
    return held.length > 0 ? { ...start, springs: held } : start;
  }) });

/** An image, the snakes in it, and what the user has chosen. */
export class SnakeModel {
  readonly client = new SnakeClient();
  /** Drawn anew on these. */
  readonly onChange: (() => void)[] = [];
  /** Another image. */
  onImage: () => void = () => {};
  image: Opened | null = null;
  mask: string | null = null;
  energy: OffscreenCanvas | null = null;
  snakes: Snakes = none;
  running = false;
  tool: Tool = 'draw';
  /** Of what is drawn by hand. */
  closed = true;
  /** The ends of open ones that are drawn. */
  holdEnds = true;
  /** Springs stay where the hand lets go. */
  keepSprings = false;
  preset: Preset = presets[0]!;
  spring = presets[0]!.spring;
  volcano = presets[0]!.volcano;
  selected = 0;
  script: Script = { ...presetOf(presets[0]!), mask: '', volcanoes: [], snakes: [] };
  readonly past = new Past(this.client, () => {
    const { script, mask, preset, spring, volcano, selected } = this;
    return { script, mask, preset, spring, volcano, selected };
  });

  constructor(private readonly app: App) {
    this.client.onSnakes = (snakes, running) => {
      this.snakes = snakes;
      this.running = running;
      this.selected = Math.min(this.selected, Math.max(0, snakes.states.length - 1));
      this.changed();
    };
    this.client.onError = (error) => this.tell(new KneadError(error));
  }

  close(): void {
    this.client.close();
    this.image?.bitmap.close();
  }

  changed(): void {
    for (const draw of this.onChange) draw();
  }

  tell(error: unknown): void {
    const info = error instanceof KneadError ? error.info : null;
    const text = info ? `${info.where && !info.place ? `${info.where}: ` : ''}${info.what}` : error instanceof Error ? error.message : String(error);
    this.app.notify({ kind: 'error', text: text.charAt(0).toUpperCase() + text.slice(1), ...(info?.remedy ? { remedy: info.remedy } : {}) });
  }

  async open(file: File): Promise<void> {
    if (this.script.snakes.length > 0) {
      const choice = await this.app.ask({ title: 'Open another image?', text: `The snakes in “${this.image?.name ?? ''}” are lost unless you save them.`, choices: [{ id: 'open', label: 'Open it' }] });
      if (choice !== 'open') return;
    }
    const image = await openImage(file);
    await this.client.ask({ kind: 'image', pixels: image.pixels });
    this.image?.bitmap.close();
    this.past.clear();
    Object.assign(this, { image, mask: null, energy: null, snakes: none, selected: 0 });
    this.script = { ...this.script, mask: '', volcanoes: [], snakes: [] };
    if (image.reduced) this.app.notify({ kind: 'info', text: `“${image.name}” has 16 bits a channel: the browser reduces them to 8. The command line keeps all 16.` });
    this.onImage();
    this.changed();
  }

  async openMask(file: File): Promise<void> {
    const mask = await openImage(file);
    mask.bitmap.close();
    const { kept } = await this.client.ask({ kind: 'keep' });
    await this.past.entry(async () => {
      await this.client.ask({ kind: 'mask', pixels: mask.pixels });
      const before = this.mask;
      this.mask = mask.name;
      const image = this.script.image.distance === 0 ? { ...this.script.image, distance: 0.1 } : this.script.image;
      const taken = (await this.take({ ...this.script, mask: mask.name, image }, false, true)) === null;
      if (!taken) {
        this.mask = before;
        await this.client.ask({ kind: 'restore', kept: kept! }).then((now) => this.client.ask({ kind: 'forget', kept: [now.kept!] }));
      }
      return taken;
    });
    void this.client.ask({ kind: 'forget', kept: [kept!] });
    this.changed();
  }

  /** Changes the script, which can be taken back; false, and nothing has changed, if the engine refuses it. */
  async apply(change: Change, again = false): Promise<boolean> {
    return (await this.refusal(change, again, true)) === null;
  }

  /** Why the engine refuses a change; null if it takes it. After what was asked for before: an undo that is under way comes first. */
  async refusal(change: Change, again = false, tell = false): Promise<string | null> {
    let why: string | null = null;
    await this.past.next(() => this.past.entry(async () => (why = await this.take(change(this.script), again, tell)) === null));
    this.changed();
    return why;
  }

  /** The same without an entry of the history. */
  private async take(script: Script, again: boolean, tell: boolean): Promise<string | null> {
    try {
      if (script.snakes.length > 0) await this.client.ask({ kind: 'script', text: scriptText(script), again });
      else if (this.script.snakes.length > 0) await this.client.ask({ kind: 'clear' });
      this.script = script;
      if (script.snakes.length === 0) this.snakes = none;
      if (this.energy) await this.showEnergy(true);
      this.changed();
      return null;
    } catch (error) {
      if (tell) this.tell(error);
      return error instanceof KneadError ? [error.info.what, error.info.remedy].filter(Boolean).join(': ') : String(error);
    }
  }

  async choose(preset: Preset): Promise<void> {
    const { image, settings } = presetOf(preset), { spring, volcano } = preset;
    if (!(await this.apply((script) => ({ ...script, image: { ...image, distance: script.image.distance }, settings })))) return;
    Object.assign(this, { preset, spring, volcano });
    this.changed();
    await this.wake();
  }

  async add(start: Start): Promise<void> {
    if (await this.apply((script) => ({ ...script, snakes: [...script.snakes, start] }))) {
      this.selected = this.script.snakes.length - 1;
      this.changed();
    }
  }

  async remove(k: number): Promise<void> {
    await this.apply((script) => ({ ...script, snakes: script.snakes.filter((_, i) => i !== k) }));
  }

  async setVolcanoes(volcanoes: Volcano[]): Promise<void> {
    await this.apply((script) => ({ ...script, volcanoes }));
  }

  async setSprings(k: number, springs: Spring[]): Promise<void> {
    await this.apply((script) => withSprings(script, k, springs));
  }

  /** After what was asked for before, so that a snake that has just been drawn runs. */
  async run(on: boolean): Promise<void> {
    await this.past.next(async () => {
      const ask = () => this.client.ask({ kind: 'run', on });
      if (this.script.snakes.length === 0) this.app.notify({ kind: 'info', text: 'Draw a snake in the image first.' });
      else if (on && !this.running) await this.note(ask);
      else await this.attempt(ask);
    });
  }

  /** Does something that can be taken back, or says why it cannot be done. */
  private async note(act: () => Promise<unknown>): Promise<void> {
    await this.past.entry(async () => {
      try {
        await act();
        return true;
      } catch (error) {
        this.tell(error);
        return false;
      }
    });
    this.changed();
  }

  /** Takes back what was done last, or does it again. */
  async travel(back: boolean): Promise<void> {
    await this.attempt(() => this.past.travel(back, async (moment) => {
      Object.assign(this, moment);
      if (this.script.snakes.length === 0) this.energy = null;
      if (this.energy) await this.showEnergy(true);
      this.changed();
    }));
  }

  /** Goes on under new settings if it was going, or had come to rest. */
  private async wake(): Promise<void> {
    if (this.running) await this.run(true);
  }

  async again(): Promise<void> {
    await this.apply((script) => script, true);
  }

  /** `begins`: the first of a drag, which is taken back as one. */
  async pull(snake: number, at: number, to: Place, begins: boolean): Promise<void> {
    const ask = () => this.client.ask({ kind: 'pull', pull: { snake, at, to, strength: this.spring } });
    await (begins ? this.note(ask) : this.attempt(ask));
  }

  /** `springs`: those that the snake has from now on, where the hand's stays. */
  async letGo(snake?: number, springs?: Spring[]): Promise<void> {
    await this.attempt(() => this.client.ask({ kind: 'pull', pull: null }));
    if (snake !== undefined && springs) await this.take(withSprings(this.script, snake, springs), false, true);
  }

  async move(snake: number, point: number, to: Place, begins: boolean): Promise<void> {
    const ask = () => this.client.ask({ kind: 'move', snake, point, to });
    await (begins ? this.note(ask) : this.attempt(ask));
  }

  /** What attracts, as a picture over the image. */
  async showEnergy(on: boolean): Promise<void> {
    if (on && this.script.snakes.length === 0) {
      this.app.notify({ kind: 'info', text: 'The energy is computed with the first snake: draw one.' });
      return;
    }
    await this.attempt(async () => {
      this.energy = on ? greyImage((await this.client.ask({ kind: 'picture', of: 'energy' })).picture!) : null;
      this.changed();
    });
  }

  async saveContours(as: ContourKind): Promise<void> {
    await this.save(async (stem) => {
      const { text } = await this.client.ask({ kind: 'contours', as, image: this.image!.name });
      download(text!, `${stem}-contours.${as}`, { json: 'application/json', csv: 'text/csv', svg: 'image/svg+xml' }[as]);
    });
  }

  async saveMask(): Promise<void> {
    await this.save(async (stem) => {
      const { picture } = await this.client.ask({ kind: 'picture', of: 'mask' });
      download(await greyImage(picture!).convertToBlob({ type: 'image/png' }), `${stem}-mask.png`, 'image/png');
    });
  }

  async saveScript(): Promise<void> {
    await this.save((stem) => Promise.resolve(download(`${scriptText(this.script, 2)}\n`, `${stem}-snakes.json`, 'application/json')));
  }

  private async save(act: (stem: string) => Promise<void>): Promise<void> {
    if (this.script.snakes.length === 0) {
      this.app.notify({ kind: 'info', text: 'There is no snake to save yet: draw one in the image.' });
      return;
    }
    await this.attempt(() => act(this.image!.name.replace(/\.[^.]*$/, '').replace(/[^\w.-]+/g, '_') || 'image'));
  }

  private async attempt(act: () => Promise<unknown>): Promise<void> {
    try {
      await act();
    } catch (error) {
      this.tell(error);
    }
  }
}
