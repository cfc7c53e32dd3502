import type { Page } from 'playwright-core';

import { numbersOf, picture } from './page';

interface App {
  frame: { origin: number[]; pictures: { positions: Float32Array; net: Float32Array }[] };
  viewer: { main: { projectAll(points: ArrayLike<number>): Float32Array }; element: HTMLElement };
  display: Record<string, unknown>;
  theme: 'light' | 'dark';
  execute(commands: unknown[]): Promise<unknown>;
  setDisplay(change: Record<string, unknown>): void;
  setTheme(theme: 'light' | 'dark'): void;
}

export const setDisplay = (page: Page, change: Record<string, unknown>): Promise<void> =>
  page.evaluate((c) => (window as never as { studio: App }).studio.setDisplay(c), change);
export const setTheme = (page: Page, theme: 'light' | 'dark'): Promise<void> => page.evaluate((t) => (window as never as { studio: App }).studio.setTheme(t), theme);

/** Raises the middle of the sheet by h exp(−r²/2σ²), millimetres. */
export const raise = (page: Page, height: number, sigma: number): Promise<void> => page.evaluate(async ([h, s]) => {
  const { studio: app } = window as never as { studio: App };
  const { net } = app.frame.pictures[0]!;
  const which: number[] = [];
  const to: number[][] = [];
  for (let k = 0; 3 * k < net.length; ++k) {
    const p = [0, 1, 2].map((d) => net[3 * k + d]! + app.frame.origin[d]!);
    const r = Math.hypot(p[0]! - 100, p[1]! - 100);
    if (r > 80) continue;
    which.push(k);
    to.push([p[0]!, p[1]!, h! * Math.exp((-r * r) / (2 * s! * s!))]);
  }
  await app.execute([{ do: 'points', which, to }]);
}, [height, sigma]);

export interface Seen {
  /** Of the pixel. */
  rgb: [number, number, number];
  /** Lightness L* (CIE 1976). */
  l: number;
  /** Distance from the middle of the sheet of 200 mm. */
  r: number;
  /** The point in the file, and the normal there. */
  x: number;
  z: number;
  normal: [number, number, number];
}

/** What is seen at each point of the surface's grid. */
export async function pixels(page: Page): Promise<Seen[]> {
  const numbers = numbersOf(await (await picture(page)).evaluate(({ data, width }) => {
    const { studio: app } = window as never as { studio: App };
    const { origin, pictures: [{ positions, normals }] } = app.frame as never as { origin: number[]; pictures: [{ positions: Float32Array; normals: Float32Array }] };
    const box = app.viewer.element.getBoundingClientRect();
    const places = app.viewer.main.projectAll(positions);
    const found: number[] = [];
    for (let k = 0; 3 * k < positions.length; ++k) {
      const at = 4 * (Math.round(places[2 * k + 1]! - box.top) * width + Math.round(places[2 * k]! - box.left));
      for (let c = 0; c < 3; ++c) found.push(data[at + c]!);
      for (let d = 0; d < 3; ++d) found.push(positions[3 * k + d]! + origin[d]!);
      for (let d = 0; d < 3; ++d) found.push(normals[3 * k + d]!);
    }
    return new Uint8Array(Float64Array.from(found).buffer);
  }));
  return Array.from({ length: numbers.length / 9 }, (_, k) => {
    const [red, green, blue, x, y, z, ...normal] = numbers.slice(9 * k, 9 * k + 9) as [number, number, number, number, number, number, number, number, number];
    return { rgb: [red, green, blue], l: lightness(red, green, blue), r: Math.hypot(x - 100, y - 100), x, z, normal };
  });
}

const linear = (x: number) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
function lightness(red: number, green: number, blue: number): number {
  const y = 0.2126 * linear(red / 255) + 0.7152 * linear(green / 255) + 0.0722 * linear(blue / 255);
  return y > 0.008856 ? 116 * Math.cbrt(y) - 16 : 903.3 * y;
}

export const quantile = (list: number[], share: number): number => [...list].sort((a, b) => a - b)[Math.round(share * (list.length - 1))]!;
/** Without the outermost twentieths. */
export const spread = (list: number[]): number => quantile(list, 0.95) - quantile(list, 0.05);
