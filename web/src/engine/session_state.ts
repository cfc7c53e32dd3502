import type { BodyInfo, SessionInfo, SurfaceInfo } from '@knead/generated';

/** What surfaces and bodies (curves and volumes) of a session are asked for alike. */

/** The length unit of the document, which has one; `otherwise` where there is nothing in it yet. */
export const unitOf = (state: SessionInfo | null | undefined, otherwise = 'mm'): string =>
  (state?.surfaces[0] ?? state?.bodies[0])?.unit ?? otherwise;

/** What is selected: surfaces, or one body. */
export const selected = (state: SessionInfo): (SurfaceInfo | BodyInfo)[] =>
  state.body !== null ? [state.bodies[state.body]!] : state.selection.map((k) => state.surfaces[k]!);
