// What the benchmarks do to the session: the studio's own stroke (src/tools/brush.ts), a ball of 0.08 diagonals, half sunk
// into a sheet of clay and moved by 0.4 radii at a time, there and back so that it meets what it left.
export const size = 200;
export const nets = [32, 64];
export const detail = 96;
const radius = 0.08 * Math.hypot(size, size);

export const sheet = (net) => [
  { do: 'new', size: [size, size], net: [net, net] },
  { do: 'hold', rows: 2 },
  { do: 'material', alpha: [0.1, 0, 0.1], beta: [0.001, 0.001, 0.001] },
  { do: 'evolve', mode: 'acm', lambda: 100 },
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

const sorted = (times) => [...times].sort((a, b) => a - b);
export const median = (times) => sorted(times)[Math.floor(times.length / 2)];
export const least = (times) => Math.min(...times);
export const worst = (times) => Math.max(...times);
export const ms = (t) => t.toFixed(2).padStart(9);
