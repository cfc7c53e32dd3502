// Generated from the engine's descriptions; not to be edited. Lengths are in file units.

/** make a surface, a curve or a volume, in a document without a file, and select it */
export type NewCommand = {
  do: 'new';
  /** what is made */
  shape?: 'plane' | 'cylinder' | 'sphere' | 'torus' | 'revolution' | 'curve' | 'volume';
  /** of a curve or a volume */
  form?: 'line' | 'circle' | 'helix' | 'box' | 'cylinder';
  /** of a plane: width along x (u) and height along y (v); of a line along x; of a box along x, y, z; one number for all (length) */
  size?: number | number[];
  /** of cylinder, sphere, circle and helix; of a torus, to the middle of its tube (length) */
  radius?: number;
  /** of a cylinder or a helix (length) */
  height?: number;
  /** of a helix */
  turns?: number;
  /** tube radius of a torus, less than `radius` (length) */
  minor?: number;
  /** of a revolution: `[[r, z], …]`, r ≥ 0, control points of a B-spline of degree `degree[1]` */
  profile?: [number, number][];
  /** in u and v, of a volume also w; one number for all; only v for the surfaces cylinder and revolution; what is round has degree 2 around */
  degree?: number | number[];
  /** control points in each direction, likewise; of the surface cylinder only in v, of the volume at least 3 in u and v */
  net?: number | number[];
  /** knot vector of u, which determines the net; not for round shapes */
  knots_u?: number[];
  /** knot vector of v; not for sphere and torus */
  knots_v?: number[];
  /** knot vector of w, of a volume */
  knots_w?: number[];
  /** instead of a form: all control points `[x, y, z]`, point (i, j) at place i n + j of a net m × n, the last direction fastest */
  points?: [number, number, number][];
  /** of a plane or points: one > 0 for each control point, in the same order; of a revolution: one for each point of the profile */
  weights?: number[];
  /** where the origin of the shape goes (length) */
  position?: [number, number, number];
  /** of lengths; a document has one */
  unit?: 'mm' | 'um' | 'cm' | 'dm' | 'm' | 'km' | 'inch' | 'foot' | 'yard' | 'mile' | 'mil' | 'microinch';
  /** its label in the file */
  name?: string;
};

/** choose the surfaces, or the curve or volume, that the following commands act on */
export type SelectCommand = {
  do: 'select';
  /** id as `knead info` lists it, `"#123"`; this or `surfaces` */
  surface?: string;
  /** several of them */
  surfaces?: string[];
  /** also all surfaces that seams connect with these, directly or through others */
  connected?: boolean;
  /** id of a curve or a volume, instead; it is selected alone. Those of a file are its free curves */
  body?: string;
};

/** make planes, cylinders and the like exact B-spline surfaces that can be sculpted */
export type ConvertCommand = {
  do: 'convert';
  /** id of the surface, or of a face on it, as `knead info --faces` lists them; this, `surfaces` or `neighbours` */
  surface?: string;
  /** several of them */
  surfaces?: string[];
  /** all that meet faces on the selected surfaces */
  neighbours?: boolean;
};

/** resistance to stretching and bending, in the order 11, 12, 22; fields not given stay */
export type MaterialCommand = {
  do: 'material';
  /** stretch; α11, α22 ≥ 0 and α12² ≤ α11 α22; of a curve `[11]`, of a volume `[11, 12, 13, 22, 23, 33]` */
  alpha?: number[];
  /** bend; none negative */
  beta?: number[];
  /** per area, for `evolve` dynamic and `load` gravity */
  mass?: number;
  /** force per velocity and area, for `evolve` dynamic */
  damping?: number;
  /** `[[s0, s1], [t0, t1]]`: only there; what was set elsewhere stays (fraction) */
  region?: [[number, number], [number, number]];
  /** width of the border of the region, in fractions (fraction) */
  falloff?: number;
  /** only this one, by samples or a formula; `alpha` and `beta` are then ignored */
  coefficient?: 'alpha11' | 'alpha12' | 'alpha22' | 'beta11' | 'beta12' | 'beta22' | 'mass' | 'damping' | 'young' | 'thickness';
  /** `[m, n]` samples over the domain, its ends included */
  counts?: [number, number];
  /** m n numbers, along v first, linear in between; all that is convex coefficient by coefficient */
  samples?: number[];
  /** of `s`, `t`, the fractions along u and v, and `x`, `y`, `z`, the place there, as `1 + 4*exp(-40*((s - 0.5)^2 + (t - 0.5)^2))`; as a cubic spline ([materials-and-loads.md](materials-and-loads.md)) */
  formula?: string;
  /** of that spline */
  tolerance?: number;
  /** of whole surfaces: coefficients, the lambda of `evolve` and what strokes leave, as [clay.md](clay.md) lists them */
  preset?: 'clay' | 'wax' | 'rubber' | 'sheet metal' | 'cloth' | 'membrane';
  /** share of a displacement that strokes leave (fraction) */
  plasticity?: number;
  /** up to this displacement strokes leave nothing */
  yield?: number;
  /** how far a dent is felt, 0 as far as lambda lets it */
  locality?: number;
  /** what `yield` and `locality` count */
  lengths?: 'radii' | 'file';
  /** of whole surfaces */
  model?: 'linear' | 'shell' | 'fundamental' | 'plate';
  /** of a shell: Young's modulus, force per area; all in units of the file */
  young?: number;
  /** of a shell or a plate: Poisson's ratio */
  poisson?: number;
  /** of a shell (length) */
  thickness?: number;
  /** of a shell: mass per volume, for `load` gravity */
  density?: number;
  /** of a plate, in the units of `beta` */
  rigidity?: number;
  /** of `fundamental`: weights of the first form, 11, 12, 22, or one number for all; per du dv of the knots as they are */
  w1?: number | [number, number, number];
  /** of the second form, of a curve of its curvature */
  w2?: number | [number, number, number];
  /** first all of it is as of a new surface, everywhere: stretch, bend, mass, damping, the model and what strokes leave */
  reset?: boolean;
};

/** make the present shape the rest shape; what the energy acts on */
export type RestCommand = {
  do: 'rest';
  /** of what the energy is */
  mode?: 'shape' | 'none';
};

/** the units that the numbers are in */
export type ScalingCommand = {
  do: 'scaling';
  /** in which units numbers are */
  mode?: 'normalised' | 'raw';
};

/** hold the edges of faces, or the outer rows of control points on every side */
export type HoldCommand = {
  do: 'hold';
  /** number of rows in mode `rows`; 0 holds none */
  rows?: number;
  /** what is held */
  mode?: 'rows' | 'trim' | 'trim-g1' | 'trim-g2' | 'free';
  /** for every surface of the document, not only the selected ones */
  all?: boolean;
};

/** hold control points or a point, in addition to those held already */
export type PinCommand = {
  do: 'pin';
  /** `[[i, j], …]`, i along u and j along v, from 0 (of a curve `[i]`, of a volume `[i, j, k]`); this or `at`. They are identified by number, so the net cannot be refined while they are pinned */
  control_points?: number[][];
  /** `[s, t]`: a surface point; of a curve `[s]`, of a volume `[s, t, r]` (fraction) */
  at?: number[];
  /** `[x, y, z]` where that point goes (length) */
  to?: [number, number, number];
  /** the coordinates of that point that are held, as `"z"` or `"xy"` */
  components?: string;
};

/** hold edges of the selected surfaces, ends of a curve, or sides of a volume */
export type EdgeCommand = {
  do: 'edge';
  /** sides of the domain; or `"#456"`, an edge of a face, as by `edge` */
  which?: 'all' | 'u0' | 'u1' | 'v0' | 'v1' | 'w0' | 'w1' | `#${string}`;
  /** what of them stays as it is */
  hold?: 'position' | 'clamped' | 'curvature' | 'free' | 'follow' | 'open';
  /** `"#456"`: one edge of a face, as `knead info --faces` lists it, instead of `which` */
  edge?: string;
  /** the coordinates that this holds or frees, as `"xz"`; the others stay as they were */
  components?: string;
};

/** hold a region, rounded outward to whole knot spans */
export type FreezeCommand = {
  do: 'freeze';
  /** `[[s0, s1], [t0, t1]]` (fraction) */
  region: [[number, number], [number, number]];
};

