import { commands, scene, settled, studioOfFile } from './page';

const studio = studioOfFile({ width: 1100, height: 720 });

const openPanel = async (name: string) => {
  const panel = studio.page.locator(`.panel[data-panel=${name}]`);
  if (await panel.getAttribute('open') === null) await panel.locator('> summary').click();
  await settled(studio.page);
};
const fill = async (label: string, text: string) => {
  await studio.page.locator(`input[aria-label="${label}"]`).fill(text);
  await studio.page.keyboard.press('Enter');
  await settled(studio.page);
};

describe('a shell', () => {
  it('is chosen in the material panel, loaded and balanced, and shows its stresses with a legend', async () => {
    const { page } = studio;
    await scene(page, 'Clay sheet');
    await openPanel('Material');
    const model = (name: string) => page.locator('.panel[data-panel=Material]').getByRole('button', { name, exact: true });
    expect(await model('Linear').getAttribute('aria-pressed')).toBe('true');
    await model('Shell').click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'material', model: 'shell', young: 210000 });
    expect(await model('Shell').getAttribute('aria-pressed')).toBe('true');
    expect(await page.locator('input[aria-label=Stretch]').count()).toBe(0);
    await fill('Thickness', '2');
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'material', thickness: 2 });
    await openPanel('Evolution');
    await fill('Gravity z', '-9810');
    await page.getByRole('button', { name: 'Balance' }).click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'evolve', mode: 'static' });
    await page.locator('select[aria-label="Colour by"]').selectOption('von_mises');
    await settled(page);
    const legend = page.locator('.legend-card');
    expect(await legend.locator('b').textContent()).toBe('Von Mises stress, force/mm²');
    const ticks = await legend.locator('.legend-ticks span').allTextContents();
    expect(Number(ticks.at(-1))).toBeGreaterThan(0.01);
    await model('Forms').click();
    await settled(page);
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'material', model: 'fundamental' });
    await fill('Weight of lengths', '3');
    expect((await commands(page)).at(-1)).toMatchObject({ do: 'material', w1: 3 });
    await model('Linear').click();
    await settled(page);
    expect(await page.locator('input[aria-label=Stretch]').count()).toBe(1);
  });
});
