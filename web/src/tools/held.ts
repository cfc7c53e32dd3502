import { type FaceEdge, hasEdges } from '../engine/context';
import type { Command, SurfaceInfo } from '../engine/session_types';

export const edgeNames = ['u0', 'u1', 'v0', 'v1'] as const;
/** A side of a surface, or an edge of a face on it by its id in the file. */
export type Side = (typeof edgeNames)[number];
export type Edge = Side | `#${string}`;
export type Continuity = 'open' | 'follow' | 'position' | 'tangent' | 'curvature' | 'symmetry';

export const continuityTitles: Record<Continuity, string> = { open: 'Free', follow: 'Follow', position: 'Position', tangent: 'Tangent', curvature: 'Curvature', symmetry: 'Symmetry' };
const sides: Record<Side, string> = { u0: 'Edge u = 0', u1: 'Edge u = 1', v0: 'Edge v = 0', v1: 'Edge v = 1' };
export const isSide = (edge: Edge): edge is Side => edge in sides;
export const edgeTitle = (edge: Edge): string => (isSide(edge) ? sides[edge] : `Edge ${edge}`);

/** What is asked of an edge. The rows that a surface is held by are another matter. */
export function continuityOf(info: SurfaceInfo, edge: Edge): Continuity {
  let all: Continuity = 'open';
  let own: Continuity | null = null;
  for (const c of info.constraints) {
    const side = isSide(edge);
    if (c.do === 'hold' && (!side || info.bare) && c.mode && c.mode !== 'rows') all = c.mode;
    if (c.do === 'edge' && (c.edge === edge || (side && c.edge === undefined && (c.which === edge || c.which === 'all')))) own = c.hold ?? 'position';
    if (c.do === 'symmetry' && side && c.edge === edge) own = 'symmetry';
  }
  return own ?? all;
}

const forms: Partial<Record<string, string>> = {
  PLANE: 'plane', CYLINDRICAL_SURFACE: 'cylinder', CONICAL_SURFACE: 'cone', SPHERICAL_SURFACE: 'sphere', TOROIDAL_SURFACE: 'torus',
  DEGENERATE_TOROIDAL_SURFACE: 'torus', SURFACE_OF_REVOLUTION: 'surface of revolution', SURFACE_OF_LINEAR_EXTRUSION: 'extrusion',
};

/** "a plane" for the entity "PLANE". */
export function aForm(form: string): string {
  const title = forms[form] ?? form.toLowerCase().replaceAll('_', ' ');
  return `${/^[aeiou]/.test(title) ? 'an' : 'a'} ${title}`;
}

/** What an edge is to the faces that meet there. */
export interface Meeting {
  /** Faces of other surfaces stay behind where it is free: it opens. */
  opens: boolean;
  text: string;
  follows: boolean;
}

/** `own`: the surface that the edge is looked at from. */
export function meetingAt(edge: FaceEdge, own: string): Meeting {
  if (edge.seam) {
    return { opens: true, follows: true, text: 'The surface meets itself here. Free: a gap opens, because the edge stays. Follow: both sides move together.' };
  }
  const others = edge.meets.filter((m) => m.surface !== own);
  if (others.length === 0) return { opens: false, follows: true, text: 'No other face meets it: nothing opens where it moves.' };
  const faces = listed(others.map((m) => `${forms[m.form] ?? 'face'} ${m.face}`));
  const [they, all] = others.length === 1 ? ['that face stays', 'both'] : ['those faces stay', 'all'];
  return {
    opens: true,
    follows: true,
    text: `Shared with ${faces}. Free: a gap opens, because ${they}. Follow: ${all} move together.`,
  };
}

const counted = (count: number, one: string, many = `${one}s`) => `${count} ${count === 1 ? one : many}`;

function listed(parts: string[]): string {
  return parts.length < 2 ? parts.join('') : `${parts.slice(0, -1).join(', ')} and ${parts.at(-1)!}`;
}

/** A surface, the ids of the edges of the faces on it, and those of them at which other faces would stay behind. */
export interface HeldFace {
  info: SurfaceInfo;
  edges: readonly Edge[];
  open: readonly Edge[];
}

