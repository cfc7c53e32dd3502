import type { App } from '../app';
import type { Direct, Direction } from './knots';

/** Degrees and knots of a surface, as the session has them, to the last bit. */
export async function readDirections(app: App, index: number): Promise<Record<Direction, Direct>> {
  const { degree, knots_u, knots_v } = await app.client.query('surface', { surface: index });
  return { u: { degree: degree[0], knots: [...knots_u] }, v: { degree: degree[1], knots: [...knots_v] } };
}
