import { Standing } from '@studio/engine/standing';
import type { SessionInfo } from '@studio/engine/session_types';

/** Whose figures stand: a session of two surfaces, seen frame by frame. */
describe('the figures of the last step', () => {
  const frame = (steps: number, z: number, selection = [0], stretch = 1) => {
    const state = { steps, last: steps > 0 ? { time: 0.01 * steps, energy: steps, residual: 0 } : null, selection, body: null, bodies: [], load: {},
      surfaces: [{ id: '#1', alpha: stretch }, { id: '#2', alpha: stretch }] } as never as SessionInfo;
    return [state, [Float32Array.of(0, 0, z)]] as const;
  };
  let standing: Standing;
  const stands = (...of: Parameters<typeof frame>) => standing.stands(...frame(...of));
  beforeEach(() => {
    standing = new Standing();
    expect(stands(0, 0)).toBe(true); // no step: no figures
    expect(stands(1, 1)).toBe(true);
    expect(stands(2, 2)).toBe(true);
  });

  it('are not those of a shape that something else has changed', () => {
    expect(stands(2, 1.5)).toBe(false);
    expect(stands(3, 3)).toBe(true);
  });

  it('are not those of another selection, material or load', () => {
    expect(stands(2, 2, [1])).toBe(false);
    expect(stands(2, 2, [0, 1])).toBe(false);
    expect(stands(2, 2, [0], 5)).toBe(false);
    expect(standing.stands({ ...frame(2, 2)[0], load: { pressure: 1 } } as never, [Float32Array.of(0, 0, 2)])).toBe(false);
    expect(stands(2, 2)).toBe(true);
  });

  it('stand again where undo and redo lead back to what the step left', () => {
    expect(stands(2, 1.5)).toBe(false);
    expect(stands(2, 2)).toBe(true);
    expect(stands(1, 1)).toBe(true);
    expect(stands(0, 0)).toBe(true);
    expect(stands(2, 1.5)).toBe(false);
  });

  it('do not stand where nobody has seen what the step left, as in a document that goes on', () => {
    standing.renew(frame(2, 2)[0]);
    expect(stands(2, 2)).toBe(false);
    expect(stands(3, 3)).toBe(true);
  });

  it('stay as they were while the shape as it was opened is looked at', () => {
    expect(standing.stands(frame(2, 2)[0], null)).toBe(true);
    expect(stands(2, 1.5)).toBe(false);
    expect(standing.stands(frame(2, 1.5)[0], null)).toBe(false);
  });
});
