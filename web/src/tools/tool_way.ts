import type { Command, ToolInfo, Vector3 } from '../engine/session_types';

/** Pieces of a tool's size that it may go between two steps of the surface, so as not to pass through it. */
const perSize = 8;

/** How many pieces a tool of this size takes for a way. */
const pieces = (way: number, size: number | null): number => (size ? Math.max(1, Math.ceil((perSize * way) / size)) : 1);

/** A tool's way in pieces with a step after each but the last; at most so many, which are longer then. */
export function wayOf(tool: Pick<ToolInfo, 'name' | 'size'>, by: Vector3, most: number): Command[] {
  const count = Math.min(most, pieces(Math.hypot(...by), tool.size));
  const move: Command = { do: 'move', tool: tool.name, by: by.map((x) => x / count) as Vector3 };
  return Array.from({ length: 2 * count - 1 }, (_, k) => (k % 2 === 0 ? move : { do: 'step' }));
}

/** Whether a way in so many pieces would have longer ones than keep the tool from passing through. */
export const tooFar = (tool: Pick<ToolInfo, 'size'>, by: Vector3, most: number): boolean => pieces(Math.hypot(...by), tool.size) > most;
