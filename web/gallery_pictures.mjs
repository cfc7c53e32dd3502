/** Draws the pictures of the gallery from the running studio, each scene as it looks after a little work. */
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const [width, height] = [264, 176]; // twice the size in the menu

/** What is done to a scene before its picture: a ball pressed in, or steps. */
const steps = {
  'Drape': 34, 'Trampoline': 14, 'Ball on a membrane': 5, 'Fig. 6.9 a': 6, 'Fig. 6.9 b': 6, 'Fig. 6.10': 3, 'Fig. 6.11': 3, 'Fig. 6.11, coupled': 3,
  'Fig. 6.12': 30, 'Fig. 6.13': 6, 'Fig. 6.14': 4, 'Fig. 6.15': 90,
};
const strokes = {
  'Clay sheet': [['b', [0.42, 0.52], [0.5, 0.46], [0.58, 0.5]]],
  'Fine clay sheet': [['b', [0.4, 0.5], [0.45, 0.45]], ['u', [0.55, 0.55], [0.62, 0.52]]],
  'Bonnet': [['u', [0.42, 0.5], [0.52, 0.47], [0.6, 0.45]]],
  'Bottle': [['b', [0.5, 0.55], [0.5, 0.62]]],
  'Torus': [['u', [0.36, 0.55], [0.42, 0.62]]],
  'Two patches': [['b', [0.4, 0.5], [0.5, 0.5], [0.6, 0.5]]],
};

/** Opens a scene of the gallery in place of what is there. */
export async function openScene(page, name) {
  await page.locator('summary[aria-label^=Gallery]').click();
  await page.locator('details[open] .menu-item.scene').filter({ has: page.locator(`b:text-is("${name}")`) }).click();
  await page.waitForTimeout(300);
  const leave = page.locator('dialog.question button', { hasText: 'Open without saving' });
  if (await leave.isVisible()) await leave.click();
  await page.waitForTimeout(1200);
}

export async function drawGallery(page, directory) {
  mkdirSync(directory, { recursive: true });
  await page.setViewportSize({ width: 1000, height: 560 });
  await page.evaluate(() => window.studio.setDisplay({ grid: false, fourViews: false }));
  await page.locator('summary[aria-label^=Gallery]').click();
  const names = await page.locator('.menu-item.scene b').allTextContents();
  await page.keyboard.press('Escape');
  for (const name of names) {
    await openScene(page, name);
    if (steps[name]) await page.evaluate((count) => window.studio.client.execute([{ do: 'step', count }]), steps[name]);
    const box = await page.locator('.view-perspective').boundingBox();
    for (const [key, ...places] of strokes[name] ?? []) {
      await page.keyboard.press(key);
      await page.evaluate((size) => (window.studio.hand.brush.settings.radius = 0.13 * window.studio.diagonal * size), name === 'Fine clay sheet' ? 0.6 : 1);
      const at = ([x, y]) => [box.x + box.width * x, box.y + box.height * y];
      await page.mouse.move(...at(places[0]));
      await page.mouse.down();
      for (const place of places) {
        await page.mouse.move(...at(place), { steps: 4 });
        await page.waitForTimeout(150);
      }
      await page.mouse.up();
    }
    await page.keyboard.press('v');
    await page.mouse.move(box.x + 4, box.y + 4);
    await page.evaluate(() => window.studio.client.query('journal'));
    await page.keyboard.press('f');
    await page.waitForTimeout(700);
    const base64 = await page.evaluate(async ([w, h]) => {
      const blob = await window.studio.viewer.picture(1);
      const whole = await createImageBitmap(blob);
      // The middle, in the shape of the menu's pictures.
      const scale = Math.max(w / whole.width, h / whole.height);
      const canvas = document.createElement('canvas');
      [canvas.width, canvas.height] = [w, h];
      const context = canvas.getContext('2d');
      context.imageSmoothingQuality = 'high';
      context.drawImage(whole, (w - whole.width * scale) / 2, (h - whole.height * scale) / 2, whole.width * scale, whole.height * scale);
      // Nothing where nothing is, so that it fits either theme.
      const pixels = context.getImageData(0, 0, w, h);
      const [red, green, blue] = pixels.data;
      for (let k = 0; k < pixels.data.length; k += 4) {
        const off = Math.max(Math.abs(pixels.data[k] - red), Math.abs(pixels.data[k + 1] - green), Math.abs(pixels.data[k + 2] - blue));
        if (off < 3) pixels.data[k + 3] = 0;
      }
      context.putImageData(pixels, 0, 0);
      return canvas.toDataURL('image/png').split(',')[1];
    }, [width, height]);
    writeFileSync(join(directory, `${name.toLowerCase().replace(/\W+/g, '-')}.png`), Buffer.from(base64, 'base64'));
  }
}
