import { byField, type DataFile, dataFile, isDataName, isTableOfPoints, textOf, withFile } from '@studio/document/data_files';

const bytes = (text: string) => new TextEncoder().encode(text);
const of = (name: string, text: string): DataFile => dataFile(name, bytes(text));
const obj = (points: number) => Array.from({ length: points }, (_, k) => `v ${k} 0 0`).join('\n');

describe('a file of data', () => {
  it.each([
    ['points.xyz', '1 2 3\n4 5 6\n', 'scan'],
    ['points.xyz', '# measured\n1 2 3 0 0 1\n4 5 6 0.6 0 0.8\n', 'scan'], // with normals
    ['points.txt', '1;2;3;0;0;0.1\n4;5;6;0;0.2;0\n', 'vectors'],
    ['points.txt', '1 2 3 0 0 1\n4 5 6 0 0 2\n', 'vectors'],
    ['table.csv', 'node,x,y,z,dx,dy,dz\n1,0,0,0,1,0,0\n', 'vectors'],
    ['table.csv', 'x,y,z\n0,0,0\n', 'scan'],
    ['one.txt', '0 0 0 0 0 0.1', 'vectors'],
    ['part.stl', 'solid x\nfacet normal 0 0 1\n', 'scan'],
    ['part.obj', 'v 0 0 0\n', 'scan'],
    ['part.vtk', '# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOINT_DATA 1\nVECTORS d float\n0 0 1\n', 'vectors'],
    ['part.vtk', '# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\n', 'scan'],
    ['part.vtu', '<VTKFile><PointData><DataArray Name="d" NumberOfComponents="3" format="ascii">0 0 1</DataArray></PointData></VTKFile>', 'vectors'],
    ['part.vtp', '<VTKFile><PointData></PointData><Points><DataArray NumberOfComponents="3"/></Points></VTKFile>', 'scan'],
  ] as const)('%s is told by its content', (name, text, kind) => {
    expect(of(name, text).kind).toBe(kind);
  });

  it('has a name that says so, and a table of points is no net', () => {
    expect(['a.XYZ', 'a.vtu', 'a.ply', 'a.step', 'a.json'].map(isDataName)).toEqual([true, true, true, false, false]);
    expect(isTableOfPoints(bytes('x,y,z,dx,dy,dz\n0,0,0,1,0,0\n'))).toBe(true);
    expect(isTableOfPoints(bytes('0,0,0\n1,0,0\n'))).toBe(true);
    expect(isTableOfPoints(bytes('0,0,0,1,0,0\n'))).toBe(true);
    expect(isTableOfPoints(bytes('0,0,0\n1,0,0\n\n0,1,0\n1,1,0\n'))).toBe(false); // a net: two rows
    expect(isTableOfPoints(bytes('0,0,0,1\n1,0,0,1\n'))).toBe(false); // with weights
  });

  it('takes the place of the one before, or is the second of two meshes', () => {
    const scan = of('a.xyz', '1 2 3\n'), first = of('a.obj', obj(3)), second = of('b.obj', obj(3)), other = of('c.obj', obj(4));
    expect(withFile([], 'scan', first)).toEqual({ files: [first], kind: 'scan' });
    expect(withFile([first], 'scan', second)).toEqual({ files: [first, second], kind: 'pair' }); // as many points
    expect(withFile([first], 'scan', other)).toEqual({ files: [other], kind: 'scan' });
    expect(withFile([first], 'pair', other)).toEqual({ files: [first, other], kind: 'pair' }); // said to be two
    expect(withFile([first, second], 'pair', scan)).toEqual({ files: [scan], kind: 'scan' });
    expect(withFile([scan], 'scan', scan)).toEqual({ files: [scan], kind: 'scan' });
  });

  it('is named as the engine calls it', () => {
    const first = of('a.obj', obj(3)), second = of('b.obj', obj(3));
    expect(byField([first], 'scan', (b) => b.length)).toEqual({ scan: first.bytes.length });
    expect(byField([first, second], 'pair', textOf)).toEqual({ from: obj(3), to: obj(3) });
    expect(byField([first], 'pair', textOf)).toBeNull();
    expect(byField([], 'scan', textOf)).toBeNull();
  });

  it('is text as it is, and base64 otherwise', () => {
    expect(textOf(bytes('1 2 3 # µ'))).toBe('1 2 3 # µ');
    expect(textOf(new Uint8Array([0xff, 0xfe]))).toBe('base64://4=');
    expect(textOf(new Uint8Array([0x31, 0]))).toBe('base64:MQA=');
    expect(textOf(bytes('base64:'))).toBe('base64:YmFzZTY0Og==');
  });
});
