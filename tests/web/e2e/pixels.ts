import type { Page } from 'playwright-core';

import { picture } from './page';

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
export const pixels = async (page: Page): Promise<Seen[]> => (await picture(page)).evaluate((image) => {
  const { studio: app } = window as never as { studio: App };
  const { origin, pictures: [{ positions, normals }] } = app.frame as never as { origin: number[]; pictures: [{ positions: Float32Array; normals: Float32Array }] };
  const { data } = image;
  const box = app.viewer.element.getBoundingClientRect();
  const places = app.viewer.main.projectAll(positions);
  const linear = (x: number) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  return Array.from({ length: positions.length / 3 }, (_, k) => {
    const at = 4 * (Math.round(places[2 * k + 1]! - box.top) * image.width + Math.round(places[2 * k]! - box.left));
    const y = [0.2126, 0.7152, 0.0722].reduce((sum, w, c) => sum + w * linear(data[at + c]! / 255), 0);
    return { rgb: [data[at]!, data[at + 1]!, data[at + 2]!] as [number, number, number], x: positions[3 * k]! + origin[0]!, z: positions[3 * k + 2]! + origin[2]!, normal: [...normals.subarray(3 * k, 3 * k + 3)] as [number, number, number], r: Math.hypot(positions[3 * k]! + origin[0]! - 100, positions[3 * k + 1]! + origin[1]! - 100), l: y > 0.008856 ? 116 * Math.cbrt(y) - 16 : 903.3 * y };
  });
});

export const quantile = (list: number[], share: number): number => [...list].sort((a, b) => a - b)[Math.round(share * (list.length - 1))]!;
/** Without the outermost twentieths. */
export const spread = (list: number[]): number => quantile(list, 0.95) - quantile(list, 0.05);
