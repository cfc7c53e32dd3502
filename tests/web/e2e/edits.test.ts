import { commands, execute, scene, settled, stroke, studioOfFile } from './page';

/** What the page sends changes what it names, and nothing beside it. */

const studio = studioOfFile();

describe('a stroke that is refused', () => {
  it('leaves no brush behind, and nothing in the history', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await execute(studio.page, { do: 'scaling', mode: 'raw' }); // strokes need a model in normalised units
    const before = await commands(page);
    await page.keyboard.press('b');
    await stroke(page, [-10, 0], [10, 0]);
    await expect.poll(() => page.locator('.notice.error').count()).toBeGreaterThan(0);
    await settled(page);
    expect(await commands(page)).toEqual(before);
    expect(await page.evaluate(() => (window as never as { studio: { state: { tools: unknown[] } } }).studio.state.tools)).toEqual([]);
    for (const close of await page.locator('.notice.error button[aria-label=Close]').all()) await close.click();
  });
});

describe('a painted material', () => {
  const samples = async (coefficient: string) =>
    (await commands(studio.page)).filter((c) => c.do === 'material').filter((c) => c.coefficient === coefficient).at(-1)!.samples!;

  it('leaves the regions that a script has set', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await execute(studio.page, { do: 'material', alpha: [0.1, 0, 0.1], beta: [0.5, 0.5, 0.5], region: [[0.8, 1], [0.8, 1]], falloff: 0.01 });
    await page.keyboard.press('a');
    await stroke(page, [-10, 0], [10, 0]);
    const beta = await samples('beta11');
    expect(beta.at(-1)).toBeCloseTo(0.5, 9);
    expect(beta[0]).toBeCloseTo(0.001, 9);
  });
});
