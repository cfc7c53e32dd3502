import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { tarball } from './support';

/** A fresh directory with the package, as npm installs it without a network: KNEAD_FRESH. */
export default function setup(): () => void {
  const fresh = mkdtempSync(join(tmpdir(), 'knead-npm-'));
  writeFileSync(join(fresh, 'package.json'), '{ "private": true, "type": "module" }\n');
  execFileSync('npm', ['install', '--offline', '--no-audit', '--no-fund', '--silent', tarball()], { cwd: fresh, stdio: 'inherit' });
  process.env.KNEAD_FRESH = fresh;
  return () => rmSync(fresh, { recursive: true });
}
