// What the benchmarks do to the session: steps under the ball of the studio's brush (src/tools/brush.ts), of 0.08 diagonals, half
// sunk into a sheet of clay and moved by 0.4 radii at a time, there and back so that it meets what it left.
export const size = 200;
export const nets = [32, 64];
export const detail = 96;
const radius = 0.08 * Math.hypot(size, size);

export const sheet = (net, accuracy = 'exact') => [
  { do: 'new', size: [size, size], net: [net, net] },
  { do: 'hold', rows: 2 },
  { do: 'material', alpha: [0.1, 0, 0.1], beta: [0.001, 0.001, 0.001] },
  { do: 'evolve', mode: 'acm', lambda: 100, accuracy },
];

/** Scripts are as exact as they can be; the page's strokes are interactive. */
export const accuracies = ['exact', 'interactive'];

/** The sheet that a new page shows, of what its strokes press. */
export const clay = (net) => [
  { do: 'new', size: [size, size], net: [net, net] },
  { do: 'hold', rows: 2 },
  { do: 'material', preset: 'clay' },
  { do: 'evolve', mode: 'acm', lambda: 100, accuracy: 'interactive' },
];

/** The commands of every place. */
export const places = Array.from({ length: 60 }, (_, k) => {
  const along = (k % 12) * 0.4 * radius, line = Math.floor(k / 12);
  const x = size * 0.3 + (line % 2 === 0 ? along : 11 * 0.4 * radius - along), y = size * 0.4 + line * 0.35 * radius;
  return [
    { do: 'tool', name: 'brush', shape: 'sphere', radius, position: [x, y, 0.5 * radius], mode: 'collision', plasticity: 1 },
    { do: 'step' },
  ];
});

/** What the page sends for one stroke: a ball put down, half sunk, and led on as far as the pointer moves in a frame. */
export const firstStroke = Array.from({ length: 25 }, (_, k) => {
  const at = [size * 0.3 + 0.2 * radius * k, size * 0.45, 0.5 * radius];
  const stroke = { do: 'stroke', tool: 'brush', path: [at], open: true };
  return k > 0 ? [stroke] : [{ do: 'tool', name: 'brush', shape: 'sphere', radius, position: at, mode: 'collision', plasticity: 1, touches: 'visible' }, stroke];
});

/** Headless, drawing by software. */
export const chromiumOptions = {
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--no-first-run'],
};

const sorted = (times) => [...times].sort((a, b) => a - b);
export const median = (times) => sorted(times)[Math.floor(times.length / 2)];
export const least = (times) => Math.min(...times);
export const worst = (times) => Math.max(...times);
export const ms = (t) => t.toFixed(2).padStart(9);