/** hold a curve of the surface */
export type KeepCommand = {
  do: 'keep';
  /** the line u = const at this fraction of the domain, exactly (fraction) */
  u?: number;
  /** the line v = const (fraction) */
  v?: number;
  /** `[[s, t], …]`, a polyline in the domain, to the tolerance (fraction) */
  curve?: [number, number][];
  /** of a polyline: it moves by no more than this share of the motion around it */
  tolerance?: number;
};

/** keep a symmetry */
export type SymmetryCommand = {
  do: 'symmetry';
  /** stays in the plane, the surface perpendicular to it; this or `mirror` */
  edge?: 'all' | 'u0' | 'u1' | 'v0' | 'v1';
  /** the direction along which partners lie. An asymmetric net is refined where `refine` permits it; otherwise the error says which knots are missing */
  mirror?: 'u' | 'v';
  /** `[x, y, z]` of the plane (length) */
  point?: [number, number, number];
  /** `[x, y, z]` of the plane */
  normal?: [number, number, number];
};

/** keep smooth knot lines and poles smooth; on by default */
export type SmoothCommand = {
  do: 'smooth';
  /** no hinges at knots of full multiplicity (the quadrants of every CAD cylinder) */
  knot_lines?: boolean;
  /** edges collapsed to a point keep their tangent plane */
  poles?: boolean;
};

/** couple selected surfaces, and each with itself, along shared edges */
export type SeamsCommand = {
  do: 'seams';
  /** `false`: they may tear apart */
  couple?: boolean;
  /** how far apart the edges of a seam may be, a length (length) */
  tolerance?: number;
  /** seams that were smooth stay so even where the sides are in no fixed ratio, which leaves them less freedom */
  smooth?: boolean;
};

/** free what is held, pinned, frozen, kept or masked */
export type ReleaseCommand = {
  do: 'release';
  /** what of it */
  what?: ('hold' | 'pins' | 'edges' | 'freeze' | 'keep' | 'symmetry' | 'mask')[];
};

/** add a tool to the scene, or replace the one of that name */
export type ToolCommand = {
  do: 'tool';
  /** what `move` and `remove` call it */
  name?: string;
  /** its form */
  shape?: 'sphere' | 'ellipsoid' | 'box' | 'cylinder' | 'cone' | 'capsule' | 'torus' | 'plane' | 'bowl' | 'superellipsoid' | 'supertoroid' | 'surface' | 'wedge';
  /** of spheres, cylinders and the like; where a shape has `sizes`, all of them (length) */
  radius?: number;
  /** tube radius of torus and supertoroid (length) */
  minor?: number;
  /** of cylinder, cone, capsule (without its caps) and wedge (from its foot to its ridge) (length) */
  height?: number;
  /** of a cone (length) */
  top_radius?: number;
  /** wall of a bowl (length) */
  thickness?: number;
  /** radius of the edges of a box, or of the ridge of a wedge (length) */
  rounding?: number;
  /** `[a, b, c]`: semi-axes of (super)ellipsoids, half sides of a box (length) */
  sizes?: [number, number, number];
  /** `[e1, e2]` of superellipsoid and supertoroid */
  exponents?: [number, number];
  /** of shape `surface`: the id of the surface of the document that is the tool, as it is now */
  surface?: string;
  /** of a wedge: along the ridge (length) */
  length?: number;
  /** of a wedge: between the flanks, in degrees (degrees) */
  angle?: number;
  /** direction of its own z axis; or: */
  axis?: [number, number, number];
  /** its rotation, a quaternion `[x, y, z, w]` of any length */
  orientation?: [number, number, number, number];
  /** factors along its own axes */
  scale?: [number, number, number];
  /** `[x, y, z]` of the centre; this or `at` is needed (a `surface` stays in place without them) (length) */
  position?: [number, number, number];
  /** `[s, t]`: the centre on the surface as it is now; or `"middle"`, the visible point farthest from all edges (fraction) */
  at?: [number, number] | 'middle';
  /** `true` is the same as `"at": "middle"` */
  middle?: boolean;
  /** how it acts */
  mode?: 'collision' | 'proximity' | 'imprint';
  /** k */
  stiffness?: number;
  /** how far proximity reaches (length) */
  range?: number;
  /** of proximity */
  direction?: 'pull' | 'push';
  /** of surfaces that edges of faces bound */
  touches?: 'all' | 'visible';
  /** raise k until nothing enters by more than 1e-4 of the tool's size */
  rigid?: boolean;
  /** Coulomb's coefficient */
  friction?: number;
  /** share of the displacement that `remove` leaves in the rest shape (fraction) */
  plasticity?: number;
  /** lengths and position are fractions of the diagonal */
  relative?: boolean;
};

/** change fields of a tool; fields not given stay as they are */
export type EditToolCommand = {
  do: 'edit_tool';
  /** its name; or: */
  tool?: string;
  /** its name */
  name?: string;
  /** another shape: measures that both shapes have are kept, the others are those of a new tool */
  shape?: 'sphere' | 'ellipsoid' | 'box' | 'cylinder' | 'cone' | 'capsule' | 'torus' | 'plane' | 'bowl' | 'superellipsoid' | 'supertoroid' | 'surface' | 'wedge';
  /** of spheres, cylinders and the like; where a shape has `sizes`, all of them (length) */
  radius?: number;
  /** tube radius of torus and supertoroid (length) */
  minor?: number;
  /** of cylinder, cone, capsule (without its caps) and wedge (from its foot to its ridge) (length) */
  height?: number;
  /** of a cone (length) */
  top_radius?: number;
  /** wall of a bowl (length) */
  thickness?: number;
  /** radius of the edges of a box, or of the ridge of a wedge (length) */
  rounding?: number;
  /** `[a, b, c]`: semi-axes of (super)ellipsoids, half sides of a box (length) */
  sizes?: [number, number, number];
  /** `[e1, e2]` of superellipsoid and supertoroid */
  exponents?: [number, number];
  /** of shape `surface`: the id of the surface of the document that is the tool, as it is now */
  surface?: string;
  /** of a wedge: along the ridge (length) */
  length?: number;
  /** of a wedge: between the flanks, in degrees (degrees) */
  angle?: number;
  /** new direction of its own z axis, reached the shortest way, without twist about that axis; or: */
  axis?: [number, number, number];
  /** as for `tool` */
  orientation?: [number, number, number, number];
  /** as for `tool`; replaces the previous scale */
  scale?: [number, number, number];
  /** as for `tool` (length) */
  position?: [number, number, number];
  /** as for `tool` (fraction) */
  at?: [number, number] | 'middle';
  /** as for `tool` */
  middle?: boolean;
  /** how it acts; the stiffness does not change */
  mode?: 'collision' | 'proximity' | 'imprint';
  /** as for `tool` */
  stiffness?: number;
  /** as for `tool` (length) */
  range?: number;
  /** of proximity */
  direction?: 'pull' | 'push';
  /** as for `tool` */
  touches?: 'all' | 'visible';
  /** as for `tool` */
  rigid?: boolean;
  /** as for `tool` */
  friction?: number;
  /** as for `tool` (fraction) */
  plasticity?: number;
  /** lengths and position of this command are fractions of the diagonal */
  relative?: boolean;
};

/** remove a tool, force or measurement from the scene; a tool's plastic deformation remains */
export type RemoveCommand = {
  do: 'remove';
  /** its name */
  tool?: string;
  /** the name of a measurement, to remove that instead of a tool */
  measurement?: string;
};

/** move a tool */
export type MoveCommand = {
  do: 'move';
  /** its name */
  tool?: string;
  /** `[dx, dy, dz]` (length) */
  by: [number, number, number];
  /** `by` is in fractions of the diagonal */
  relative?: boolean;
};

/** turn a tool about its centre */
export type TurnCommand = {
  do: 'turn';
  /** its name */
  tool?: string;
  /** direction of the axis, in space */
  axis?: [number, number, number];
  /** in degrees, counterclockwise when the axis points at the viewer (degrees) */
  angle: number;
};

/** scale a tool along its own axes */
export type ScaleCommand = {
  do: 'scale';
  /** its name */
  tool?: string;
  /** `[a, b, c]`, factors */
  by: [number, number, number];
};

