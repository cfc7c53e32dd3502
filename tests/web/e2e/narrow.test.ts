import { scene, settled, stroke, studioOfFile } from './page';

/** What opens over the page lies within it, on a telephone too. */

const studio = studioOfFile({ width: 390, height: 844 });

const inside = async (selector: string, width = 390) => {
  const parts = await studio.page.locator(`${selector} >> visible=true`).all();
  expect(parts.length, selector).toBeGreaterThan(0);
  for (const part of parts) {
    const box = (await part.boundingBox())!;
    expect([box.x >= 0, box.x + box.width <= width], `${selector}: ${box.x} to ${box.x + box.width}`).toEqual([true, true]);
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

describe('the top bar', () => {
  const names = ['Fit everything', 'Four views', 'Basis functions', 'Light or dark', 'Guided tour', 'Shortcuts'];

  it('has every control on a telephone, behind More what does not fit', async () => {
    const { page } = studio;
    await inside('.top button, .top summary, .document-unit');
    await page.locator('.top [aria-label^=More]').click();
    for (const name of names) await inside(`.top [aria-label^="${name}"]`);
    await page.locator('.top [aria-label^=Shortcuts]').click();
    await inside('.shortcuts');
    expect(await page.locator('.top [aria-label^=Shortcuts]').isVisible()).toBe(false);
    await page.keyboard.press('?');
  });

  it.each([[1024, 768], [1440, 900]])('has them all beside each other at %i × %i', async (width, height) => {
    const { page } = studio;
    await page.setViewportSize({ width, height });
    await inside('.top button, .top summary', width);
    for (const name of names) expect(await page.locator(`.top [aria-label^="${name}"]`).isVisible()).toBe(true);
    expect(await page.locator('.top [aria-label^=More]').isVisible()).toBe(false);
    await page.setViewportSize({ width: 390, height: 844 });
  });
});

it('leaves what is held readable beside messages', async () => {
  const { page } = studio;
  const apart = async () => {
    const badge = (await page.locator('.held-badge').boundingBox())!;
    for (const notice of await page.locator('.notice').all()) {
      const box = (await notice.boundingBox())!;
      expect([badge.y + badge.height <= box.y, badge.y >= box.y + box.height, badge.x >= box.x + box.width, badge.x + badge.width <= box.x]).toContain(true);
    }
  };
  await scene(page, 'Clay sheet');
  await page.evaluate(() => {
    const { notify } = (window as never as { studio: { notify(notice: object): void } }).studio;
    for (const place of ['first', 'second', 'third']) notify({ kind: 'error', text: `The ${place} of several messages, which is long enough for two lines.`, remedy: 'Nothing.' });
  });
  await settled(page);
  expect(await page.locator('.notice').count()).toBe(3);
  await apart();
});
