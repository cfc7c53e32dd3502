import { clay } from '../engine/clay';
import { type Command, KneadError, type SurfaceInfo } from '../engine/session_types';
import type { Host } from './host';

/** Whether something was said of what holds a surface, or one without faces has moved: that was not by data that moved all faces. */
export const hasSettings = ({ hold, pins, constraints, moved, faces }: SurfaceInfo): boolean =>
  hold > 0 || pins > 0 || constraints.length > 0 || (moved > 0 && faces === 0);

/**
 * Selects a surface, and makes one as it came clay that is held at its edges. What faces lie on is held along their edges, so
 * that they go on meeting their neighbours, and the brush fits between them; a surface alone by its outer rows, or at its
 * sides where it has too few. `opening`: what is done belongs to the opened document.
 */
export async function makeReady(host: Host, index: number, opening: boolean): Promise<void> {
  const { client } = host;
  const surface = host.state!.surfaces[index]!;
  const run = (commands: Command[]) =>
    client.execute([{ do: 'select', surface: surface.id }, ...commands], false, opening);
  const distance = surface.faces > 0 ? await client.query('edge_distance', { surface: index }) : null;
  if (hasSettings(surface)) await run([]);
  else if (surface.faces === 0 && (!surface.bare || outerRows(surface.net) > 0)) await run(alone(surface.net));
  else {
    try {
      await run([{ do: 'hold', mode: 'position' }, ...clay]);
    } catch (error) {
      if (!(error instanceof KneadError)) throw error;
      await run([{ do: 'hold', mode: 'open' }, ...alone(surface.net)]); // what cannot be followed cannot be held, which is said
      host.notify({ kind: 'info', text: `Only the outer rows of control points are held: ${error.info.what}. Neighbouring faces may part from this one.` });
    }
  }
  if (distance) host.sizeBrush(0.5 * distance);
}

/** Outer rows that can be held and leave two free. */
const outerRows = (net: readonly number[]): number => Math.min(2, Math.floor((Math.min(...net) - 2) / 2));

/** Clay that is held by its outer rows. */
export function alone(net: readonly number[]): Command[] {
  const rows = outerRows(net);
  return [...(rows > 0 ? [{ do: 'hold', rows } as const] : []), ...clay];
}