/** a force on one point or edge, until `remove` */
export type ForceCommand = {
  do: 'force';
  /** what `remove` calls it */
  name?: string;
  /** how it acts */
  kind?: 'spring' | 'volcano' | 'dead' | 'line' | 'moment';
  /** `[s, t]`: the surface point, of a curve `[s]`, of a volume `[s, t, r]`; of all kinds but line and moment (fraction) */
  at?: number[];
  /** `[x, y, z]`: of springs and volcanoes (length) */
  to?: [number, number, number];
  /** spring constant, or k of the volcano's k/r² */
  strength?: number;
  /** distance within which the force of a volcano no longer grows (length) */
  core?: number;
  /** `[x, y, z]`: of a dead force, or of a line force per length; lengths and forces are those of the model, in `scaling` raw those of the file */
  vector?: [number, number, number];
  /** of a line force or a moment */
  edge?: 'all' | 'u0' | 'u1' | 'v0' | 'v1';
  /** of shells: force times length per length, right-handed about the edge's direction */
  moment?: number;
};

/** loads everywhere on the selected surfaces; replaces earlier ones */
export type LoadCommand = {
  do: 'load';
  /** force per area */
  vector?: [number, number, number];
  /** which area that is, of samples and formulas too */
  per?: 'parameters' | 'area';
  /** acceleration; the force is mass times this */
  gravity?: [number, number, number];
  /** force per area along the normal S_u × S_v */
  pressure?: number;
  /** velocity of the air; the force is along the normal */
  wind?: [number, number, number];
  /** `[m, n]` samples of any load f(u, v) over the domain, its ends included */
  counts?: [number, number];
  /** m n forces `[x, y, z]` per area, along v first, linear in between; integrated exactly, per area of a bent surface to 1e-10 */
  samples?: [number, number, number][];
  /** a force per area: a formula for each of x, y, z, of what `material` names; as cubic splines, integrated likewise */
  formula?: [string, string, string];
  /** of these splines, in forces per area */
  tolerance?: number;
};

/** limit the displacement of every point from the surface as opened */
export type LimitCommand = {
  do: 'limit';
  /** a length (length) */
  distance?: number;
  /** `distance` is a fraction of the diagonal */
  relative?: boolean;
};

/** what steps do; static solves at once */
export type EvolveCommand = {
  do: 'evolve';
  /** what a step solves */
  mode?: 'acm' | 'static' | 'dynamic';
  /** acm: λ, inverse step size: small goes straight to equilibrium, large creeps. 0 requires that something is held */
  lambda?: number;
  /** dynamic: time per step */
  time_step?: number;
  /** acm: the weights of a step */
  weight?: 'mass' | 'identity';
  /** how tool forces are integrated */
  route?: 'gauss' | 'analytic';
  /** how exactly steps in contact are solved */
  accuracy?: 'exact' | 'interactive';
  /** how the systems of steps are solved */
  solver?: 'automatic' | 'direct' | 'iterative';
  /** rational shapes: the largest error of an entry of the energy's matrix, relative to its diagonal */
  energy_tolerance?: number;
};

/** let the selected surfaces evolve under the tools */
export type StepCommand = {
  do: 'step';
  /** number of steps */
  count?: number;
  /** for these steps only */
  lambda?: number;
  /** for these steps only */
  weight?: 'mass' | 'identity';
  /** what it does not stop or warn at */
  allow?: 'held' | 'through' | 'all' | 'nothing';
  /** of a shell: the load is applied in this many equal parts */
  increments?: number;
};

/** press a tool along a path and take it back, as one command */
export type StrokeCommand = {
  do: 'stroke';
  /** its name */
  tool?: string;
  /** `[[x, y, z], …]`, positions of its centre; empty to lift a tool that is down (length) */
  path: [number, number, number][];
  /** at each position, where the shape at the end stays */
  steps?: number;
  /** share of the displacement that becomes rest shape, of what the material lets stay (fraction) */
  plasticity?: number;
  /** when what the tool does becomes the shape */
  plastic?: 'material' | 'along' | 'release';
  /** the tool stays down, and the next stroke of it goes on with this one; any other command lifts it first */
  open?: boolean;
  /** the path is measured from where the tool is, in fractions of the diagonal */
  relative?: boolean;
  /** where it comes to another face */
  allow?: 'through' | 'nothing';
};

/** lead a brush over the surface */
export type BrushCommand = {
  do: 'brush';
  /** what it does */
  kind: 'push' | 'pull' | 'inflate' | 'flatten' | 'smooth' | 'pinch' | 'crease' | 'ridge' | 'grab' | 'twist' | 'scale' | 'mask' | 'unmask' | 'stamp';
  /** `[[s, t], …]`, points of the surface; empty to go on with an open stroke where it is (fraction) */
  path?: [number, number][];
  /** id of the surface of the path */
  surface?: string;
  /** ids of the surface of each point of a path that leads over several selected ones */
  surfaces?: string[];
  /** of a pen at each point of the path, linear in between; not of grab, twist and scale (fraction) */
  pressure?: number[];
  /** what `pressure` scales */
  presses?: 'depth' | 'size' | 'both' | 'none';
  /** `[[x, y, z], …]`: the direction of the pen at each point of the path, in which push, pull, crease, ridge, flatten, pinch and stamp act, up to 60° from the normal; `[0, 0, 0]` along it */
  tilt?: [number, number, number][];
  /** beyond which nothing moves, measured in space (length) */
  radius?: number;
  /** of push, pull, inflate, crease, ridge and stamp, at full weight; either sign (length) */
  height?: number;
  /** of flatten, smooth and pinch: the share of the way that points go at full weight; of mask and unmask: how much (fraction) */
  strength?: number;
  /** share of the radius with full weight; from there it falls off smoothly (fraction) */
  core?: number;
  /** of grab: `[dx, dy, dz]` (length) */
  by?: [number, number, number];
  /** of twist and stamp: counterclockwise about the normal (degrees) */
  angle?: number;
  /** of scale */
  factor?: number;
  /** of stamp: rows of heights over a square whose corners are on the radius, `1` for the whole `height`; the first row is the upper one, and columns go along the first parameter */
  pattern?: number[][];
  /** of stamp, in place of `pattern`: the shape of a tool as it is seen along its axis, as wide as the `core` */
  shape?: 'sphere' | 'ellipsoid' | 'box' | 'cylinder' | 'cone' | 'capsule' | 'torus' | 'plane' | 'bowl' | 'superellipsoid' | 'supertoroid' | 'surface' | 'wedge';
  /** the brush is drawn along the path by a rope of so many radii, which takes out what trembles */
  steady?: number;
  /** `[[x, y, z], [nx, ny, nz]]`: point and normal of a plane in which the stroke is repeated */
  mirror?: [[number, number, number], [number, number, number]];
  /** `[[x, y, z], [dx, dy, dz]]`: point and direction of the axis of `radial` */
  axis?: [[number, number, number], [number, number, number]];
  /** strokes around the axis, this one among them */
  radial?: number;
  /** the next `brush` with the same settings goes on with this stroke; any other command ends it */
  open?: boolean;
  /** `radius`, `height` and `by` are fractions of the diagonal */
  relative?: boolean;
  /** where it comes to another face */
  allow?: 'through' | 'nothing';
};

/** change the mask of the selected surfaces, which `brush` paints, as a whole */
export type MaskCommand = {
  do: 'mask';
  /** how */
  change: 'clear' | 'fill' | 'invert' | 'blur' | 'grow' | 'shrink';
  /** of blur, grow and shrink, measured in space (length) */
  radius?: number;
  /** `radius` is a fraction of the diagonal */
  relative?: boolean;
};

/** grip a surface point, drag it and let it go, as one command */
export type DragCommand = {
  do: 'drag';
  /** `[s, t]`: the point; or `"middle"`, the visible point farthest from all edges (fraction) */
  at?: [number, number] | 'middle';
  /** `[dx, dy, dz]` (length) */
  by: [number, number, number];
  /** of the footprint, a length (length) */
  radius?: number;
  /** spring constant of the grip */
  strength?: number;
  /** number of steps along the way */
  steps?: number;
  /** share of the displacement that becomes rest shape (fraction) */
  plasticity?: number;
  /** `by` and `radius` are fractions of the diagonal */
  relative?: boolean;
  /** id of the surface of the point */
  surface?: string;
  /** `true` is the same as `"at": "middle"` */
  middle?: boolean;
  /** where it comes to another face */
  allow?: 'through' | 'nothing';
};

