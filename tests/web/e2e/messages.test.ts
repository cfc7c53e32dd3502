import type { Command } from '@studio/engine/session_types';

import { commands, distance, execute, positions, scene, settled, stroke, studioOfFile } from './page';

/** What the page says where something cannot be done, and what it leaves as it was. */

const studio = studioOfFile({ width: 1100, height: 760 });

const openPanel = async (name: string) => {
  const panel = studio.page.locator(`.panel[data-panel="${name}"]`);
  if ((await panel.getAttribute('open')) === null) await panel.locator(':scope > summary').click();
};
const input = (label: string) => studio.page.locator(`input[aria-label="${label}"]`);
const invalid = (label: string) => input(label).getAttribute('aria-invalid');
const errors = () => studio.page.locator('.notice.error');
const undoable = () => studio.page.locator('button[aria-label^="Undo"]').isEnabled();

describe('a number that cannot be', () => {
  it('marks its field, says why beside it, and gives way to the valid one', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await openPanel('Evolution');
    const before = await commands(page);
    const lambda = input('Lambda');
    const valid = await lambda.inputValue();
    await lambda.fill('-5');
    await page.keyboard.press('Enter');
    await expect.poll(() => invalid('Lambda')).toBe('true');
    expect(await lambda.inputValue()).toBe('-5');
    const why = page.locator(`#${await lambda.getAttribute('aria-describedby')}`);
    expect(await why.textContent()).toMatch(/-5 is out of range.*0/);
    expect(await why.getAttribute('role')).toBe('alert');
    expect(await errors().count()).toBe(0); // said once, where it belongs
    await lambda.blur();
    await expect.poll(() => lambda.inputValue()).toBe(valid);
    expect(await invalid('Lambda')).toBe(null);
    expect(await why.count()).toBe(0);
    expect(await commands(page)).toEqual(before);
  });

  it('is told also where the field was left at once', async () => {
    const { page } = studio;
    const lambda = input('Lambda');
    const valid = await lambda.inputValue();
    await lambda.fill('-6');
    await page.keyboard.press('Tab');
    await expect.poll(() => page.locator('.refusal').textContent()).toContain('-6 is out of range');
    expect(await lambda.inputValue()).toBe(valid);
    await lambda.fill('70');
    await page.keyboard.press('Enter');
    await settled(page);
    expect(await page.locator('.refusal').count()).toBe(0);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'evolve', lambda: 70 });
    await expect.poll(() => input('Lambda').inputValue()).toBe('70');
  });

  it('and what is no number are marked in every panel', async () => {
    const { page } = studio;
    await execute(studio.page, { do: 'tool', name: 'ball', shape: 'sphere', radius: 20, position: [100, 100, 40] });
    await page.locator('.panel[data-panel=Tools] .item').click();
    for (const panel of ['Constraints', 'Material']) await openPanel(panel);
    for (const [label, text] of [['Radius', '0'], ['Friction', '-1'], ['Held rows', '-2'], ['Yield', '-3'], ['Stretch', 'much'], ['Brush radius in units', '0']] as const) {
      const before = await commands(page);
      const valid = await input(label).inputValue();
      await input(label).fill(text);
      await page.keyboard.press('Enter');
      await expect.poll(() => invalid(label), { message: label }).toBe('true');
      await input(label).blur();
      await expect.poll(() => input(label).inputValue(), { message: label }).toBe(valid);
      expect(await commands(page), label).toEqual(before);
    }
    await execute(studio.page, { do: 'remove', tool: 'ball' });
  });
});

