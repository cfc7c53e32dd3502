/** A STEP file: a flat patch of 10 × 10 whose face is a disc of radius 4, and a square of 40 × 40 on a plane below it; `planes`: the square alone. */
export function facesStep(planes = false): Uint8Array {
  const lines: string[] = [];
  let next = 1;
  const add = (record: string) => {
    lines.push(`#${next}=${record};`);
    return next++;
  };
  const real = (x: number) => (Number.isInteger(x) ? `${x}.` : `${x}`);
  const point = (x: number, y: number, z: number) => add(`CARTESIAN_POINT('',(${real(x)},${real(y)},${real(z)}))`);
  const frame = (z: number) => add(`AXIS2_PLACEMENT_3D('',#${point(0, 0, z)},$,$)`);
  const bound = (edges: number[]) => {
    const oriented = edges.map((e) => `#${add(`ORIENTED_EDGE('',*,*,#${e},.T.)`)}`).join();
    return add(`FACE_OUTER_BOUND('',#${add(`EDGE_LOOP('',(${oriented}))`)},.T.)`);
  };
  if (!planes) {
    const grid = [-5, -2.5, 0, 2.5, 5];
    const net = grid.map((x) => `(${grid.map((y) => `#${point(x, y, 0)}`).join()})`).join();
    const patch = add(`B_SPLINE_SURFACE_WITH_KNOTS('patch',3,3,(${net}),.UNSPECIFIED.,.F.,.F.,.F.,(4,1,4),(4,1,4),(0.,0.5,1.),(0.,0.5,1.),.UNSPECIFIED.)`);
    const seam = add(`VERTEX_POINT('',#${point(4, 0, 0)})`);
    const circle = add(`EDGE_CURVE('',#${seam},#${seam},#${add(`CIRCLE('',#${frame(0)},4.)`)},.T.)`);
    add(`ADVANCED_FACE('',(#${bound([circle])}),#${patch},.T.)`);
  }
  const corners = [[-20, -20], [20, -20], [20, 20], [-20, 20]] as const;
  const places = corners.map(([x, y]) => point(x, y, -4));
  const vertices = places.map((p) => add(`VERTEX_POINT('',#${p})`));
  const edges = corners.map(([x, y], k) => {
    const [a, b] = corners[(k + 1) % 4]!;
    const direction = add(`DIRECTION('',(${real((a - x) / 40)},${real((b - y) / 40)},0.))`);
    const line = add(`LINE('',#${places[k]},#${add(`VECTOR('',#${direction},1.)`)})`);
    return add(`EDGE_CURVE('',#${vertices[k]},#${vertices[(k + 1) % 4]},#${line},.T.)`);
  });
  add(`ADVANCED_FACE('',(#${bound(edges)}),#${add(`PLANE('',#${frame(-4)})`)},.T.)`);
  const text = `ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n${lines.join('\n')}\nENDSEC;\nEND-ISO-10303-21;\n`;
  return new TextEncoder().encode(text);
}
