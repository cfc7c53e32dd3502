import { commands, distance, positions, scene, settled, spot, studioOfFile } from './page';

/** A hand that is faster than the engine: strokes that end, and others that begin, before their first command is done. */

const studio = studioOfFile();

interface Client {
  execute(...rest: unknown[]): Promise<unknown>;
}

/** Every command takes so long from now on, before it reaches the engine. */
const slow = (milliseconds: number) => studio.page.evaluate((wait) => {
  const { client } = (window as never as { studio: { client: Client & { eager?: Client['execute'] } } }).studio;
  client.eager ??= client.execute;
  const { eager } = client;
  client.execute = wait === 0 ? eager : async (...rest) => {
    await new Promise((resolve) => setTimeout(resolve, wait));
    return eager(...rest);
  };
}, milliseconds);

async function drag(from: [number, number], to: [number, number], steps: number): Promise<void> {
  const { page } = studio;
  await page.mouse.move(...(await spot(page, ...from)));
  await page.mouse.down();
  await page.mouse.move(...(await spot(page, ...to)), { steps });
  await page.mouse.up();
}

async function arrived(): Promise<void> {
  const { page } = studio;
  await expect.poll(() => page.evaluate(() => (window as never as { studio: { hand: { idle: Promise<void> } } }).studio.hand.idle.then(() => true))).toBe(true);
  await settled(page);
}

/** What a drag makes of the clay sheet if the engine is so slow. */
async function made(mode: string, from: [number, number], to: [number, number], wait: number): Promise<{ shape: number[]; last: Awaited<ReturnType<typeof commands>>[number] }> {
  const { page } = studio;
  await scene(page, 'Clay sheet');
  await page.keyboard.press(mode);
  await slow(wait);
  await drag(from, to, 1);
  await arrived();
  await slow(0);
  return { shape: await positions(page), last: (await commands(page)).at(-1)! };
}

describe('a stroke that is released before its first command is done', () => {
  it('goes as far as the hand when a point is grabbed', async () => {
    const slowly = await made('g', [0, 0], [0, -60], 300), at_once = await made('g', [0, 0], [0, -60], 0);
    expect(slowly.last.do).toBe('drag');
    expect(Math.hypot(...(slowly.last as { by: number[] }).by)).toBeGreaterThan(1);
    expect(distance(slowly.shape, at_once.shape)).toBe(0);
  });

  it('smooths where it was released', async () => {
    const { last } = await made('s', [-60, 0], [60, 0], 300);
    expect(last.do).toBe('relax');
    const begun = (await made('s', [-60, 0], [-60, 0], 0)).last as { at: number[] };
    expect(distance((last as { at: number[] }).at, begun.at)).toBeGreaterThan(0.05);
  });

  it('is over before the next one begins', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    const before = (await commands(page)).length;
    await page.keyboard.press('g');
    await slow(200);
    await drag([-60, 0], [-60, -50], 1);
    await drag([60, 0], [60, -50], 1);
    await arrived();
    await slow(0);
    const drags = (await commands(page)).slice(before) as { do: string; at: number[]; by: number[] }[];
    expect(drags.map((c) => c.do)).toEqual(['drag', 'drag']);
    for (const { by } of drags) expect(Math.hypot(...by)).toBeGreaterThan(1);
    expect(distance(drags[0]!.at, drags[1]!.at)).toBeGreaterThan(0.05);
  });
});