/** smooth the surface around a point */
export type RelaxCommand = {
  do: 'relax';
  /** `[s, t]`: the point (fraction) */
  at: [number, number];
  /** how far it reaches, a length (length) */
  radius?: number;
  /** about the share removed of a bump (1 − ρ²/r²)² on a sheet: λ = 40 (1 − strength) / (3 r² strength); smaller bumps lose more */
  strength?: number;
  /** id of the surface of the point */
  surface?: string;
  /** `radius` is a fraction of the diagonal */
  relative?: boolean;
  /** where it comes to another face */
  allow?: 'through' | 'nothing';
};

/** deform the surfaces with an elastic block of space that the tools act on */
export type LatticeCommand = {
  do: 'lattice';
  /** control points of the block along x, y, z */
  net?: [number, number, number];
  /** along x, y, z */
  degree?: [number, number, number];
  /** how far the block reaches beyond the control points, as a share of their diagonal (fraction) */
  margin?: number;
  /** number of steps */
  steps?: number;
  /** inverse step size */
  lambda?: number;
  /** faces of the block that stay */
  hold?: ('u0' | 'u1' | 'v0' | 'v1' | 'w0' | 'w1')[];
  /** control points of the block that are moved by hand; that of indices i, j, k along x, y, z is `(i · net[1] + j) · net[2] + k` */
  which?: number[];
  /** how far these are moved; tools do not act then (length) */
  by?: [number, number, number];
  /** go on with the block of the `lattice` before: its control points are moved from where they were pulled, and deform the shapes that it was put round. Net, degree, margin and selection are the same, and nothing else has changed the surfaces since */
  again?: boolean;
  /** where it comes to another face */
  allow?: 'through' | 'nothing';
};

/** move control points of the selected surface by hand, permanently */
export type PointsCommand = {
  do: 'points';
  /** numbers i n + j of control points of the net m × n, from 0; one of these three, or several */
  which?: number[];
  /** `[i, …]`: all control points (i, ·) */
  rows_u?: number[];
  /** `[j, …]`: all control points (·, j) */
  rows_v?: number[];
  /** `[dx, dy, dz]` for all of them; this or `to` (length) */
  by?: [number, number, number];
  /** `[[x, y, z], …]`: a place for each, in the order in which they are named, each counted once (length) */
  to?: [number, number, number][];
  /** `by` is in fractions of the diagonal */
  relative?: boolean;
  /** where it comes to another face */
  allow?: 'through' | 'nothing';
};

/** set weights: control points stay, the shape changes permanently */
export type WeightsCommand = {
  do: 'weights';
  /** numbers i n + j of control points of the net m × n, from 0; one of these three, or several */
  which?: number[];
  /** `[i, …]`: all control points (i, ·) */
  rows_u?: number[];
  /** `[j, …]`: all control points (·, j) */
  rows_v?: number[];
  /** weight of each; 1 unless set before; this or `by` */
  weight?: number;
  /** a factor by which each weight is multiplied */
  by?: number;
};

/** set knots for the same control points: the shape changes permanently */
export type KnotsCommand = {
  do: 'knots';
  /** whose */
  direction: 'u' | 'v';
  /** the whole knot vector, of the same length, with multiplicities up to the degree inside the domain, which does not change: trims and painted materials refer to it */
  knots: number[];
};

/** refine the net without changing the shape */
export type RefineCommand = {
  do: 'refine';
  /** `[[s0, s1], [t0, t1]]`: halves the spans there (fraction) */
  region?: [[number, number], [number, number]];
  /** name of a tool: halves the spans that it reaches */
  under?: string;
  /** knots to insert in u, as parameters of the file */
  knots_u?: number[];
  /** knots to insert in v */
  knots_v?: number[];
  /** what steps may refine from here on */
  permission?: 'auto' | 'never' | 'trims';
};

/** raise the degree without changing the shape */
export type ElevateCommand = {
  do: 'elevate';
  /** in u and in v */
  by?: [number, number];
};

/** remove knots where the shape changes by no more than a tolerance */
export type CoarsenCommand = {
  do: 'coarsen';
  /** a length (length) */
  tolerance: number;
};

/** report the final position of a surface point */
export type MeasureCommand = {
  do: 'measure';
  /** what the report calls it */
  name?: string;
  /** its id */
  surface?: string;
  /** `[s, t]`: a point of the surface; or `"middle"`, the visible point farthest from all edges (fraction) */
  at?: [number, number] | 'middle';
  /** `true` is the same as `"at": "middle"` */
  middle?: boolean;
};

/** report the lowest natural frequencies about the present state */
export type ModesCommand = {
  do: 'modes';
  /** number of modes; rigid ones count too */
  count?: number;
};

/** report the factors of the present loads at which a shell buckles */
export type BucklingCommand = {
  do: 'buckling';
  /** number of factors, the lowest first */
  count?: number;
};

/** undo the last command */
export type UndoCommand = {
  do: 'undo';
};

/** redo the command undone last */
export type RedoCommand = {
  do: 'redo';
};

export type AnyCommand =
  | NewCommand
  | SelectCommand
  | ConvertCommand
  | MaterialCommand
  | RestCommand
  | ScalingCommand
  | HoldCommand
  | PinCommand
  | EdgeCommand
  | FreezeCommand
  | KeepCommand
  | SymmetryCommand
  | SmoothCommand
  | SeamsCommand
  | ReleaseCommand
  | ToolCommand
  | EditToolCommand
  | RemoveCommand
  | MoveCommand
  | TurnCommand
  | ScaleCommand
  | ForceCommand
  | LoadCommand
  | LimitCommand
  | EvolveCommand
  | StepCommand
  | StrokeCommand
  | BrushCommand
  | MaskCommand
  | DragCommand
  | RelaxCommand
  | LatticeCommand
  | PointsCommand
  | WeightsCommand
  | KnotsCommand
  | RefineCommand
  | ElevateCommand
  | CoarsenCommand
  | MeasureCommand
  | ModesCommand
  | BucklingCommand
  | UndoCommand
  | RedoCommand;

/** The material of a shell, in units of the file. */
export type ShellInfo = {
  /** its mean where it varies */
  young: number;
  poisson: number;
  /** its mean where it varies (length) */
  thickness: number;
  density: number;
};

/** The weights of the fundamental forms, in the order 11, 12, 22. */
export type FundamentalInfo = {
  w1: [number, number, number];
  w2: [number, number, number];
};

/** A surface of the session. */
export type SurfaceInfo = {
  id: string;
  name: string;
  /** of all lengths */
  unit: string;
  degree: [number, number];
  /** control points [m, n]; (i, j) is number i n + j */
  net: [number, number];
  rational: boolean;
  /** corner of the control points' bounding box (length) */
  lower: [number, number, number];
  /** the opposite corner (length) */
  upper: [number, number, number];
  /** coefficients 11, 12, 22; null where one varies over the surface */
  alpha: [number | null, number | null, number | null];
  /** likewise */
  beta: [number | null, number | null, number | null];
  /** of bending; that of a shell stands with it */
  poisson: number;
  /** null where it varies */
  mass: number | null;
  /** null where it varies */
  damping: number | null;
  /** its named material, if it has one */
  preset: 'clay' | 'wax' | 'rubber' | 'sheet metal' | 'cloth' | 'membrane' | null;
  /** null where the model is another one */
  shell: ShellInfo | null;
  /** likewise */
  fundamental: FundamentalInfo | null;
  /** share of a displacement that strokes leave */
  plasticity: number;
  /** up to this displacement they leave nothing */
  yield: number;
  /** how far a dent is felt */
  locality: number;
  /** what `yield` and `locality` count */
  lengths: 'radii' | 'file';
  rest: 'shape' | 'none';
  /** of the file that lie on it */
  faces: number;
  /** whether it is of the file and no face lies on it: its sides are held as edges are */
  bare: boolean;
  /** outer rows of control points that do not move */
  hold: number;
  /** number of pinned control points */
  pins: number;
  /** the pinned control points [i, j] */
  pinned: [number, number][];
  /** whether any of it is masked */
  masked: boolean;
  /** the commands that restate what holds it */
  constraints: AnyCommand[];
  /** number of control points that are not as opened */
  moved: number;
};

