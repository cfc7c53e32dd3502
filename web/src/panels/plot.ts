import { format, unitInWords } from '../document/units';
import type { StepInfo } from '../engine/session_types';
import { selected, unitOf } from '../engine/session_state';
import type { App } from './app';
import { h } from './dom';

const terms = [
  ['stretch', '--plot-1'],
  ['bend', '--plot-2'],
  ['kinetic', '--plot-3'],
  ['contact', '--plot-4'],
] as const;

/** The last step and those before it, where they are of the state that is shown; null where something else has changed it since. */
function figuresOf({ frame, steps }: App): { last: StepInfo; steps: readonly StepInfo[] } | null {
  const last = frame?.stands ? frame.state.last : null;
  return last ? { last, steps } : null;
}

/** The bar below: energy by term over the last steps, and the values of the last one. */
export function statusBar(app: App): HTMLElement {
  const canvas = h('canvas', { class: 'plot', width: 220, height: 44, aria: { label: 'Energy by term over the last steps' } });
  const legend = h('div', { class: 'legend' }, ...terms.map(([name]) => h('span', { class: `key ${name}` }, name)));
  const numbers = h('div', { class: 'numbers' });
  const element = h('footer', { class: 'status' }, canvas, legend, numbers);

  const update = () => {
    const { state, frame } = app;
    drawPlot(app, canvas);
    const last = figuresOf(app)?.last;
    const cells: [string, string, string][] = [];
    if (frame) {
      const points = selected(state!).reduce((sum, { net }) => sum + net.reduce((n, count) => n * count, 1), 0);
      cells.push(['points', String(points), 'Control points of what is selected']);
      cells.push(['unknowns', String(3 * points), 'Degrees of freedom: three for each control point; what is held is among them']);
      if (state!.steps > 0) cells.push(['steps', String(state!.steps), 'Steps so far']);
      if (last) {
        cells.push(['step', `${(1000 * last.time).toFixed(1)} ms`, 'Time of the last step alone']);
        cells.push(['energy', format(last.energy), 'Stretch and bend energy']);
        cells.push(['residual', format(last.residual), 'Imbalance of forces: 0 at rest']);
      }
      if (state!.steps > 0 || frame.moved > 0) cells.push(['moved', `${format(frame.moved)} ${unitInWords(unitOf(state, ''))}`, 'Largest distance from the surface as opened']);
      cells.push(['frame', `${(frame.computeTime + frame.pictureTime).toFixed(1)} ms`, 'Commands, evaluation and transfer in the worker']);
      if (app.framesPerSecond > 0) cells.push(['fps', app.framesPerSecond.toFixed(0), 'Frames per second']);
    }
    numbers.replaceChildren(...cells.map(([name, value, tip]) => h('span', { title: tip }, h('small', {}, name), value)));
  };
  app.onChange.push(update);
  return element;
}

/** The same, larger, with the size of the terms: for the panel. */
export function energyChart(app: App): HTMLElement {
  const canvas = h('canvas', { class: 'chart', aria: { label: 'Energy by term, large' } });
  const values = new Map(terms.map(([name]) => [name, h('output', {})]));
  const most = h('small', { class: 'chart-most' });
  const element = h('div', { class: 'energy' }, h('div', { class: 'chart-frame' }, canvas, most),
    h('div', { class: 'energy-terms' }, ...terms.map(([name]) => h('span', { class: `key ${name}` }, name, values.get(name)!))));
  app.onChange.push(() => {
    if (element.offsetParent === null) return; // its panel is closed
    drawPlot(app, canvas, [244, 84]);
    const steps = figuresOf(app)?.steps ?? [], last = steps.at(-1);
    for (const [name, output] of values) output.textContent = last ? format(last[name]) : '–';
    most.textContent = steps.length > 1 ? format(largest(steps)) : '';
  });
  return element;
}

const largest = (steps: readonly StepInfo[]) => steps.reduce((most, s) => Math.max(most, s.stretch, s.bend, s.kinetic, s.contact), 0);

function drawPlot(app: App, canvas: HTMLCanvasElement, [width, height] = [220, 44] as [number, number]): void {
  const context = canvas.getContext('2d');
  if (!context) return;
  const scale = Math.min(window.devicePixelRatio, 2);
  if (canvas.width !== width * scale) [canvas.width, canvas.height] = [width * scale, height * scale];
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  const steps = figuresOf(app)?.steps ?? [];
  if (steps.length < 2) return;
  const style = getComputedStyle(document.documentElement);
  const most = Math.max(largest(steps), 1e-300);
  for (const [name, colour] of terms) {
    if (steps.every((s) => s[name] === 0)) continue;
    context.beginPath();
    steps.forEach((s, k) => {
      context.lineTo((k / (steps.length - 1)) * width, height - 2 - Math.max(0, s[name] / most) * (height - 4));
    });
    context.strokeStyle = style.getPropertyValue(colour);
    context.lineWidth = 1.5;
    context.stroke();
  }
}
