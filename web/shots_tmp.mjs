import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { serve } from './serve.mjs';
const here = (path) => fileURLToPath(new URL(path, import.meta.url));
export async function open(width = 1280, height = 760, options = {}) {
  const server = await serve(here('dist'));
  const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'] });
  const context = await browser.newContext({ viewport: { width, height }, ...options });
  await context.addInitScript(() => localStorage.setItem('knead-tour', '1'));
  const page = await context.newPage();
  page.on('console', (m) => console.log('console', m.type(), m.text()));
  page.on('pageerror', (e) => console.log('pageerror', e.message));
  await page.goto(server.url);
  await page.waitForSelector('html[data-ready]', { state: 'attached' });
  const settled = () => page.evaluate(async () => { for (let k = 0; k < 2; ++k) { await window.studio.client.followed(); await window.studio.client.journal(); await new Promise((r) => requestAnimationFrame(() => requestAnimationFrame(r))); } });
  const at = async (x, y, view = 'perspective') => { const b = await page.locator(`.view-${view}`).boundingBox(); return [b.x + b.width * x, b.y + b.height * y]; };
  const shot = async (name) => { await settled(); await page.screenshot({ path: `/tmp/viewshots/${name}.png` }); };
  const scene = async (name) => { await page.locator('summary[aria-label^=Gallery]').click(); await page.locator('details[open] .menu-item', { hasText: name }).click(); await page.waitForTimeout(800); await settled(); };
  const drag = async (from, to, button = 'left') => { await page.mouse.move(...from); await page.mouse.down({ button }); await page.mouse.move(...to, { steps: 6 }); await page.waitForTimeout(60); await page.mouse.up({ button }); await settled(); };
  return { page, at, shot, scene, drag, settled, close: async () => { await browser.close(); await server.close(); } };
}