/** A curve or a volume of the session. */
export type BodyInfo = {
  id: string;
  name: string;
  /** of all lengths */
  unit: string;
  kind: 'curve' | 'volume';
  /** in each direction */
  degree: number[];
  /** control points in each direction; the last one is fastest */
  net: number[];
  rational: boolean;
  /** corner of the control points' bounding box (length) */
  lower: [number, number, number];
  /** the opposite corner (length) */
  upper: [number, number, number];
  /** coefficients 11 of a curve, 11, 12, 13, 22, 23, 33 of a volume */
  alpha: number[];
  /** likewise */
  beta: number[];
  mass: number;
  damping: number;
  /** weight of the metric; null where the model is linear */
  w1: number | null;
  /** weight of a curve's curvature */
  w2: number | null;
  /** outer layers of control points that do not move */
  hold: number;
  /** numbers of pinned control points */
  pins: number[];
  /** which of them are held: `u0`, `u1` of a curve, to `w1` of a volume */
  sides: string[];
  /** how many sides and points are held besides */
  holds: number;
  /** number of control points that are not as they were made */
  moved: number;
  /** the largest (length) */
  displacement: number;
};

/** A tool of the session: its shape's fields, how it acts and where it is. */
export type ToolInfo = {
  shape: 'sphere' | 'ellipsoid' | 'box' | 'cylinder' | 'cone' | 'capsule' | 'torus' | 'plane' | 'bowl' | 'superellipsoid' | 'supertoroid' | 'surface' | 'wedge';
  radius?: number;
  sizes?: [number, number, number];
  rounding?: number;
  height?: number;
  top_radius?: number;
  minor?: number | [number, number];
  thickness?: number;
  exponents?: [number, number];
  length?: number;
  angle?: number;
  name: string;
  mode: 'collision' | 'proximity' | 'imprint';
  stiffness: number;
  /** (length) */
  range: number;
  rigid: boolean;
  friction: number;
  /** (fraction) */
  plasticity: number;
  direction: 'pull' | 'push';
  /** of the centre (length) */
  position: [number, number, number];
  /** a quaternion x, y, z, w */
  rotation: [number, number, number, number];
  /** along its own axes */
  scale: [number, number, number];
  /** its smallest feature; null where it has none (length) */
  size: number | null;
};

/** loads everywhere on the selected surfaces; replaces earlier ones */
export type LoadInfo = {
  do: 'load';
  /** force per area */
  vector: [number, number, number];
  /** which area that is, of samples and formulas too */
  per?: 'parameters' | 'area';
  /** acceleration; the force is mass times this */
  gravity: [number, number, number];
  /** force per area along the normal S_u × S_v */
  pressure: number;
  /** velocity of the air; the force is along the normal */
  wind: [number, number, number];
  /** `[m, n]` samples of any load f(u, v) over the domain, its ends included */
  counts: [number, number];
  /** m n forces `[x, y, z]` per area, along v first, linear in between; integrated exactly, per area of a bent surface to 1e-10 */
  samples: [number, number, number][];
  /** a force per area: a formula for each of x, y, z, of what `material` names; as cubic splines, integrated likewise */
  formula?: [string, string, string];
  /** of these splines, in forces per area */
  tolerance?: number;
};

/** what steps do; static solves at once */
export type EvolveInfo = {
  do: 'evolve';
  /** what a step solves */
  mode: 'acm' | 'static' | 'dynamic';
  /** acm: λ, inverse step size: small goes straight to equilibrium, large creeps. 0 requires that something is held */
  lambda: number;
  /** dynamic: time per step */
  time_step: number;
  /** acm: the weights of a step */
  weight: 'mass' | 'identity';
  /** how tool forces are integrated */
  route: 'gauss' | 'analytic';
  /** how exactly steps in contact are solved */
  accuracy: 'exact' | 'interactive';
  /** how the systems of steps are solved */
  solver: 'automatic' | 'direct' | 'iterative';
  /** rational shapes: the largest error of an entry of the energy's matrix, relative to its diagonal */
  energy_tolerance: number;
};

export type SeamInfo = {
  continuity: 'none' | 'C0' | 'G1' | 'periodic';
  /** (length) */
  gap: number;
  /** why the continuity is not higher */
  reason: string;
};

/** What is measured at a point of a surface. */
export type ReadingInfo = {
  name: string;
  /** its number; -1 of a face on no surface of the session */
  surface: number;
  /** (fraction) */
  at: [number, number];
  /** (length) */
  point: [number, number, number];
  /** from the surface as opened (length) */
  displacement: [number, number, number];
  /** of length 1; zero where there is none */
  normal: [number, number, number];
  /** the principal ones, the larger first; null where there is no normal */
  curvature: [number, number] | null;
  /** of shells: on the face that the normal leaves, and on the other */
  von_mises?: [number, number];
  /** of shells: principal forces per length, the larger first */
  membrane?: [number, number];
  /** of shells: principal bending moments per length */
  moment?: [number, number];
  /** of shells: the largest strain that bending adds */
  bending_strain?: number;
};

/** What a code says it about; null what it does not name. */
export type DiagnosticValues = {
  /** its id */
  surface: string | null;
  /** all that are concerned */
  surfaces: string[];
  /** those of them that would have to be converted */
  others: string[];
  /** id of a curve or a volume */
  body: string | null;
  /** id of an edge of faces */
  edge: string | null;
  /** all that are concerned */
  edges: string[];
  /** its id */
  face: string | null;
  /** those at the edge */
  faces: string[];
  /** of the surface that is no B-spline surface, as in the file */
  form: string | null;
  /** its name */
  tool: string | null;
  /** what the edge could do instead: follow, or free */
  hold: string | null;
  /** to refine: trims, or never */
  permission: string | null;
  /** outer rows of control points */
  rows: number | null;
  /** number of a control point */
  point: number | null;
  /** (length) */
  distance: number | null;
  /** (length) */
  limit: number | null;
  /** (degrees) */
  angle: number | null;
  /** of the tool (length) */
  size: number | null;
  /** of the model */
  sizes: number | null;
  /** (length) */
  depth: number | null;
  /** of a place (length) */
  x: number | null;
  /** (length) */
  y: number | null;
  /** (length) */
  z: number | null;
  /** side of a seam */
  first: string | null;
  /** its other side */
  second: string | null;
  /** what a surface comes to, in words */
  other: string | null;
  /** in words */
  reason: string | null;
};

/** Commands that help, one after the other. */
export type FixInfo = {
  code: 'hold_edges' | 'hold_rows' | 'hold_nothing' | 'release_all' | 'release_pins' | 'thaw' | 'refine' | 'permit_refining' | 'keep_net' | 'let_follow' | 'let_go' | 'let_open' | 'let_part' | 'convert_and_follow' | 'select_and_follow' | 'select' | 'convert' | 'end_limit' | 'normalise' | 'set_rest_shape' | 'keep_smooth';
  commands: AnyCommand[];
};

/** What a command did besides what it was asked for. */
export type NoteInfo = {
  /** for people */
  text: string;
  code: 'none' | 'nothing_held' | 'nothing_free' | 'nothing_free_in_rows' | 'nothing_free_at_edges' | 'nothing_free_at_brush' | 'point_frozen' | 'region_frozen' | 'pins_by_number' | 'constraint_contradicts' | 'step_folds' | 'step_folds_beside_edge' | 'step_runs_away' | 'step_not_finite' | 'tool_too_small' | 'brush_too_small' | 'net_too_large' | 'edge_face_not_spline' | 'edge_face_not_selected' | 'edge_would_open' | 'edge_would_turn' | 'edge_would_part' | 'edge_left_open' | 'seam_would_open' | 'edges_unknown' | 'beyond_limit' | 'limit_keeps_basis' | 'limit_needs_opened_basis' | 'scaling_is_raw' | 'shell_needed' | 'rest_shape_needed' | 'no_surface' | 'no_body' | 'no_spline_surface' | 'none_selected' | 'several_selected' | 'not_a_spline' | 'seam_creased' | 'surface_loose' | 'stopped_at_face' | 'through_face' | 'out_of_range';
  /** null without a code */
  values: DiagnosticValues | null;
  fixes: FixInfo[];
};

