import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gunzipSync, gzipSync } from 'node:zlib';

import { commands, distance, handled, openFile, positions, question, ready, root, scene, settled, stroke, studioOfFile, directoryOfFile, saveAs } from './page';

/** How far undo goes back, what a script is applied to, and what becomes of the session before. */

const studio = studioOfFile();
const directory = directoryOfFile();

const undoButton = () => studio.page.locator('button[aria-label^="Undo"]');
const undo = async (times: number) => {
  for (let k = 0; k < times; ++k) {
    await studio.page.keyboard.press('Control+z');
    await settled(studio.page);
  }
};
const file = (name: string, content: unknown): string => {
  const path = join(directory, name);
  writeFileSync(path, typeof content === 'string' ? content : JSON.stringify(content));
  return path;
};
const kept = async () => {
  const count = (await commands(studio.page)).length;
  await studio.page.waitForSelector(`html[data-kept="${count}"]`, { state: 'attached' });
};
const preset = () => studio.page.evaluate(() =>
  (window as never as { studio: { state: { surfaces: { preset: string | null }[] } } }).studio.state.surfaces.map((s) => s.preset));

it('asks about the document that it has opened, also where the one before was not drawn yet', async () => {
  const { page } = studio;
  const text = readFileSync(join(root, 'samples/bonnet.step'), 'utf8');
  await scene(page, 'Clay sheet');
  const seen = await page.evaluate(async (step) => {
    interface Page { state: { surfaces: { id: string }[] }; client: { execute(c: object[]): Promise<void> }; documents: { openFile(f: File): Promise<void> } }
    const { studio: app } = window as never as { studio: Page };
    const draw = window.requestAnimationFrame, waiting: FrameRequestCallback[] = [];
    window.requestAnimationFrame = (callback) => waiting.push(callback);
    try {
      await app.client.execute([{ do: 'hold', rows: 1 }]); // a frame that the page does not get to draw
      await app.documents.openFile(new File([step], 'bonnet.step'));
      return app.state.surfaces.map(({ id }) => id);
    } finally {
      window.requestAnimationFrame = draw;
      for (const callback of waiting) draw(callback);
    }
  }, text);
  expect(seen).toEqual(['#285', '#1044']);
  await settled(page);
  expect(await page.locator('.notice.error').count()).toBe(0);
  await scene(page, 'Clay sheet');
});

it('says in a sentence what is no STEP file, and keeps what is open', async () => {
  const { page } = studio;
  const before = await commands(page);
  await openFile(page, file('junk.step', 'not a model'));
  const error = page.locator('.notice.error');
  await expect.poll(() => error.locator('p').first().textContent()).toBe('“junk.step” is not a STEP file.');
  await error.getByRole('button', { name: 'Dismiss' }).click();
  await openFile(page, file('x.sldprt', ''));
  await expect.poll(() => error.textContent()).toContain('“x.sldprt” is not a kind of file that the studio reads.');
  expect(await error.textContent()).not.toMatch(/\.step|\.igs/);
  await error.getByRole('button', { name: 'Dismiss' }).click();
  expect(await commands(page)).toEqual(before);
});

describe('undo', () => {
  it('goes no further back than the sheet that the page begins with', async () => {
    const { page } = studio;
    const before = await commands(page);
    const flat = await positions(page);
    await undo(4);
    expect(await commands(page)).toEqual(before);
    expect(distance(await positions(page), flat)).toBe(0);
    expect(await preset()).toEqual(['clay']);
    expect(await undoButton().isDisabled()).toBe(true);
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [30, 0]);
    expect(await undoButton().isEnabled()).toBe(true);
    await undo(4);
    expect(await commands(page)).toEqual(before);
    expect(distance(await positions(page), flat)).toBe(0);
  });

  it('goes no further back than a file as it was opened', async () => {
    const { page } = studio;
    await openFile(page, join(root, 'samples/bonnet.step'));
    const before = await commands(page);
    const shape = await positions(page);
    expect(await undoButton().isDisabled()).toBe(true);
    await page.keyboard.press('b');
    await stroke(page, [0, 0]); // selects
    await stroke(page, [0, 0], [30, 0]);
    await undo(6);
    expect(await commands(page)).toEqual(before);
    expect(distance(await positions(page), shape)).toBe(0);
  });

  it('leaves the surface chosen that a scene of the gallery begins with', async () => {
    const { page } = studio;
    await scene(page, 'Bonnet');
    await expect.poll(preset).toContain('clay');
    const before = await commands(page);
    expect(await page.locator('.notice').count()).toBe(0); // nothing is left to choose
    expect(await undoButton().isDisabled()).toBe(true);
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [30, 0]);
    await undo(3);
    expect(await commands(page)).toEqual(before);
  });

  it('waits to be played where a scene is a figure of the thesis, of a file too', async () => {
    const { page } = studio;
    for (const [name, chosen] of [['Fig. 6.12', 1], ['Fig. 6.11', 4]] as const) {
      await scene(page, name);
      await expect.poll(() => page.locator('.panel[data-panel=Surfaces] .item.on').count()).toBe(chosen);
      const before = await positions(page);
      await page.keyboard.press('.');
      await settled(page);
      expect(distance(before, await positions(page))).toBeGreaterThan(1e-3);
    }
  });

  it('stops at the same place after a reload', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const before = await commands(page);
    await stroke(page, [0, 0], [30, 0]);
    await stroke(page, [0, 30], [30, 30]);
    await kept();
    await page.reload();
    await ready(page);
    await page.locator('.notice button', { hasText: 'Recover' }).click();
    await settled(page);
    expect((await commands(page)).length).toBeGreaterThan(before.length);
    await undo(5);
    expect(await commands(page)).toEqual(before);
    expect(await undoButton().isDisabled()).toBe(true);
  });

  it('takes the strokes of a saved document back, but not its sheet', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await page.keyboard.press('b');
    const before = await commands(page);
    await stroke(page, [0, 0], [30, 0]);
    await openFile(page, await saveAs(page, directory, 'Knead document'));
    await undo(8);
    expect(await commands(page)).toEqual(before);
  });
});

