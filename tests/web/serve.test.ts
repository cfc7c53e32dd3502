import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

let root: string, port: number, close: () => Promise<void>;

beforeAll(async () => {
  root = mkdtempSync(join(tmpdir(), 'knead-serve-'));
  mkdirSync(join(root, 'site'));
  writeFileSync(join(root, 'site/index.html'), '<title>page</title>');
  writeFileSync(join(root, 'site/plate.step'), 'ISO-10303-21;');
  writeFileSync(join(root, 'secret'), 'secret');
  const module = new URL('../../web/serve.mjs', import.meta.url).href;
  const { serve } = await import(/* @vite-ignore */ module);
  const server = await serve(join(root, 'site'));
  port = Number(new URL(server.url).port);
  close = server.close;
});

afterAll(async () => {
  await close();
  rmSync(root, { recursive: true });
});

/** The answer to a request line as it stands: clients mend paths before they send them. */
const answer = (line: string): Promise<string> =>
  new Promise((resolve, reject) => {
    let text = '';
    const socket = connect(port, '127.0.0.1', () => socket.write(`${line} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n`));
    socket.on('data', (bytes) => (text += bytes)).on('end', () => resolve(text)).on('error', reject);
  });

test.each(['GET /%', 'GET //', 'GET /%00', 'GET /%ff', 'GET /../secret', 'GET /%2e%2e/secret', 'GET //etc/passwd', 'GET /site?', 'OPTIONS *', 'GET http://[/'])(
  'a request for nothing is answered, and the server goes on: %s', async (line: string) => {
    expect(await answer(line)).toMatch(line === 'GET //' ? /^HTTP\/1.1 200 / : /^HTTP\/1.1 40[045] /);
    expect(await answer('GET /')).toContain('<title>page</title>');
  });

test('no page may frame the studio, and types are not guessed', async () => {
  for (const line of ['GET /', 'GET /plate.step', 'GET /none', 'GET /%', 'POST /']) {
    const text = (await answer(line)).toLowerCase();
    expect(text).toContain("content-security-policy: frame-ancestors 'none'");
    expect(text).toContain('x-content-type-options: nosniff');
  }
});

test('HEAD has the headers of GET and no body', async () => {
  const text = await answer('HEAD /plate.step');
  expect(text).toMatch(/content-length: 13\r\n/i);
  expect(text.endsWith('\r\n\r\n')).toBe(true);
});
