import type { Curves } from './module';

export const margin = { left: 52, right: 14, top: 24, bottom: 58 };

/** The positions of parameters and values in the picture. */
export class PlotFrame {
  width = 600;
  height = 260;
  u: [number, number] = [0, 1];
  v: [number, number] = [0, 1];
  /** Pixels per unit of weight of an impulse. */
  weight = 0;

  get right(): number {
    return this.width - margin.right;
  }
  get bottom(): number {
    return this.height - margin.bottom;
  }

  fitU(knots: readonly number[]): void {
    const [low, high] = [knots[0]!, knots.at(-1)!];
    const pad = 0.02 * (high - low);
    this.u = [low - pad, high + pad];
  }

  /** Room for all values, and for any arrows on both sides. */
  fitV({ lowest, highest, weight }: Curves, order: number): void {
    let [low, high] = order === 0 ? [0, 1] : [lowest, highest];
    if (!(high > low)) [low, high] = [0, weight > 0 ? weight : 1];
    if (weight > 0) {
      high = Math.max(high, -low);
      low = -high;
    }
    const pad = 0.06 * (high - low);
    this.v = [low < 0 ? low - pad : low, high + pad];
    this.weight = weight > 0 ? (0.8 * (this.y(0) - margin.top)) / weight : 0;
  }

  x(u: number): number {
    return margin.left + ((u - this.u[0]) / (this.u[1] - this.u[0])) * (this.right - margin.left);
  }

  y(v: number): number {
    // Far outside the picture heights are clamped, so that numbers stay valid in an SVG.
    const t = (v - this.v[0]) / (this.v[1] - this.v[0]);
    return this.bottom - Math.min(20, Math.max(-20, t)) * (this.bottom - margin.top);
  }

  parameter(x: number): number {
    return this.u[0] + ((x - margin.left) / (this.right - margin.left)) * (this.u[1] - this.u[0]);
  }

  /** The roundest number within about half a pixel. */
  roundParameter(x: number): number {
    const quantum = 10 ** Math.floor(Math.log10((this.u[1] - this.u[0]) / (this.right - margin.left)));
    return Number((Math.round(this.parameter(x) / quantum) * quantum).toPrecision(12));
  }

  get pixel(): number {
    return (this.u[1] - this.u[0]) / (this.right - margin.left);
  }
}
