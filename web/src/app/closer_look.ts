import type { PictureWindow } from '../engine/session_types';
import { eyeOf, eyeOn, pictureTolerance, roomy, serves, wantedWindow } from '../view/nearby';
import type { Viewer } from '../view/viewer';

const mostPlaces = 16; // of a part that are looked at
const restTime = 250; // milliseconds that views stand still before their pictures become finer

/**
 * Once the views have stood still for a moment: draws what they show from nearby as finely as that needs, and colours that take
 * longer than a frame may.
 */
export class CloserLook {
  private timer = 0;

  /** `quiet`: nothing is under way; `ask` for pictures with these windows. */
  constructor(private readonly viewer: Viewer, quiet: () => boolean, ask: () => void) {
    viewer.onDrawn.push(() => {
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => {
        if (quiet() && (viewer.frame?.late || this.wanted().some((wanted, k) => !serves(this.present(k), wanted)))) ask();
      }, restTime);
    });
  }

  /** Of each surface; those that serve stay. */
  windows(): (PictureWindow | null)[] {
    return this.wanted().map((wanted, k) => (serves(this.present(k), wanted) ? this.present(k) : wanted && roomy(wanted)));
  }

  private present(surface: number): PictureWindow | null {
    return this.viewer.surfaces[surface]?.picture?.window ?? null;
  }

  private wanted(): (PictureWindow | null)[] {
    const { viewer } = this;
    const eyes = viewer.viewports.flatMap((view) => (view.element.clientHeight > 0 ? [eyeOf(view.camera, view.element.clientHeight)] : []));
    const pictures = viewer.surfaces.map(({ picture }) => picture);
    const tolerance = pictureTolerance(pictures, viewer.display.detail);
    return pictures.map((picture, k) =>
      picture && wantedWindow(picture, viewer.standings(k).slice(0, mostPlaces).flatMap((at) => eyes.map((eye) => eyeOn(eye, at))), tolerance));
  }
}
