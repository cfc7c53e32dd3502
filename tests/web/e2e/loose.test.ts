import type { Command } from '@studio/engine/session_types';

import { commands, execute, scene, settled, stroke, studioOfFile } from './page';

/** What nothing holds, and what stops at another face: said once, with what can be done. */

const studio = studioOfFile();

describe('a surface that nothing holds', () => {
  it('is offered what holds it', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await execute(studio.page, { do: 'release' });
    await page.keyboard.press('b');
    await stroke(page, [-10, 0], [10, 0]);
    const notice = page.locator('.notice', { hasText: 'Nothing holds #1' });
    await expect.poll(() => notice.count()).toBe(1);
    await notice.locator('button', { hasText: 'Hold the outer rows' }).click();
    await settled(page);
    expect((await commands(page)).at(-1)).toEqual({ do: 'hold', rows: 2 });
  });
});

describe('a press that comes to the wall behind', () => {
  it('stops there, and goes through where that is wanted', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await execute(studio.page, { do: 'select', surface: '#1' });
    const heights = async () => {
      const { upper, lower } = await page.evaluate(() => (window as never as { studio: { state: { surfaces: { upper: number[]; lower: number[] }[] } } }).studio.state.surfaces[0]!);
      return upper[2]! - lower[2]!;
    };
    const size = await page.evaluate(() => {
      const { lower, upper } = (window as never as { studio: { state: { surfaces: { lower: number[]; upper: number[] }[] } } }).studio.state.surfaces[0]!;
      return upper[0]! - lower[0]!;
    });
    await execute(studio.page, { do: 'new', size: [size, size], net: [8, 8], position: [0, 0, -0.01 * size] }, { do: 'select', surface: '#1' });
    await execute(studio.page, { do: 'brush', kind: 'push', radius: 0.2 * size, height: 0.05 * size, path: [[0.5, 0.5]] } as Command);
    const stopped = await heights();
    const notice = page.locator('.notice', { hasText: 'was stopped' });
    await expect.poll(() => notice.count()).toBe(1);
    await notice.locator('button', { hasText: 'Go through' }).click();
    await settled(page);
    await expect.poll(heights).toBeGreaterThan(2 * stopped);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'brush', allow: 'through' });
  });
});
