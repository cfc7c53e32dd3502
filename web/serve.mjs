// Serves a directory of static files on the loopback address:  node serve.mjs [directory] [port]
import { createReadStream, existsSync, readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync, constants, gzipSync } from 'node:zlib';

const types = {
  '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml', '.json': 'application/json', '.step': 'model/step',
};

/** How files go over the network to whom accepts it: as the build has packed them (scripts/pack.mjs), or packed once a file. */
const encodings = {
  br: (file) => existsSync(`${file}.br`) ? readFileSync(`${file}.br`)
    : brotliCompressSync(readFileSync(file), { params: { [constants.BROTLI_PARAM_QUALITY]: 5, [constants.BROTLI_PARAM_SIZE_HINT]: statSync(file).size } }),
  gzip: (file) => gzipSync(readFileSync(file)),
};

/** What every answer says: other pages may not put the studio into a frame, and types are what is said. */
const security = {
  'content-security-policy': "frame-ancestors 'none'", 'x-frame-options': 'DENY', 'x-content-type-options': 'nosniff',
  'referrer-policy': 'no-referrer', 'cross-origin-resource-policy': 'same-origin',
};

/** The path that a request asks for, without its query; nothing if it cannot be decoded. */
function pathOf(target) {
  try {
    const path = decodeURIComponent(target.split(/[?#]/, 1)[0]);
    return path.startsWith('/') && !path.includes('\0') ? normalize(path) : undefined;
  } catch {
    return undefined;
  }
}

/** Starts the server; port 0 takes a free one. Resolves to { url, close }. */
export function serve(directory, port = 0) {
  const packed = new Map();
  const server = createServer((request, response) => {
    const path = pathOf(request.url);
    if (path === undefined) {
      response.writeHead(400, security).end('bad request');
      return;
    }
    if (request.method !== 'GET' && request.method !== 'HEAD') {
      response.writeHead(405, { ...security, allow: 'GET, HEAD' }).end();
      return;
    }
    const file = join(directory, path.endsWith('/') ? join(path, 'index.html') : path);
    let size, version;
    try {
      const stat = statSync(file);
      if (!stat.isFile() || !file.startsWith(join(directory, '/'))) throw new Error('no file');
      size = stat.size;
      version = `${file} ${stat.mtimeMs} ${size}`;
    } catch {
      response.writeHead(404, security).end('not found');
      return;
    }
    const head = { ...security, 'content-type': types[extname(file)] ?? 'application/octet-stream', 'cache-control': 'no-cache' };
    // Names in assets/ change with their content: compressed once, kept by the browser.
    if (path.startsWith('/assets/')) head['cache-control'] = 'max-age=31536000, immutable';
    const accepted = (request.headers['accept-encoding'] ?? '').split(',').map((name) => name.split(';')[0].trim());
    const encoding = Object.keys(encodings).find((name) => accepted.includes(name));
    if (encoding && /\.(js|css|html|wasm)$/.test(file)) {
      const key = `${encoding} ${version}`;
      if (!packed.has(key)) packed.set(key, encodings[encoding](file));
      const bytes = packed.get(key);
      response.writeHead(200, { ...head, 'content-encoding': encoding, 'content-length': bytes.length }).end(bytes);
      return;
    }
    response.writeHead(200, { ...head, 'content-length': size });
    if (request.method === 'HEAD') response.end();
    else createReadStream(file).on('error', () => response.destroy()).pipe(response);
  });
  return new Promise((resolve, reject) => {
    server.on('error', reject);
    server.listen(port, '127.0.0.1', () =>
      resolve({ url: `http://127.0.0.1:${server.address().port}/`, close: () => new Promise((done) => server.close(done)) }));
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const directory = process.argv[2] ?? fileURLToPath(new URL('dist', import.meta.url));
  const wanted = Number(process.argv[3] ?? 8642);
  const { url } = await serve(directory, wanted).catch((error) => {
    if (error.code !== 'EADDRINUSE') throw error;
    return serve(directory, 0);
  });
  console.log(`studio: ${url}  (Ctrl+C ends it)`);
  for (const signal of ['SIGINT', 'SIGTERM']) process.on(signal, () => process.exit(0));
}