describe('a script that is opened', () => {
  const bump = { knead: 2, commands: [{ do: 'drag', at: [0.5, 0.5], by: [0, 0, 12], radius: 30 }] };

  it('is applied to the document that is open, as one entry of the history', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const before = await commands(page);
    const flat = await positions(page);
    await openFile(page, file('bump.json', bump), 'Apply');
    expect((await commands(page)).slice(before.length)).toMatchObject([{ do: 'hold', mode: 'position', all: true }, ...bump.commands]);
    expect(distance(await positions(page), flat)).toBeGreaterThan(5);
    await expect.poll(() => page.locator('.document-name').textContent()).toBe('sheet');
    await undo(1);
    expect(await commands(page)).toEqual(before);
  });

  it('that does not fit changes nothing', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const before = await commands(page);
    const path = file('other.json', { knead: 2, commands: [{ do: 'new', size: [9, 9], name: 'first' }, { do: 'select', surface: '#285' }] });
    for (const choice of ['Apply', 'New document']) {
      await openFile(page, path, choice);
      await expect.poll(() => page.locator('.notice.error').textContent(), { message: choice }).toContain('#285');
      await page.locator('.notice.error button[aria-label=Dismiss]').click();
      expect(await commands(page), choice).toEqual(before);
      expect(await undoButton().isDisabled(), choice).toBe(true);
      expect(await page.locator('.document-name').textContent()).toBe('sheet');
    }
  });

  it('makes a document of its own where that is wanted, and none where it is not', async () => {
    const { page } = studio;
    const before = await commands(page);
    const path = file('made.json', { knead: 2, commands: [{ do: 'new', size: [50, 50], net: [6, 6], name: 'small' }] });
    await openFile(page, path, 'Cancel');
    expect(await commands(page)).toEqual(before);
    await openFile(page, path, 'New document');
    expect(await commands(page)).toMatchObject([{ do: 'new', name: 'small' }]);
    await expect.poll(() => page.locator('.document-name').textContent()).toBe('made.json');
  });
});

describe('a JSON net that is opened', () => {
  it('is a surface, and no script', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const row = (x: number): number[][] => [0, 10, 20, 30].map((y) => [x, y, x * y / 100]);
    await openFile(page, file('net.json', [0, 10, 20, 30].map(row)));
    await expect.poll(() => page.locator('.document-name').textContent()).toBe('net.json');
    const places = await positions(page);
    expect([Math.min(...places), Math.max(...places)]).toEqual([0, 30]);
    expect(await page.locator('.notice.error').count()).toBe(0);
  });
});