/** What one step did. */
export type StepInfo = {
  /** number of the first one selected; -1: of a body */
  surface: number;
  /** seconds */
  time: number;
  /** stretch + bend, in normalised units */
  energy: number;
  /** relative imbalance of forces */
  residual: number;
  /** from the surface as opened (length) */
  largest_displacement: number;
  stretch: number;
  bend: number;
  kinetic: number;
  contact: number;
  /** deepest entry into a tool, in sizes of that tool */
  gap: number;
  /** (length) */
  constraint_violation: number;
  converged: boolean;
  /** the limit restricts the displacement */
  limited: boolean;
  /** of a shell: the share of the load that is balanced */
  load_factor?: number;
  /** of a shell: Newton iterations of each part of the load */
  increments?: number[];
  /** of rational shapes: the largest error of an entry of the energy's matrix, relative to its diagonal */
  energy_error?: number;
  /** what went wrong, and the remedy */
  note?: string;
  iterations: number;
};

/** A free vibration of the structure. */
export type VibrationInfo = {
  /** per unit of time; below 0 the structure is unstable */
  frequency: number;
  /** relative */
  residual: number;
};

/** A load at which a shell buckles. */
export type BucklingInfo = {
  /** by which the present loads are multiplied */
  load_factor: number;
  /** relative */
  residual: number;
};

/** The session as it is reported. */
export type SessionInfo = {
  /** of the document */
  name: string;
  /** it began without a file */
  fresh: boolean;
  /** numbers of the selected surfaces, the first one first */
  selection: number[];
  surfaces: SurfaceInfo[];
  /** curves and volumes */
  bodies: BodyInfo[];
  /** the number of the selected one, if no surface is selected */
  body: number | null;
  tools: ToolInfo[];
  forces: AnyCommand[];
  load: LoadInfo;
  evolve: EvolveInfo;
  /** (length) */
  limit: number | null;
  /** the scaling is that of the equations */
  raw: boolean;
  /** along seams */
  coupled: boolean;
  /** seams, even where their sides are in no fixed ratio */
  smooth: boolean;
  refine: 'auto' | 'never' | 'trims';
  seams: SeamInfo[];
  /** of the points that `measure` names */
  readings: ReadingInfo[];
  notes: NoteInfo[];
  /** their number */
  steps: number;
  /** the last step */
  last: StepInfo | null;
  /** that the last command `modes` found, the lowest first */
  modes: VibrationInfo[];
  /** likewise of `buckling` */
  buckling: BucklingInfo[];
  undo: boolean;
  redo: boolean;
};

/** What went wrong, where, and what would be right. */
export type EngineErrorInfo = {
  /** usage, input or numerical */
  kind: string;
  what: string;
  where: string;
  /** `where`, unless that names a field of a command and what is wrong with it is stated without it */
  place: string;
  remedy: string;
  /** all of it as one line */
  message: string;
  code: 'none' | 'nothing_held' | 'nothing_free' | 'nothing_free_in_rows' | 'nothing_free_at_edges' | 'nothing_free_at_brush' | 'point_frozen' | 'region_frozen' | 'pins_by_number' | 'constraint_contradicts' | 'step_folds' | 'step_folds_beside_edge' | 'step_runs_away' | 'step_not_finite' | 'tool_too_small' | 'brush_too_small' | 'net_too_large' | 'edge_face_not_spline' | 'edge_face_not_selected' | 'edge_would_open' | 'edge_would_turn' | 'edge_would_part' | 'edge_left_open' | 'seam_would_open' | 'edges_unknown' | 'beyond_limit' | 'limit_keeps_basis' | 'limit_needs_opened_basis' | 'scaling_is_raw' | 'shell_needed' | 'rest_shape_needed' | 'no_surface' | 'no_body' | 'no_spline_surface' | 'none_selected' | 'several_selected' | 'not_a_spline' | 'seam_creased' | 'surface_loose' | 'stopped_at_face' | 'through_face' | 'out_of_range';
  /** null without a code */
  values: DiagnosticValues | null;
  /** what can be done at once */
  fixes: FixInfo[];
};

/** Begins a session on a file. */
export type OpenRequest = {
  /** its bytes */
  file: Uint8Array;
  /** of the file */
  name: string;
};

/** Begins a session without a file. */
export type FreshRequest = {
  /** of the document */
  name: string;
};

/** Goes on with the session of a snapshot, with undo and redo; nothing is computed. */
export type RestoreRequest = {
  /** the file that it began with; of no bytes: without one */
  source?: Uint8Array;
  /** of the query of that name */
  snapshot: Uint8Array;
  /** of the document */
  name: string;
};

/** All of the session as bytes. */
export type SnapshotRequest = {
  /** of memory that states take, as far as which the history goes back */
  history_bytes: number;
};

/** The file as it is now. */
export type SaveRequest = {
};

/** An edge of a face. */
export type EdgeInfo = {
  id: string;
  /** that meet there */
  faces: string[];
  /** of the surface from its original position, the largest along the edge (length) */
  deviation: number;
};

/** The edges of the faces on a surface that has moved. */
export type EdgesInfo = {
  /** its id */
  surface: string;
  /** within which faces meet, according to the file (length) */
  tolerance: number;
  edges: EdgeInfo[];
  /** why they cannot be followed */
  unknown: string;
};

/** The document as a file. */
export type SavedFile = {
  file: Uint8Array;
  /** of the faces on every surface that has moved */
  edges: EdgesInfo[];
};

/** A file of triangles: the faces of the file as it would be saved, or else all surfaces, whole. */
export type MeshRequest = {
  /** the id of one for triangles */
  format: string;
  /** grid lines wanted per direction */
  detail?: number;
};

/** Carries out commands as one act: all or none. */
export type ActRequest = {
  /** one after the other */
  commands: AnyCommand[];
  /** it belongs to the entry of the history before it */
  join?: boolean;
  /** it is an entry even if it changes nothing */
  keep?: boolean;
};

/** The last entry of the history goes if it is steps and settings that have changed nothing. */
export type DropUnchangedRequest = {
};

/** What stands belongs to the document: undo ends there. The answer is how many commands of the journal that are. */
export type BeginHistoryRequest = {
  /** what stood after so many commands of the journal instead of now */
  commands?: number;
};

/** Carries out commands and leaves the session as it is; what was made for them is kept, so that they take less time later. */
export type RehearseRequest = {
  /** one after the other */
  commands: AnyCommand[];
};

/** The list of all commands in effect as JSON, one per line. */
export type JournalRequest = {
};

/** A script that does what the journal did. */
export type ScriptRequest = {
};

/** The commands that precede those of every script. */
export type ScriptOpeningRequest = {
};

/** The session as panels show it. */
export type StateRequest = {
};

/** What steps did. */
export type StepsRequest = {
  /** the number of the first of them */
  first?: number;
};

/** How the faces on a surface meet their neighbours. */
export type CheckedEdgesRequest = {
  /** its number */
  surface: number;
};

/** How the faces at an edge meet; the largest values along it. */
export type CheckedEdgeInfo = {
  id: string;
  /** that meet there */
  faces: string[];
  /** between them; of one face alone from the edge's curve (length) */
  gap: number;
  /** as it was opened (length) */
  opened_gap: number;
  /** between their normals, degrees; null where there is one face */
  angle: number | null;
  /** as it was opened */
  opened_angle: number | null;
  /** by which they differ where they are tangent, per length; null where they are not */
  curvature: number | null;
  /** as it was opened */
  opened_curvature: number | null;
  /** why nothing is known of it */
  unknown: string;
};

/** How far the visible middle of a surface is from the nearest edge of a face, in units of the file; null where no edges are known. */
export type RoomRequest = {
  /** its number */
  surface: number;
};

/** What is measured at a point of a surface. */
export type ReadingRequest = {
  /** its number */
  surface: number;
  /** s and t (fraction) */
  at: [number, number];
};

/** The same on a face that lies on no surface of the session. */
export type FaceReadingRequest = {
  /** its id */
  face: string;
  /** it is measured at the nearest point */
  near: [number, number, number];
};

/** What is looked at from nearby: a part of a surface. */
export type PictureWindow = {
  /** fractions of the domain */
  lower: [number, number];
  upper: [number, number];
  /** how far chords may be from the surface there, in units of the file */
  tolerance: number;
};

/** A surface to draw. */
export type PictureRequest = {
  /** its number */
  surface: number;
  /** grid lines wanted per direction */
  detail?: number;
  /** what colours it, by its name */
  display?: string;
  /** of the display */
  settings?: Record<string, number | number[]>;
  /** as it was opened */
  opened?: boolean;
  /** where there are more grid lines */
  window?: PictureWindow;
};