describe('a message', () => {
  it('has a button that does what it advises', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await openPanel('Evolution');
    await execute(studio.page, { do: 'hold', rows: 0 });
    const balance = page.getByRole('button', { name: 'Balance' });
    await balance.click();
    await expect.poll(() => errors().textContent()).toContain('Nothing holds the surface');
    await errors().locator('button', { hasText: 'Hold the outer rows' }).click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'hold', rows: 2 });
    expect(await errors().count()).toBe(0);
    await balance.click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'evolve', mode: 'static' });
  });

  it('replaces the one that says the same', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await execute(studio.page, { do: 'limit', distance: 2 });
    await page.evaluate(() => {
      const { studio } = window as never as { studio: { execute(c: Command[]): Promise<unknown> } };
      return Promise.all([9, 11, 13].map((z) => studio.execute([{ do: 'points', which: [16 * 32 + 16], by: [0, 0, z] }])));
    });
    await expect.poll(() => errors().count()).toBe(1);
    expect(await errors().textContent()).not.toMatch(/[{}]/);
    expect(await errors().textContent()).toContain('limit');
    await errors().locator('button', { hasText: 'End the limit' }).click();
    await settled(page);
    expect((await commands(page)).at(-1)).toEqual({ do: 'limit', relative: false });
  });

  it('leaves with its document, and its button too', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const loose = page.locator('.notice', { hasText: 'Nothing holds' });
    await execute(studio.page, { do: 'release' });
    await page.keyboard.press('b');
    await stroke(page, [-10, 0], [10, 0]);
    await expect.poll(() => loose.count()).toBe(1);
    await scene(page, 'Clay sheet');
    expect(await loose.count()).toBe(0);
    await execute(studio.page, { do: 'limit', distance: 2 });
    await page.evaluate(() => void (window as never as { studio: { execute(c: Command[]): Promise<unknown> } }).studio.execute([{ do: 'points', which: [16 * 32 + 16], by: [0, 0, 9] }]));
    await expect.poll(() => errors().count()).toBe(1);
    await scene(page, 'Clay sheet');
    expect(await errors().count()).toBe(0);
  });

  it('about a stroke between held edges offers a finer net', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await execute(studio.page, { do: 'hold', rows: 16 });
    const before = await positions(page);
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [20, 0]);
    await expect.poll(() => errors().textContent()).toContain('held');
    expect(await errors().textContent()).not.toMatch(/[{}]|"allow"/);
    expect(distance(await positions(page), before)).toBe(0);
    await errors().locator('button', { hasText: 'Refine' }).click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'refine' });
  });
});

describe('what changes nothing', () => {
  it('is no entry of the history', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await openPanel('Evolution');
    const before = await commands(page);
    await page.keyboard.press('.');
    await settled(page);
    await page.getByRole('button', { name: 'Clay', exact: true }).click();
    await settled(page);
    await page.getByRole('button', { name: 'Settle' }).click();
    await settled(page);
    await page.keyboard.press('r');
    await expect.poll(() => page.evaluate(() => (window as never as { studio: { playing(): boolean } }).studio.playing())).toBe(false);
    await settled(page);
    expect(await commands(page)).toEqual(before);
    expect(await undoable()).toBe(false);
    expect(await page.locator('button[aria-label^="Redo"]').isEnabled()).toBe(false);
    await page.getByRole('button', { name: 'Rubber', exact: true }).click();
    await settled(page);
    expect(await undoable()).toBe(true);
  });
});

describe('the panels', () => {
  it('have one control of each name', async () => {
    const { page } = studio;
    await scene(page, 'Ball on a membrane');
    await page.locator('.panel[data-panel=Tools] .item').click();
    await page.locator('.panel').evaluateAll((all) => all.forEach((e) => ((e as HTMLDetailsElement).open = true)));
    await settled(page);
    const names = await page.locator('.side input, .side select, .side textarea').evaluateAll((all) => all.map((e) => e.getAttribute('aria-label') ?? e.closest('label')?.textContent ?? ''));
    expect(names.filter((name, k) => names.indexOf(name) !== k)).toEqual([]);
    expect(names).toContain('Plasticity of the material');
  });

  it('say how far the surface is moved now, also where it has sprung back', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await page.getByRole('button', { name: 'Rubber', exact: true }).click();
    const flat = await positions(page);
    await page.keyboard.press('b');
    await stroke(page, [0, 0], [20, 0]);
    const moved = page.locator('.numbers span', { has: page.locator('small', { hasText: 'moved' }) });
    const shown = async () => parseFloat((await moved.textContent())!.replace('moved', ''));
    const after = await positions(page);
    const really = Math.max(...after.map((_, k) => (k % 3 ? 0 : Math.hypot(...[0, 1, 2].map((d) => after[k + d]! - flat[k + d]!)))));
    expect(really).toBeLessThan(1);
    await expect.poll(async () => Math.abs((await shown()) - really)).toBeLessThan(1e-3 * Math.max(1, really));
  });
});

describe('a message about a document', () => {
  it('goes with it', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await execute(studio.page, { do: 'limit', distance: 2 }, { do: 'points', which: [16 * 32 + 16], by: [0, 0, 9] });
    await expect.poll(() => errors().count()).toBe(1);
    await scene(page, 'Hull');
    expect(await errors().count()).toBe(0);
  });
});
