// The same in a page, with Vite: sculpts the chosen file in a worker. Change the numbers to suit your part.
import { KneadError, open } from 'knead-cad/worker';

const element = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;
const message = element('message');
const bar = element<HTMLProgressElement>('progress');

async function sculpt(file: File): Promise<void> {
  const doc = await open(file);
  const skin = (await doc.surfaces)[0]!;
  const { lower, upper } = await skin.info;
  const size = Math.max(...upper.map((x, k) => x - lower[k]!));
  await doc.select(skin.id).hold({ mode: 'position' });
  await doc.tool('ball', { shape: 'sphere', radius: 0.1 * size, at: 'middle' }).move('ball', { by: [0, 0, 0.07 * size] });
  await doc.step(15, { lambda: 20, progress: (done, total) => { bar.value = done / total; } });

  message.textContent = `${skin.label || skin.id} moved by up to ${(await doc.report).largest_displacement.toPrecision(4)} ${skin.unit}`;
  const result = element<HTMLAnchorElement>('result');
  result.href = URL.createObjectURL(new Blob([await doc.save()]));
  result.download = file.name;
  result.hidden = false;
}

element<HTMLInputElement>('file').onchange = ({ target }) => {
  const [file] = (target as HTMLInputElement).files ?? [];
  if (file) sculpt(file).catch((error: unknown) => { message.textContent = error instanceof KneadError ? error.message : String(error); });
};
