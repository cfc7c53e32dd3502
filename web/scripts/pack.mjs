// Packs what the studio's page loads as small as brotli can, beside each file:  node scripts/pack.mjs DIRECTORY
// Hosts that serve NAME.br for NAME need not compress; packing anew is skipped for contents that were packed before.
import { createHash } from 'node:crypto';
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { brotliCompress, constants } from 'node:zlib';

const assets = join(process.argv[2], 'assets');
const kept = fileURLToPath(new URL('../node_modules/.packed', import.meta.url));
mkdirSync(kept, { recursive: true });

const pack = promisify(brotliCompress);
await Promise.all(readdirSync(assets).filter((name) => /\.(wasm|js)$/.test(name)).map(async (name) => {
  const bytes = readFileSync(join(assets, name));
  const before = join(kept, createHash('sha256').update(bytes).digest('hex'));
  if (!existsSync(before)) {
    const { BROTLI_PARAM_QUALITY, BROTLI_MAX_QUALITY, BROTLI_PARAM_SIZE_HINT } = constants;
    writeFileSync(before, await pack(bytes, { params: { [BROTLI_PARAM_QUALITY]: BROTLI_MAX_QUALITY, [BROTLI_PARAM_SIZE_HINT]: bytes.length } }));
  }
  copyFileSync(before, join(assets, `${name}.br`));
}));
