import { execFileSync } from 'node:child_process';

import { commands, downloaded, native, openStudio, scene, settled, type Studio } from './page';

let studio: Studio;
const requests: string[] = [];

beforeAll(async () => {
  studio = await openStudio({ width: 1180, height: 760 });
  await studio.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  // What the service worker keeps for use without a network is fetched at any time.
  studio.page.context().on('request', (r) => void (r.serviceWorker() || requests.push(r.url())));
});

afterAll(() => studio.close());

afterEach(() => {
  expect(studio.problems).toEqual([]);
  expect(studio.foreign).toEqual([]);
});

const panel = () => studio.page.locator('.lab');
const list = () => studio.page.locator('input[aria-label="All knots"]');
const knots = async (): Promise<number[]> => (await list().inputValue()).split(',').map(Number);
const degree = async (): Promise<string> => studio.page.locator('select[aria-label=Degree]').inputValue();
const paths = () => studio.page.locator('.lab-curves path').evaluateAll((all) => all.map((p) => p.getAttribute('d')!));
const message = () => studio.page.locator('.lab-message').textContent();
const apply = () => studio.page.locator('button[aria-label="Apply to the surface"]');

const gallery = (name: string) => scene(studio.page, name);

/** Everything that was asked for has been drawn. */
async function drawn(): Promise<void> {
  await studio.page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

async function open(): Promise<void> {
  const { page } = studio;
  if ((await panel().count()) === 0) await page.locator('button[aria-label^="Basis functions"]').click();
  await page.locator('.lab[data-drawn]').waitFor(); // not a handle, which would keep the panel in memory
  await drawn();
}

/** Middle of a dot of the k-th different knot. */
async function dot(k: number, copy = 0): Promise<[number, number]> {
  const box = (await studio.page.locator('.lab-knot').nth(k).locator('circle').nth(copy).boundingBox())!;
  return [box.x + box.width / 2, box.y + box.height / 2];
}

/** The pointer points at nothing, and the table begins with its first entry. */
async function firstEntries(): Promise<void> {
  await studio.page.locator('.lab-bar h2').hover();
  await studio.page.locator('.lab-scroll').evaluate((e) => e.scrollTo(0, 0));
  await drawn();
}

/** The numbers of the visible part of the table, "i,j" → value, with all digits. */
const entries = (): Promise<[string, number][]> =>
  studio.page.locator('.lab-table td:not(.beyond)').evaluateAll((cells) =>
    (cells as HTMLElement[]).filter((c) => c.title !== '').map((c) => [`${c.dataset.i},${c.dataset.j}`, Number(c.title)] as [string, number]));

function nativeGramian(p: string, x: number[], a: number, b: number, method: string): Map<string, number> {
  const text = execFileSync(native, ['gramian', '--degree', p, `--knots=${x.join(',')}`, '--a', `${a}`, '--b', `${b}`, '--method', method, '--format', 'csv'], { encoding: 'utf8' });
  return new Map(text.trim().split('\n').slice(1).map((line) => {
    const [, i, j, value] = line.split(',');
    return [`${i},${j}`, Number(value)];
  }));
}

describe('the lab', () => {
  it('costs nothing until it is opened, and then shows the functions of the surface', async () => {
    const { page } = studio;
    await gallery('Ball on a membrane'); // 24 × 24, degree 3
    const loaded = await page.evaluate(() => performance.getEntriesByType('resource').map((r) => r.name));
    expect([...loaded, ...requests].filter((url) => /lab|panel/.test(url))).toEqual([]);
    await open();
    expect(requests.filter((url) => /knead_lab.*\.wasm/.test(url)).length).toBe(1);
    await expect.poll(async () => (await paths()).length).toBe(24);
    expect(await knots()).toHaveLength(28);
    expect(Number(await page.locator('.lab-readout').getAttribute('data-unity'))).toBeLessThan(1e-15);
    const box = (await page.locator('.lab-plot').boundingBox())!;
    await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.4 * box.height);
    await expect.poll(() => page.locator('.lab-readout').textContent()).toMatch(/u 0\.\d+ +N₁[₀-₉] = 0\.\d{16,} +Σ − 1 = /);
    await expect.poll(() => page.locator('.lab-curves path.lit').count()).toBe(1);
    await expect.poll(() => page.locator('.lab-detail').textContent()).toMatch(/^N₁[₀-₉]: support \[0\.\d+, 0\.\d+\], Greville 0\.\d+, integral 0\.04762, C²$/);
  });

  it('moves a knot under the pointer: functions and Gramians follow, and are those of the command line', async () => {
    const { page } = studio;
    await firstEntries();
    const [before, curves, table] = [await knots(), await paths(), await entries()];
    const [x, y] = await dot(1);
    const [next] = await dot(2);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 0.3 * (next - x), y, { steps: 4 });
    await drawn();
    const half = await paths();
    expect(half).not.toEqual(curves);
    await page.mouse.move(x + 0.6 * (next - x), y, { steps: 4 });
    await page.mouse.up();
    await drawn();
    const after = await knots();
    expect(after.filter((u, k) => u !== before[k])).toHaveLength(1);
    expect(after[4]).toBeGreaterThan(before[4]!);
    expect(after[4]).toBeLessThan(before[5]!);
    expect(await paths()).not.toEqual(half);
    const now = await entries();
    expect(now).not.toEqual(table);
    for (const [name, method] of [['recurrence', 'recurrence'], ['gauss', 'gauss'], ['analytic', 'analytic']] as const) {
      await page.locator('select[aria-label="Numbers shown"]').selectOption(name);
      await drawn();
      const shown = await entries();
      expect(shown.length).toBeGreaterThan(5);
      const expected = nativeGramian(await degree(), after, 1, 1, method);
      for (const [at, value] of shown) expect(value).toBe(expected.get(at));
    }
    await page.locator('select[aria-label="Numbers shown"]').selectOption('recurrence');
    expect(await page.locator('.lab-readout').getAttribute('data-unity')).toMatch(/e-1[6-9]|^0$/);
    // A drag is taken back by Esc.
    const [u, v] = await dot(3);
    await page.mouse.move(u, v);
    await page.mouse.down();
    await page.mouse.move(u + 12, v, { steps: 3 });
    await page.keyboard.press('Escape');
    await page.mouse.up();
    await drawn();
    expect(await knots()).toEqual(after);
    await page.locator('.lab button', { hasText: 'Reset' }).click();
    await drawn();
    expect(await knots()).toEqual(before);
    expect(await paths()).toEqual(curves);
  });

  it('shows entries with all digits by every method, where they are pointed at', async () => {
    const { page } = studio;
    await page.locator('button[aria-label="Gramian of derivatives 2 and 2"]').click();
    await firstEntries();
    await page.locator('.lab-table td[data-i="1"][data-j="2"]').hover();
    const x = await knots();
    const rows = page.locator('table[aria-label="The methods"] tbody tr');
    for (const [k, method] of ['gauss', 'analytic', 'recurrence'].entries()) {
      const expected = nativeGramian(await degree(), x, 2, 2, method).get('1,2')!;
      await expect.poll(() => rows.nth(k).locator('td').last().textContent()).toBe(expected.toPrecision(17));
      await expect.poll(() => rows.nth(k).locator('td').first().textContent()).toMatch(/^[\d.]+ [µm]s$/);
    }
    expect(await page.locator('.lab-curves path.lit').count()).toBe(2);
    await page.locator('.lab-table').focus();
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Control+c');
    const copied = Number(await page.evaluate(() => navigator.clipboard.readText()));
    expect(copied).toBe(nativeGramian(await degree(), x, 2, 2, 'recurrence').get(
      (await page.locator('.lab-table').getAttribute('aria-activedescendant'))!.replace('lab-entry-', '').replace('-', ',')));
    // Orders that the recurrence leaves to Gauss.
    await page.locator('select[aria-label="Derivative of the row functions"]').selectOption('3');
    await expect.poll(() => rows.nth(2).locator('th').textContent()).toBe('recurrence (gauss)');
    await page.locator('button[aria-label="Gramian of derivatives 1 and 1"]').click();
  });

  it('shows derivatives with their impulses, integrals, other degrees', async () => {
    const { page } = studio;
    const plotted = page.locator('select[aria-label="What is plotted"]');
    await plotted.selectOption('4');
    await drawn();
    // Five knots of a cubic function: those of the middle ones have an impulse at each.
    await expect.poll(() => page.locator('.lab-impulse:not(.higher)[data-function="12"]').count()).toBe(5);
    await plotted.selectOption('-2');
    await drawn();
    await expect.poll(() => page.locator('.lab-impulse').count()).toBe(0);
    const integrals = await paths();
    await page.locator('button[aria-label=Differentiate]').click();
    await drawn();
    expect(await plotted.inputValue()).toBe('-1');
    await expect.poll(paths).not.toEqual(integrals);
    await plotted.selectOption('0');
    await page.locator('select[aria-label=Degree]').selectOption('15');
    await drawn();
    expect(await plotted.inputValue()).toBe('0');
    expect(await degree()).toBe('15');
    await expect.poll(async () => (await paths()).length).toBe(36);
    expect(await apply().isDisabled()).toBe(true);
    expect(await message()).toMatch(/for looking only.*degree 3/);
    await page.locator('.lab button', { hasText: 'Reset' }).click();
    await drawn();
    await expect.poll(async () => (await paths()).length).toBe(24);
  });

  it('says what is wrong with knots and keeps the ones before', async () => {
    const { page } = studio;
    const [before, curves] = [await knots(), await paths()];
    for (const [text, said] of [['0, 1, x', /“x”.*not a number/], ['0, 0, 0, 0, 2, 1, 3, 3, 3, 3', /decrease/], ['1, 2', /at least|needs|too few/i]] as const) {
      await list().fill(text);
      await list().press('Enter');
      await expect.poll(message).toMatch(said);
      expect(await paths()).toEqual(curves);
    }
    await list().focus();
    await page.keyboard.press('Escape');
    expect(await knots()).toEqual(before);
    expect(await panel().count()).toBe(1);
  });

  it('is worked by the keyboard', async () => {
    const { page } = studio;
    const before = await knots();
    await page.locator('.lab-knot').nth(2).focus();
    await page.keyboard.press('ArrowRight');
    await drawn();
    const moved = await knots();
    expect(moved[5]).toBeGreaterThan(before[5]!);
    await page.keyboard.press('+');
    await drawn();
    expect(await knots()).toHaveLength(29);
    expect(await page.evaluate(() => document.activeElement?.getAttribute('aria-label'))).toMatch(/, twice$/);
    await page.keyboard.press('Delete');
    await page.keyboard.press('Delete');
    await drawn();
    expect(await knots()).toHaveLength(27);
    await page.locator('.lab button', { hasText: 'Reset' }).click();
    await drawn();
    const size = async () => (await panel().boundingBox())!.height;
    const height = await size();
    await page.locator('.lab-divider').focus();
    await page.keyboard.press('ArrowUp');
    await expect.poll(size).toBeGreaterThan(height);
    await page.keyboard.press('ArrowDown');
  });

  it('inserts a knot at a double click, and the surface takes it without a change of shape', async () => {
    const { page } = studio;
    const before = await knots();
    const box = (await page.locator('.lab-plot').boundingBox())!;
    await page.mouse.dblclick(box.x + 0.43 * box.width, box.y + 0.5 * box.height);
    await drawn();
    expect(await knots()).toHaveLength(29);
    expect(await message()).toMatch(/the shape stays/);
    await apply().click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'refine', knots_u: [(await knots()).find((x) => !before.includes(x))] });
    await expect.poll(() => page.locator('.panel[data-panel=Surfaces] .item').textContent()).toContain('25×24');
    await expect.poll(message).toMatch(/^Direction u/);
    await page.keyboard.press('Control+z');
    await expect.poll(async () => (await knots()).length).toBe(28); // the panel follows the surface
    expect(await knots()).toEqual(before);
  });

  it('gives the surface other knots for the same net, as a command that can be undone', async () => {
    const { page } = studio;
    const before = await knots();
    const wanted = before.map((x, k) => (k === 6 ? (x + before[7]!) / 2 : x));
    await list().fill(wanted.join(', '));
    await list().press('Enter');
    await drawn();
    await apply().click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'knots', direction: 'u', knots: wanted });
    await expect.poll(message).toMatch(/^Direction u/);
    expect(await knots()).toEqual(wanted);
    await page.keyboard.press('Control+z');
    await expect.poll(knots).toEqual(before);
  });

  it('gives away its plot and its numbers', async () => {
    const { page } = studio;
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('button[aria-label="Save the plot as SVG"]').click()]);
    const svg = await downloaded(download);
    expect(svg).toMatch(/^<svg [^>]*xmlns="http:\/\/www.w3.org\/2000\/svg"/);
    expect(svg.match(/<path [^>]*stroke="rgb/g)!.length).toBeGreaterThanOrEqual(24);
    expect(svg).not.toMatch(/ class="| style="|var\(/);
    await page.locator('button[aria-label="Copy the Gramian by all methods as CSV"]').click();
    await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/^i,j,gauss,analytic,recurrence,/);
    const text = await page.evaluate(() => navigator.clipboard.readText());
    const expected = nativeGramian('3', await knots(), 1, 1, 'recurrence');
    const lines = text.trim().split('\n').slice(1).map((l) => l.split(','));
    expect(lines).toHaveLength(expected.size);
    for (const [i, j, , , recurrence] of lines) expect(Number(recurrence)).toBe(expected.get(`${i},${j}`));
    await page.locator('button[aria-label="Copy the plotted samples as CSV"]').click();
    await expect.poll(() => page.evaluate(() => navigator.clipboard.readText())).toMatch(/^function,u,value\n0,/);
  });

  it('has a name for every control', async () => {
    const nameless = await panel().evaluate((lab) =>
      [...lab.querySelectorAll('button, input, select, [role=slider], [role=separator], [role=grid], canvas')]
        .filter((e) => !e.getAttribute('aria-label') && !e.textContent?.trim()).map((e) => e.outerHTML));
    expect(nameless).toEqual([]);
  });

  it('leaves nothing behind when it is closed', async () => {
    const { page } = studio;
    const line = await page.context().newCDPSession(page);
    const modules = async (): Promise<number> => {
      await line.send('HeapProfiler.collectGarbage');
      const { result } = await line.send('Runtime.evaluate', { expression: 'WebAssembly.Memory.prototype' });
      const { objects } = await line.send('Runtime.queryObjects', { prototypeObjectId: result.objectId! });
      const { result: count } = await line.send('Runtime.callFunctionOn', { objectId: objects.objectId!, functionDeclaration: 'function () { return this.length; }' });
      await line.send('Runtime.releaseObject', { objectId: objects.objectId! });
      return count.value as number;
    };
    const listeners = () => page.evaluate(() => (window as never as { studio: { onChange: unknown[] } }).studio.onChange.length);
    const view = async () => (await page.locator('.viewer').boundingBox())!.height;
    const [withPanel, small] = [await listeners(), await view()];
    const closed: number[] = [];
    for (let k = 0; k < 4; ++k) {
      await page.locator('button[aria-label="Close the panel"]').click();
      expect(await panel().count()).toBe(0);
      expect(await listeners()).toBe(withPanel - 1);
      expect(await view()).toBeGreaterThan(small);
      await page.locator('.view-perspective').click({ position: { x: 5, y: 5 } });
      await drawn();
      closed.push(await modules());
      await page.keyboard.press('l');
      await page.locator('.lab[data-drawn]').waitFor();
      expect(await listeners()).toBe(withPanel);
      expect(await modules()).toBe(closed[k]! + 1);
    }
    // The inspector keeps the first one that it has counted; the page keeps none.
    expect(closed).toEqual(Array(4).fill(closed[0]));
    expect(closed[0]).toBeLessThanOrEqual(1);
    await page.locator('.lab-knot').first().focus();
    await page.keyboard.press('Escape');
    expect(await panel().count()).toBe(0);
  });
});
