import { gzipSync } from 'node:zlib';

import { openStudio } from './page';

it('the script that is fetched before the first stroke is at most 250 kB, compressed', async () => {
  const studio = await openStudio();
  const scripts = await studio.page.evaluate(() =>
    [...new Set([...performance.getEntriesByType('resource').map(({ name }) => name), ...[...document.scripts].map(({ src }) => src)])]
      .filter((url) => url.endsWith('.js')));
  let size = 0;
  for (const url of scripts) size += gzipSync(new Uint8Array(await (await fetch(url)).arrayBuffer())).byteLength;
  await studio.close();
  console.log(`${scripts.length} scripts, ${(size / 1000).toFixed(0)} kB`);
  expect(scripts.length).toBeGreaterThan(0);
  expect(size).toBeLessThan(250_000);
});
