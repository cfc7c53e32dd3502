import { openStudio, scene, settled, stroke, type Studio } from './page';

/** What opens over the page lies within it, on a telephone too. */

let studio: Studio;
beforeAll(async () => {
  studio = await openStudio({ width: 390, height: 844 });
});
afterAll(() => studio.close());
afterEach(() => {
  expect(studio.problems).toEqual([]);
  expect(studio.foreign).toEqual([]);
});

const inside = async (selector: string) => {
  for (const part of await studio.page.locator(selector).all()) {
    const box = (await part.boundingBox())!;
    expect([box.x >= 0, box.x + box.width <= 390], `${selector}: ${box.x} to ${box.x + box.width}`).toEqual([true, true]);
  }
};

it('keeps menus and questions inside of a narrow page', async () => {
  const { page } = studio;
  await page.keyboard.press('b');
  await stroke(page, [0, 0], [10, 0]);
  await page.locator('summary[aria-label^=Gallery]').click();
  await inside('details[open] .menu-list');
  await page.locator('details[open] .menu-item').nth(1).click();
  await inside('dialog.question, dialog.question button');
  await page.keyboard.press('Escape');
  await scene(page, 'Hull');
  await page.locator('summary[aria-label="Recent sessions"]').click();
  await page.locator('details[open] .with-action').first().waitFor();
  await inside('details[open] .menu-list, details[open] .menu-list button');
  await page.locator('summary[aria-label="Recent sessions"]').click();
  await page.locator('summary[aria-label=Save]').click();
  await inside('details[open] .menu-list');
  await page.locator('summary[aria-label=Save]').click();
  await settled(page);
  await inside('.held-badge');
});