/** A surface to draw, as a grid of points: (k, l) is number k counts[1] + l. */
export type Picture = {
  /** its number */
  surface: number;
  window: PictureWindow | null;
  counts: [number, number];
  /** relative to the session's origin */
  positions: Float32Array;
  normals: Float32Array;
  /** of the display; empty without one */
  values: Float32Array;
  /** fractions of the domain, per grid line */
  s: Float32Array;
  t: Float32Array;
  /** grid lines that are knot lines */
  lines_u: Uint32Array;
  lines_v: Uint32Array;
  /** grid lines that are there without a window; empty: all */
  coarse_u: Uint32Array;
  coarse_v: Uint32Array;
  /** control points */
  net: Float32Array;
  /** per control point: 0 free, 1 does not move, 2 bound to others (pinned surface points, kept curves) */
  held: Uint8Array;
};

/** Where the colours end of the pictures made since that of the first surface; null without any. */
export type RangeRequest = {
};

/** Where colours end by themselves, and the least and greatest of all visible values. */
export type DisplayRange = {
  lower: number;
  upper: number;
  least: number;
  greatest: number;
};

/** What positions of pictures are relative to, in units of the file. */
export type OriginRequest = {
};

/** All that can colour surfaces. */
export type DisplaysRequest = {
};

/** A number, or a vector, of a display. */
export type DisplaySetting = {
  name: string;
  title: string;
  unit: string;
  /** the default */
  value: number | number[];
  help: string;
};

/** What can colour surfaces. */
export type DisplayInfo = {
  name: string;
  title: string;
  /** with length for the unit of the file */
  unit: string;
  /** values may be negative */
  signed: boolean;
  palette: 'diverging' | 'rising';
  help: string;
  /** the values at the ends of the palette; null: those of the range */
  limits: [number, number] | null;
  /** the setting up to whose magnitude values have the neutral colour; empty for none */
  tolerance: string;
  /** with the shape as it was opened */
  compares: boolean;
  /** looks at the whole model from every point, which takes longer than a frame may */
  sees_model: boolean;
  settings: DisplaySetting[];
};

/** The shape of a tool. */
export type ToolPictureRequest = {
  /** its number */
  tool: number;
};

/** The shape of a tool as triangles in its own frame, unscaled. */
export type ToolPicture = {
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
  /** both sides are visible */
  open: boolean;
  /** a square of side 1 stands for a whole plane */
  unbounded: boolean;
};

/** Curvature combs of a surface along parameter lines. */
export type CombsRequest = {
  /** its number */
  surface: number;
  /** on how many u runs and on how many v does */
  curves: [number, number];
  /** pieces of every knot span */
  teeth: number;
};

/** Curvature combs of a surface, those teeth that are visible. */
export type Combs = {
  /** relative to the session's origin */
  places: Float32Array;
  /** towards the centre of curvature, 1/length */
  vectors: Float32Array;
  /** per tooth: 1 if it continues the comb of the tooth before it */
  joined: Uint8Array;
  /** curvature of any visible tooth, 1/length */
  largest: number;
  /** where that is, relative to the origin */
  at: [number, number, number];
};

/** Those of the curves in which a plane cuts a surface. */
export type SectionCombsRequest = {
  /** its number */
  surface: number;
  /** points p of the file with (x, y, z) · p = offset; (x, y, z) is of length 1 */
  plane: [number, number, number, number];
};

/** A curve or a volume to draw: 24 chords per span of a curve, 6 of a volume's knot lines, of which at most 12 per direction are drawn. */
export type BodyPictureRequest = {
  /** its number */
  body: number;
};

/** A curve or a volume to draw, relative to the session's origin. */
export type BodyPicture = {
  /** ends of chords: of a curve, or of knot lines on the sides of a volume */
  lines: Float32Array;
  /** three fractions of the domain for each end */
  at: Float32Array;
  /** ends of the legs of the control polygon */
  net: Float32Array;
  /** the control points */
  points: Float32Array;
  /** of a lattice: it has been pulled, and another pull goes on there */
  pulled: boolean;
};

/** The block that the next command `lattice` by hand moves: as it was pulled, if that goes on, or round the selected surfaces. */
export type LatticePictureRequest = {
  /** control points along x, y, z */
  net: [number, number, number];
  /** around the surfaces */
  margin: number;
  /** round the surfaces as they are, whether or not one was pulled */
  anew?: boolean;
};

/** All numbers of a surface as it is now; each reads back as the same bits. */
export type SurfaceRequest = {
  /** its number */
  surface: number;
};

/** A surface; control point (i, j) is number i net[1] + j. */
export type SurfaceNumbers = {
  degree: [number, number];
  net: [number, number];
  knots_u: Float64Array;
  knots_v: Float64Array;
  /** none where all are 1 */
  weights: Float64Array;
  /** three numbers each */
  points: Float64Array;
};

/** The control points of a surface, three numbers each. */
export type ControlPointsRequest = {
  /** its number */
  surface: number;
};

/** The material of a surface as it is now. */
export type MaterialRequest = {
  /** its number */
  surface: number;
  /** samples in each direction, 2 to 1000, with the ends of the domain */
  counts: [number, number];
};

/** A material by samples over the domain: (i, j) is sample i counts[1] + j, at fractions i / (counts[0] - 1), j / (counts[1] - 1). */
export type MaterialSamples = {
  counts: [number, number];
  alpha11: Float64Array;
  alpha12: Float64Array;
  alpha22: Float64Array;
  beta11: Float64Array;
  beta12: Float64Array;
  beta22: Float64Array;
};

/** The faces of the file that are no surfaces of the session; null without a file of faces. */
export type ContextRequest = {
};

/** A face of the file that is no surface of the session. */
export type GreyFace = {
  id: string;
  /** the entity on which it lies; empty where there is none */
  surface: string;
  /** PLANE and the like; TRIANGLES of faces that the file itself tessellates */
  form: string;
  /** their number */
  triangles: number;
};

/** A face that could not be triangulated, and why. */
export type NotDrawn = {
  id: string;
  reason: string;
};

/** The surroundings of the surfaces: triangles of the other faces of the file. */
export type Context = {
  /** relative to the session's origin */
  positions: Float32Array;
  normals: Float32Array;
  /** 3 per triangle, face after face */
  indices: Uint32Array;
  /** in the order of the triangles */
  faces: GreyFace[];
  skipped: NotDrawn[];
  /** what of the file is not drawn, one line for each kind and reason; skipped faces are among it */
  left_out: string[];
};

/** What the faces of the file show of a surface; null where that is all. */
export type TrimsRequest = {
  /** its number */
  surface: number;
};

/** The loops of each face on a surface: the parts enclosed by an odd number of them are visible. */
export type Trims = {
  /** fractions s and t of the domain in turn */
  faces: number[][][];
};

/** The edges of the faces of the file on a surface; none where they cannot be followed. */
export type FaceEdgesRequest = {
  /** its number */
  surface: number;
};

/** A face at an edge. */
export type Neighbour = {
  face: string;
  /** the entity on which it lies */
  surface: string;
  /** PLANE and the like */
  form: string;
};

/** An edge of a face. */
export type FaceEdge = {
  id: string;
  /** places along it, s and t in turn; on closed surfaces they may lie outside of 0 … 1 */
  course: number[];
  meets: Neighbour[];
  /** the same face is on both of its sides */
  seam: boolean;
};

/** The parts of the file and where they stand; null without assemblies. */
export type AssemblyRequest = {
};

/** One place where an assembly puts a part. */
export type PartPlace = {
  /** products from the model down: engine/valve/spring */
  path: string;
  /** from the part's coordinates to the model's: three rows of four */
  matrix: number[];
};

/** Geometry with coordinates of its own. */
export type Part = {
  name: string;
  unit: string;
  /** ids of its surfaces, those of grey faces too */
  surfaces: string[];
  /** ids */
  faces: string[];
  /** ids of those that stand for themselves */
  curves: string[];
  /** at least one */
  places: PartPlace[];
};

/** The parts of a file, and where they stand. */
export type Assembly = {
  unit: string;
  parts: Part[];
  /** what could not be followed */
  warnings: string[];
};