/** What of a surface is held, in a few words. `faceEdges`: ids of the edges of the faces on it; `open`: those that would open. */
export function heldInWords(info: SurfaceInfo, faceEdges: readonly Edge[], open: readonly Edge[] = []): string {
  return heldTogether([{ info, edges: faceEdges, open }]);
}

/** The same of surfaces that are selected together. An edge of several counts once, as held if none of them lets it go. */
export function heldTogether(faces: readonly HeldFace[]): string {
  const loose = ({ info }: HeldFace, edge: Edge) => ['open', 'follow'].includes(continuityOf(info, edge));
  const any = (test: (info: SurfaceInfo) => boolean) => faces.some(({ info }) => test(info));
  const parts: string[] = [];
  const rows = Math.min(...faces.map(({ info }) => info.hold));
  if (rows > 0) parts.push(counted(rows, 'outer row'));
  const name = ({ info }: HeldFace, edge: Edge) => (isSide(edge) ? `${info.id} ${edge}` : edge);
  const all = new Set(faces.flatMap((face) => face.edges.map((e) => name(face, e))));
  const gone = new Set(faces.flatMap((face) => face.edges.filter((e) => loose(face, e)).map((e) => name(face, e))));
  const some = all.size > 0 && any((info) => info.constraints.some((c) => c.do === 'hold' || (c.do === 'edge' && c.edge !== undefined)));
  const count = all.size - gone.size;
  if (some) parts.push(count === all.size ? counted(count, 'edge') : `${count} of ${all.size} edges`);
  // A closed surface without edges is held in its place.
  if (all.size === 0 && faces.every(({ info }) => hasEdges(info) && info.constraints.some((c) => c.do === 'hold' && c.mode !== 'open'))) parts.push('its place');
  const alone = (face: HeldFace): HeldFace => ({ ...face, info: { ...face.info, bare: false } }); // a side that is no edge is held by itself alone
  const sideCount = faces.reduce((sum, face) => sum + edgeNames.filter((e) => !face.edges.includes(e) && !loose(alone(face), e)).length, 0);
  if (sideCount > 0) parts.push(counted(sideCount, some ? 'side' : 'edge'));
  const pins = faces.reduce((sum, { info }) => sum + info.pins, 0);
  if (pins > 0) parts.push(counted(pins, 'point'));
  if (any((info) => info.constraints.some((c) => c.do === 'freeze'))) parts.push('frozen spans');
  if (any((info) => info.constraints.some((c) => c.do === 'keep'))) parts.push('kept lines');
  const text = listed(parts);
  const words = parts.length === 0 ? 'Nothing held' : `${text.charAt(0).toUpperCase()}${text.slice(1)} held`;
  const opening = new Set(faces.flatMap(({ info, open }) => open.filter((e) => continuityOf(info, e) === 'open'))).size;
  return opening > 0 ? `${words}, ${opening === 1 ? 'one opens' : `${opening} open`} when it moves` : words;
}

/** A command that holds something, as a line of a list. */
export function constraintInWords(c: Command): string {
  const percent = (x: number) => `${Math.round(100 * x)} %`;
  switch (c.do) {
    case 'edge': {
      const edge = c.edge ?? c.which ?? 'all';
      return `${edge === 'all' ? 'All edges' : edgeTitle(edge as Edge)}: ${continuityTitles[c.hold ?? 'position'].toLowerCase()}`;
    }
    case 'hold': return `Edges of the faces: ${continuityTitles[c.mode && c.mode !== 'rows' ? c.mode : 'position'].toLowerCase()}`;
    case 'freeze': {
      const [[a, b], [d, e]] = c.region;
      return `Frozen: u ${percent(a)} to ${percent(b)}, v ${percent(d)} to ${percent(e)}`;
    }
    case 'symmetry': return c.mirror ? `Mirrored across the middle of ${c.mirror}` : `${edgeTitle((c.edge ?? 'u0') as Edge)}: symmetry`;
    case 'pin': return c.at ? 'A point of the surface is pinned' : 'Control points are pinned';
    case 'keep': return 'A line of the surface is kept';
    default: return c.do;
  }
}
