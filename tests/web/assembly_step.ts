/** Writes a STEP file record by record; products and their places are what assemblies are made of. */
function stepFile() {
  const lines: string[] = [];
  let next = 1;
  const add = (record: string) => {
    lines.push(`#${next}=${record};`);
    return next++;
  };
  const real = (x: number) => (Number.isInteger(x) ? `${x}.` : `${x}`);
  const triple = (p: readonly number[]) => `(${p.map(real).join()})`;
  const point = (...p: number[]) => add(`CARTESIAN_POINT('',${triple(p)})`);
  const frame = (at: readonly number[], z: readonly number[] = [0, 0, 1], x: readonly number[] = [1, 0, 0]) =>
    add(`AXIS2_PLACEMENT_3D('',#${point(...at)},#${add(`DIRECTION('',${triple(z)})`)},#${add(`DIRECTION('',${triple(x)})`)})`);
  const millimetre = add('(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))');
  const inches = add(`(CONVERSION_BASED_UNIT('INCH',#${add(`LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#${millimetre})`)})LENGTH_UNIT()NAMED_UNIT(#${add('DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)')}))`);
  const context = (unit: number) => add(`(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#${unit}))REPRESENTATION_CONTEXT('',''))`);
  const [mm, inch] = [context(millimetre), context(inches)];
  const origin = frame([0, 0, 0]);
  const product = (name: string, items: number[], units: number) => {
    const definition = add(`PRODUCT_DEFINITION('','',#${add(`PRODUCT_DEFINITION_FORMATION('','',#${add(`PRODUCT('${name}','${name}','',())`)})`)},$)`);
    const shape = add(`PRODUCT_DEFINITION_SHAPE('','',#${definition})`);
    const representation = add(`SHAPE_REPRESENTATION('',(${items.map((k) => `#${k}`).join()}),#${units})`);
    add(`SHAPE_DEFINITION_REPRESENTATION(#${shape},#${representation})`);
    return { definition, representation };
  };
  type Product = ReturnType<typeof product>;
  const use = (parent: Product, child: Product, to: number) => {
    const shape = add(`PRODUCT_DEFINITION_SHAPE('','',#${add(`NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#${parent.definition},#${child.definition},$)`)})`);
    const relation = `REPRESENTATION_RELATIONSHIP('','',#${child.representation},#${parent.representation})REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#${add(`ITEM_DEFINED_TRANSFORMATION('','',#${origin},#${to})`)})`;
    add(`CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#${add(`(${relation}SHAPE_REPRESENTATION_RELATIONSHIP())`)},#${shape})`);
  };
  /** A flat patch of 10 × 10 about the origin. */
  const patch = () => {
    const grid = [-5, -2.5, 0, 2.5, 5];
    const net = grid.map((x) => `(${grid.map((y) => `#${point(x, y, 0)}`).join()})`).join();
    return add(`B_SPLINE_SURFACE_WITH_KNOTS('patch',3,3,(${net}),.UNSPECIFIED.,.F.,.F.,.F.,(4,1,4),(4,1,4),(0.,0.5,1.),(0.,0.5,1.),.UNSPECIFIED.)`);
  };
  const bytes = () => new TextEncoder().encode(`ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n${lines.join('\n')}\nENDSEC;\nEND-ISO-10303-21;\n`);
  return { add, point, triple, frame, product, use, patch, bytes, mm, inch, origin };
}

/**
 * A STEP file of an assembly in mm: the part "plate", a flat patch of 10 × 10 about its origin, stands upright at (20, 0, 0),
 * its z along x, and lies at (0, 30, 0), turned by a quarter about z, and at (0, -30, 5); the part "foot", a square of 2 × 2 inches
 * on a plane, stands at (-60, 0, 0); the part "rail", a curve from (0, 0, 0) to (12, 0, 0), stands at (0, 60, 0) turned by a
 * quarter about z, and at (0, 60, 8).
 */
export function assemblyStep(): Uint8Array {
  const { add, point, triple, frame, product, use, patch, bytes, mm, inch, origin } = stepFile();
  const flat = patch();
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]] as const;
  const places = corners.map(([x, y]) => point(x, y, 0));
  const vertices = places.map((p) => add(`VERTEX_POINT('',#${p})`));
  const edges = corners.map(([x, y], k) => {
    const [a, b] = corners[(k + 1) % 4]!;
    const line = add(`LINE('',#${places[k]},#${add(`VECTOR('',#${add(`DIRECTION('',${triple([(a - x) / 2, (b - y) / 2, 0])})`)},1.)`)})`);
    return `#${add(`ORIENTED_EDGE('',*,*,#${add(`EDGE_CURVE('',#${vertices[k]},#${vertices[(k + 1) % 4]},#${line},.T.)`)},.T.)`)}`;
  });
  const square = add(`ADVANCED_FACE('',(#${add(`FACE_OUTER_BOUND('',#${add(`EDGE_LOOP('',(${edges.join()}))`)},.T.)`)}),#${add(`PLANE('',#${origin})`)},.T.)`);
  const table = product('table', [origin], mm);
  const plate = product('plate', [flat, origin], mm);
  const foot = product('foot', [square, origin], inch);
  use(table, plate, frame([20, 0, 0], [1, 0, 0], [0, 1, 0]));
  use(table, plate, frame([0, 30, 0], [0, 0, 1], [0, 1, 0]));
  use(table, plate, frame([0, -30, 5]));
  use(table, foot, frame([-60, 0, 0]));
  const ends = [0, 4, 8, 12].map((x) => `#${point(x, 0, 0)}`).join();
  const wire = add(`B_SPLINE_CURVE_WITH_KNOTS('wire',3,(${ends}),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),.UNSPECIFIED.)`);
  const rail = product('rail', [add(`GEOMETRIC_CURVE_SET('',(#${wire}))`), origin], mm);
  use(table, rail, frame([0, 60, 0], [0, 0, 1], [0, 1, 0]));
  use(table, rail, frame([0, 60, 8]));
  return bytes();
}

/**
 * A STEP file of an assembly of assemblies: two "hinge" stand in the "door", each of a "leaf" and three "pin"; a "pin" stands beside
 * them. Parts are flat patches of 10 × 10 in the plane z = 0, 20 apart.
 */
export function nestedStep(): Uint8Array {
  const { frame, product, use, patch, bytes, mm, origin } = stepFile();
  const door = product('door', [origin], mm), hinge = product('hinge', [origin], mm);
  const leaf = product('leaf', [patch(), origin], mm), pin = product('pin', [patch(), origin], mm);
  use(hinge, leaf, frame([0, 0, 0]));
  for (const k of [1, 2, 3]) use(hinge, pin, frame([20 * k, 0, 0]));
  for (const k of [0, 1]) use(door, hinge, frame([0, 20 * k, 0]));
  use(door, pin, frame([0, 40, 0]));
  return bytes();
}