/** What the page can ask the engine for. */
export interface Queries {
  open: { request: OpenRequest; answer: SessionInfo };
  fresh: { request: FreshRequest; answer: SessionInfo };
  restore: { request: RestoreRequest; answer: null };
  snapshot: { request: SnapshotRequest; answer: Uint8Array };
  save: { request: SaveRequest; answer: SavedFile };
  mesh: { request: MeshRequest; answer: Uint8Array };
  act: { request: ActRequest; answer: null };
  drop_unchanged: { request: DropUnchangedRequest; answer: null };
  begin_history: { request: BeginHistoryRequest; answer: number };
  rehearse: { request: RehearseRequest; answer: null };
  journal: { request: JournalRequest; answer: string };
  script: { request: ScriptRequest; answer: string };
  script_opening: { request: ScriptOpeningRequest; answer: AnyCommand[] };
  state: { request: StateRequest; answer: SessionInfo };
  steps: { request: StepsRequest; answer: StepInfo[] };
  checked_edges: { request: CheckedEdgesRequest; answer: CheckedEdgeInfo[] };
  room: { request: RoomRequest; answer: number | null };
  reading: { request: ReadingRequest; answer: ReadingInfo };
  face_reading: { request: FaceReadingRequest; answer: ReadingInfo };
  picture: { request: PictureRequest; answer: Picture };
  range: { request: RangeRequest; answer: DisplayRange | null };
  origin: { request: OriginRequest; answer: [number, number, number] };
  displays: { request: DisplaysRequest; answer: DisplayInfo[] };
  tool_picture: { request: ToolPictureRequest; answer: ToolPicture };
  combs: { request: CombsRequest; answer: Combs };
  section_combs: { request: SectionCombsRequest; answer: Combs };
  body_picture: { request: BodyPictureRequest; answer: BodyPicture };
  lattice_picture: { request: LatticePictureRequest; answer: BodyPicture };
  surface: { request: SurfaceRequest; answer: SurfaceNumbers };
  control_points: { request: ControlPointsRequest; answer: Float64Array };
  material: { request: MaterialRequest; answer: MaterialSamples };
  context: { request: ContextRequest; answer: Context | null };
  trims: { request: TrimsRequest; answer: Trims | null };
  face_edges: { request: FaceEdgesRequest; answer: FaceEdge[] };
  assembly: { request: AssemblyRequest; answer: Assembly | null };
}

type Numbers = { help: string; fields: { name: string; help: string; length: boolean; initial: number[] }[] };

export const shapes: Record<string, Numbers> = {
  sphere: { help: 'x² + y² + z² <= radius²', fields: [
      { name: 'radius', help: '', length: true, initial: [1] },
    ] },
  ellipsoid: { help: 'a ball stretched along its axes', fields: [
      { name: 'sizes', help: '[a, b, c] semi-axes', length: true, initial: [1, 1, 1] },
    ] },
  box: { help: 'with rounded edges and corners', fields: [
      { name: 'sizes', help: '[a, b, c] half sides', length: true, initial: [1, 1, 1] },
      { name: 'rounding', help: 'radius of its edges', length: true, initial: [0] },
    ] },
  cylinder: { help: 'about z', fields: [
      { name: 'radius', help: '', length: true, initial: [1] },
      { name: 'height', help: 'along z', length: true, initial: [2] },
    ] },
  cone: { help: 'about z, from the disc of `radius` in z = 0 up to the disc of `top_radius`', fields: [
      { name: 'radius', help: 'of its foot', length: true, initial: [1] },
      { name: 'height', help: 'along z', length: true, initial: [1] },
      { name: 'top_radius', help: '0 for a point', length: true, initial: [0] },
    ] },
  capsule: { help: 'a cylinder about z with half balls for ends', fields: [
      { name: 'radius', help: '', length: true, initial: [1] },
      { name: 'height', help: 'along z, without its ends', length: true, initial: [2] },
    ] },
  torus: { help: 'about z', fields: [
      { name: 'radius', help: 'of the middle of its tube', length: true, initial: [1] },
      { name: 'minor', help: 'of its tube', length: true, initial: [0.25] },
    ] },
  plane: { help: 'all that is below z = 0', fields: [] },
  bowl: { help: 'half of a hollow ball, open towards z', fields: [
      { name: 'radius', help: 'outside', length: true, initial: [1] },
      { name: 'thickness', help: 'of its wall', length: true, initial: [0.1] },
    ] },
  superellipsoid: { help: 'from a ball over a pillow to a box', fields: [
      { name: 'sizes', help: '[a, b, c] semi-axes', length: true, initial: [1, 1, 1] },
      { name: 'exponents', help: '[e1, e2] along and round the z axis: 1 is round, towards 0 square, 2 straight, above 2 pinched', length: false, initial: [1, 1] },
    ] },
  supertoroid: { help: 'from a round to a square ring', fields: [
      { name: 'radius', help: 'of the middle of its tube', length: true, initial: [1] },
      { name: 'minor', help: 'of its tube; or [across, along z]', length: true, initial: [0.25, 0.25] },
      { name: 'exponents', help: '[e1, e2] along and round the z axis: 1 is round, towards 0 square, 2 straight, above 2 pinched', length: false, initial: [1, 1] },
    ] },
  surface: { help: 'a surface of the document', fields: [] },
  wedge: { help: 'a straight ridge along x over its foot in z = 0', fields: [
      { name: 'length', help: 'along the ridge', length: true, initial: [2] },
      { name: 'angle', help: 'between the flanks, in degrees', length: false, initial: [60] },
      { name: 'height', help: 'from its foot to the ridge', length: true, initial: [1] },
      { name: 'rounding', help: 'radius of the ridge\'s edge', length: true, initial: [0] },
    ] },
};

export const materials = [{"name":"clay","help":"local, stays","alpha":0.10000000000000001,"beta":0.001},{"name":"wax","help":"local, springs back a little","alpha":0.10000000000000001,"beta":0.001},{"name":"rubber","help":"springs back","alpha":0.10000000000000001,"beta":0.01},{"name":"sheet metal","help":"bends widely, stays past a yield","alpha":0.050000000000000003,"beta":0.050000000000000003},{"name":"cloth","help":"is drawn along, springs back","alpha":1,"beta":0.0001},{"name":"membrane","help":"a soap film, springs back","alpha":1,"beta":0}] as const;

export const fileFormats = [{"id":"step","name":"STEP","endings":[".step",".stp",".p21"],"media_type":"model/step","content":"surfaces","holds":"the surfaces themselves, and everything else of the file byte for byte","opens":true},{"id":"iges","name":"IGES","endings":[".igs",".iges"],"media_type":"model/iges","content":"surfaces","holds":"the surfaces themselves, and everything else of an opened file byte for byte","opens":true},{"id":"brep","name":"Open CASCADE","endings":[".brep",".brp"],"media_type":"model/x-brep","content":"surfaces","holds":"surfaces with their faces, and everything else of an opened file byte for byte","opens":true},{"id":"g2","name":"GoTools","endings":[".g2"],"media_type":"model/x-gotools","content":"surfaces","holds":"spline surfaces, and everything else of an opened file byte for byte","opens":true},{"id":"gismo","name":"G+Smo","endings":[".xml"],"media_type":"application/xml","content":"surfaces","holds":"tensor-product surfaces, and everything else of an opened file byte for byte","opens":true},{"id":"geopdes","name":"GeoPDEs and Bembel","endings":[".dat"],"media_type":"text/x-nurbs","content":"surfaces","holds":"patches, and everything else of an opened file byte for byte","opens":true},{"id":"net","name":"plain net","endings":[".csv",".ctrlpts"],"media_type":"text/csv","content":"surfaces","holds":"the control points of one surface: a row of the net, an empty line, the next row","opens":true},{"id":"json-net","name":"JSON net","endings":[".json"],"media_type":"application/json","content":"surfaces","holds":"the control points of one surface as lists, with degrees, knots and weights if they are stated","opens":true},{"id":"stl","name":"STL","endings":[".stl"],"media_type":"model/stl","content":"triangles","holds":"triangles with the normal of each, binary, single precision","opens":false},{"id":"obj","name":"OBJ","endings":[".obj"],"media_type":"model/obj","content":"triangles","holds":"triangles with normals at the points, text, an object per surface","opens":false},{"id":"ply","name":"PLY","endings":[".ply"],"media_type":"application/octet-stream","content":"triangles","holds":"triangles with normals at the points, binary, points in double precision","opens":false},{"id":"gltf","name":"glTF","endings":[".glb"],"media_type":"model/gltf-binary","content":"triangles","holds":"triangles with normals at the points, binary, single precision, a mesh per surface; shown in metres","opens":false}] as const;