describe('opening something else', () => {
  it('asks first where work is not saved, and not where nothing was done', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const before = await handled(page);
    await page.locator('summary[aria-label^=Gallery]').click();
    await page.locator('details[open] .menu-item').first().click();
    await expect.poll(() => handled(page)).toBe(before + 1);
    expect(await question(page).isVisible()).toBe(false);
    await settled(page);
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [30, 0]);
    const shape = await positions(page);
    await page.locator('summary[aria-label^=Gallery]').click();
    await page.locator('details[open] .menu-item', { hasText: 'Trampoline' }).click();
    await expect.poll(() => question(page).textContent()).toContain('“sheet” has changes that are not saved');
    await question(page).locator('button', { hasText: 'Cancel' }).click();
    await settled(page);
    expect(distance(await positions(page), shape)).toBe(0);
    await expect.poll(() => page.locator('.document-name').textContent()).toBe('sheet');
    // Saved, it may go.
    await page.locator('summary[aria-label=Save]').click();
    await Promise.all([page.waitForEvent('download'), page.locator('details[open] .menu-item', { hasText: 'Knead document' }).click()]);
    await expect.poll(() => page.locator('.notice').last().textContent()).toContain('Saved');
    await page.locator('summary[aria-label^=Gallery]').click();
    await page.locator('details[open] .menu-item', { hasText: 'Trampoline' }).click();
    expect(await question(page).isVisible()).toBe(false);
    await expect.poll(() => page.locator('.document-name').textContent()).toBe('trampoline');
  });

  it('leaves the session before in the list of recent ones, from which it is opened again', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await page.keyboard.press('b');
    await stroke(page, [10, 0], [50, 10]);
    const shape = await positions(page);
    await scene(page, 'Hull'); // at once: what was not kept yet is kept now
    expect(distance(await positions(page), shape)).toBeGreaterThan(1);
    await page.locator('summary[aria-label="Recent sessions"]').click();
    const first = page.locator('details[open] .menu-item').first();
    await expect.poll(() => first.textContent()).toContain('sheet');
    await first.click();
    await expect.poll(() => page.locator('.document-name').textContent()).toBe('sheet');
    await settled(page);
    expect(distance(await positions(page), shape)).toBe(0);
    await undo(1);
    expect(distance(await positions(page), shape)).toBeGreaterThan(1);
  });
});

describe('a file of another program', () => {
  /** A flat cubic one of GoTools, 6 × 6 control points. */
  const sheet = (count: number) => {
    const line = Array.from({ length: count }, (_, k) => k * 10);
    const knots = '6 4\n0 0 0 0 1 2 3 3 3 3';
    return `200 1 0 0\n3 0\n${knots}\n${knots}\n${line.flatMap((y) => line.map((x) => `${x} ${y} 0`)).join('\n')}\n`;
  };

  it('opens, is sculpted and comes back as it was but for the numbers that moved', async () => {
    const { page } = studio;
    const text = sheet(6);
    await openFile(page, file('sheet.g2', text));
    expect((await positions(page)).length).toBeGreaterThan(0);
    await page.keyboard.press('b');
    await stroke(page, [0, 0]); // selects
    await stroke(page, [0, 0], [10, 0]);
    const path = await saveAs(page, directory, 'CAD file');
    expect(path.endsWith('sheet-sculpted.g2')).toBe(true);
    const saved = readFileSync(path, 'utf8');
    expect(saved.startsWith(text.slice(0, text.indexOf('0 0 0\n10 0 0')))).toBe(true);
    expect(saved).not.toBe(text);
  });

  it('that is compressed opens, comes back compressed with the same bytes, and is compressed again once it has changed', async () => {
    const { page } = studio;
    const packed = join(directory, 'sheet.g2.gz');
    writeFileSync(packed, gzipSync(sheet(6)));
    await openFile(page, packed);
    const same = await saveAs(page, directory, 'CAD file');
    expect(same.endsWith('sheet-sculpted.g2.gz')).toBe(true);
    expect(readFileSync(same).equals(readFileSync(packed))).toBe(true);
    await page.keyboard.press('b');
    await stroke(page, [0, 0]); // selects
    await stroke(page, [0, 0], [10, 0]);
    const saved = gunzipSync(readFileSync(await saveAs(page, directory, 'CAD file'))).toString();
    expect(saved.startsWith('200 1 0 0')).toBe(true);
    expect(saved).not.toBe(sheet(6));
  });

  it('is replaced where it lies, unless another program has changed it', async () => {
    const { page } = studio;
    const text = sheet(6);
    // A file of the browser's own disk in the place of the dialog.
    await page.evaluate(async (content) => {
      const directory = await navigator.storage.getDirectory();
      const handle = await directory.getFileHandle('here.g2', { create: true });
      const writable = await handle.createWritable();
      await writable.write(content);
      await writable.close();
      Object.assign(window, { showOpenFilePicker: async () => [handle], here: handle });
    }, text);
    const onDisk = () => page.evaluate(async () => (await (window as never as { here: FileSystemFileHandle }).here.getFile()).text());
    const before = await handled(page);
    await page.locator('.top [aria-label^="Open"]').click();
    await expect.poll(() => handled(page)).toBe(before + 1);
    await settled(page);
    await page.keyboard.press('b');
    await stroke(page, [0, 0]); // selects
    await stroke(page, [0, 0], [10, 0]);
    await page.keyboard.press('Control+s');
    await expect.poll(onDisk).not.toBe(text);
    const saved = await onDisk();
    expect(saved.startsWith(text.slice(0, text.indexOf('0 0 0\n10 0 0')))).toBe(true);

    await page.evaluate(async () => {
      const writable = await (window as never as { here: FileSystemFileHandle }).here.createWritable();
      await writable.write('of another program');
      await writable.close();
    });
    await page.keyboard.press('Control+s');
    await expect.poll(() => question(page).isVisible()).toBe(true);
    await page.keyboard.press('Escape');
    expect(await onDisk()).toBe('of another program');
  });
});
