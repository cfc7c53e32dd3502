import { orbit } from './camera';
import type { Viewport } from './viewport';

const turnTime = 20_000; // milliseconds of one turn

/** Turns a view slowly about the vertical through its target, until somebody touches a view. */
export class Turntable {
  /** It began or ended. */
  onChange: () => void = () => {};
  private last: number | null = null;

  /** `views`: what a touch is on. */
  constructor(private readonly view: Viewport, views: HTMLElement) {
    for (const touch of ['pointerdown', 'wheel'] as const) views.addEventListener(touch, () => (this.on = false), { capture: true, passive: true });
  }

  get on(): boolean {
    return this.last !== null;
  }

  set on(on: boolean) {
    if (on === this.on) return;
    this.last = on ? performance.now() : null;
    if (on) requestAnimationFrame(this.turn);
    this.onChange();
  }

  private readonly turn = (): void => {
    if (this.last === null) return;
    const now = performance.now();
    // Where pictures take long it goes on in small steps.
    orbit(this.view, (2 * Math.PI * Math.min(100, now - this.last)) / turnTime, 0, this.view.target);
    this.last = now;
    this.view.moved();
    requestAnimationFrame(this.turn);
  };
}
