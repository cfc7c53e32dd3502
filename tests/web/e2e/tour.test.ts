import { openStudio, ready, settled, spot, stroke, type Studio } from './page';

let studio: Studio;

beforeAll(async () => {
  studio = await openStudio({ width: 1100, height: 680, first: true });
});

afterAll(async () => {
  await studio.close();
});

describe('the tour', () => {
  const card = () => studio.page.locator('.tour');
  const title = () => card().locator('h2').textContent();

  it('meets a first visitor, goes on as its steps are done, and can be left', async () => {
    const { page } = studio;
    expect(await title()).toBe('Exact clay');
    await page.getByRole('button', { name: 'Show me' }).click();
    expect(await title()).toBe('Press');
    expect(await page.locator('.tour-target').getAttribute('aria-label')).toContain('Push');
    await page.waitForTimeout(700);
    expect(await title()).toBe('Press'); // nothing has been pressed yet
    await stroke(page, [0, -20], [30, -20], [50, -20]);
    await expect.poll(title).toBe('Take it back');
    await page.keyboard.press('Control+z');
    await expect.poll(title).toBe('Look around');
    await page.keyboard.press('3');
    await expect.poll(title).toBe('Place a tool');
    await page.mouse.click(...(await spot(page, 20, -20)));
    await settled(page);
    await expect.poll(title).toBe('Choose a material');
    await page.getByRole('button', { name: 'Rubber' }).click();
    await expect.poll(title).toBe('Judge the surface');
    await page.keyboard.press('z');
    await expect.poll(title).toBe('Your own files');
    await page.getByRole('button', { name: 'Done' }).click();
    expect(await card().count()).toBe(0);
    expect(await page.locator('.tour-target').count()).toBe(0);
    expect(studio.problems).toEqual([]);
  });

  it('does not come back by itself, but when asked', async () => {
    const { page } = studio;
    await page.reload();
    await ready(page);
    expect(await card().count()).toBe(0);
    await page.getByRole('button', { name: 'Guided tour' }).click();
    expect(await title()).toBe('Exact clay');
    await page.getByRole('button', { name: 'End the tour' }).click();
    expect(await card().count()).toBe(0);
  });
});
