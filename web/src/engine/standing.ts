import { selected } from './session_state';
import type { SessionInfo } from './session_types';

const most = 1000; // steps whose states are known

/** FNV-1a of the bits of numbers. */
function hashOf(all: readonly Float32Array[]): number {
  let hash = 0x811c9dc5;
  for (const numbers of all) {
    const bits = new Uint32Array(numbers.buffer, numbers.byteOffset, numbers.length);
    for (const word of bits) hash = Math.imul(hash ^ word, 0x01000193);
  }
  return hash;
}

/**
 * Whether the figures of the last step are those of the state that is shown: what is selected, its shape, its material and its
 * loads are as that step left them. It does not matter how they came to be so: undo leads back to figures that stand.
 */
export class Standing {
  private left = new Map<string, string>();
  private steps = 0;
  private stood = true;

  /** Another session: what its steps left was not seen. */
  renew({ steps }: SessionInfo): void {
    this.left.clear();
    this.steps = steps;
  }

  /** `nets`: control points of what is selected; null where those of another state are shown. */
  stands(state: SessionInfo, nets: readonly Float32Array[] | null): boolean {
    const { last, steps, load } = state;
    if (!last || !nets) return last ? this.stood : true;
    const step = `${steps} ${last.time} ${last.energy} ${last.residual}`;
    const now = JSON.stringify([selected(state), load, hashOf(nets)]);
    if (!this.left.has(step) && steps > this.steps) {
      this.left.set(step, now);
      if (this.left.size > most) this.left.delete(this.left.keys().next().value!);
    }
    this.steps = steps;
    return (this.stood = this.left.get(step) === now);
  }
}
