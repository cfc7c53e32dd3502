import { chromium } from 'playwright-core';

import { root, serve } from './page';

/**
 * Serves the built page and starts a headless browser for each worker, once for all files; a file opens a context of its
 * own (page.ts). Workers find both in their environment.
 */
export default async function setup(): Promise<() => Promise<void>> {
  const server = await serve(`${root}/web/dist`);
  const browsers = await Promise.all(Array.from({ length: Number(process.env.STUDIO_WORKERS) }, () => chromium.launchServer({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    // The processor draws the page by itself, and only what WebGL draws by SwiftShader: a page by SwiftShader takes it ten times as long.
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-gpu-compositing',
      '--disable-background-networking', '--disable-component-update', '--disable-sync', '--no-first-run'],
  })));
  process.env.STUDIO_PAGE = server.url;
  process.env.STUDIO_BROWSERS = browsers.map((b) => b.wsEndpoint()).join(' ');
  return async () => {
    await Promise.all(browsers.map((b) => b.close()));
    await server.close();
  };
}
