import { download } from '../../document/download';
import type { Gramians, Curves } from './module';
import { methods, pairs } from './module';
import { exact } from './names';

/** What is shown, as text for other programs: numbers with all their digits. */

export function curvesCsv({ points, offsets, impulses }: Curves): string {
  const lines = ['function,u,value'];
  for (let i = 0; i + 1 < offsets.length; ++i) {
    for (let k = offsets[i]!; k < offsets[i + 1]!; ++k) lines.push(`${i},${exact(points[2 * k]!)},${exact(points[2 * k + 1]!)}`);
  }
  if (impulses.length > 0) lines.push('', 'function,knot,derivative_of_impulse,weight');
  for (let k = 0; k < impulses.length; k += 4) lines.push(`${impulses[k]},${exact(impulses[k + 1]!)},${impulses[k + 2]},${exact(impulses[k + 3]!)}`);
  return lines.join('\n') + '\n';
}

export function gramiansCsv(g: Gramians): string {
  const names = [...methods, 'absolute_integral', ...pairs.map(([x, y]) => `${x}_minus_${y}`)];
  const tables = [...g.values, g.absolute, ...g.differences];
  const lines = [`i,j,${names.join(',')}`];
  const { size: n, bandwidth: p } = g;
  for (let i = 0; i < n; ++i) {
    for (let j = Math.max(0, i - p); j <= Math.min(n - 1, i + p); ++j) {
      lines.push([i, j, ...tables.map((t) => exact(t[i * (2 * p + 1) + j - i + p]!))].join(','));
    }
  }
  return lines.join('\n') + '\n';
}

const carried = ['fill', 'stroke', 'stroke-width', 'stroke-dasharray', 'stroke-linejoin', 'opacity', 'fill-opacity', 'stroke-opacity', 'font-size', 'font-family', 'visibility'];

/** The picture as a file of its own, with the styles written into the elements. */
export function svgText(svg: SVGSVGElement, background: string): string {
  const copy = svg.cloneNode(true) as SVGSVGElement;
  const from = [...svg.querySelectorAll<SVGElement>('*')];
  [...copy.querySelectorAll<SVGElement>('*')].forEach((element, k) => {
    const style = getComputedStyle(from[k]!);
    for (const name of carried) {
      const value = style.getPropertyValue(name);
      if (value !== '') element.setAttribute(name, value);
    }
    for (const name of [...element.getAttributeNames()]) {
      if (/^(class|role|tabindex|aria-.*|data-.*)$/.test(name)) element.removeAttribute(name);
    }
  });
  for (const unseen of copy.querySelectorAll('[visibility=hidden], title')) unseen.remove();
  const ground = document.createElementNS('http://www.w3.org/2000/svg', 'rect');
  ground.setAttribute('width', '100%');
  ground.setAttribute('height', '100%');
  ground.setAttribute('fill', background);
  copy.prepend(ground);
  for (const name of ['class', 'role', 'aria-label']) copy.removeAttribute(name);
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  return new XMLSerializer().serializeToString(copy);
}

/** Into the clipboard or, if the browser refuses that, into a file. True for the clipboard. */
export async function copyText(text: string, name: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    download(text, name, 'text/csv');
    return false;
  }
}
