import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { cycles, importsBelow, layers, wrongImports } from './layers';

const source = fileURLToPath(new URL('../../web/src', import.meta.url));

describe("the page's code", () => {
  const imports = importsBelow(source);

  it('is really read', () => {
    for (const layer of layers) expect([...imports.keys()].some((f) => f.startsWith(`${layer}/`)), layer).toBe(true);
    expect(imports.get('app/main.ts')).toContain('app/studio.ts');
    expect(imports.get('panels/lab/door.ts')).toContain('panels/lab/panel.ts'); // loaded when it is wanted
    expect(imports.get('document/rhino/client.ts')).toContain('document/rhino/worker.ts');
  });

  it('imports only what stands below it', () => expect(wrongImports(imports)).toEqual([]));
  it('has no circles', () => expect(cycles(imports)).toEqual([]));
});

describe('a small tree', () => {
  let root: string;
  beforeEach(() => {
    root = mkdtempSync(join(tmpdir(), 'knead-layers-'));
    write('engine/client.ts', "// import '../view/viewer';\n/* from '../view/viewer' */\nexport const a = 1;\n");
    write('view/viewer.ts', "import { a } from '../engine/client';\nexport { a };\n");
    write('app/main.ts', "import url from '../view/viewer?url';\nvoid url;\n");
  });
  afterEach(() => rmSync(root, { recursive: true }));

  const write = (file: string, text: string): void => {
    mkdirSync(dirname(join(root, file)), { recursive: true });
    writeFileSync(join(root, file), text);
  };
  const found = () => ({ wrong: wrongImports(importsBelow(root)), circles: cycles(importsBelow(root)) });

  it('in order is accepted', () => {
    expect(found()).toEqual({ wrong: [], circles: [] });
    expect(importsBelow(root).get('app/main.ts')).toEqual(['view/viewer.ts']);
  });

  it.each([
    "import type { A } from '../view/other';\n", "export * from '../view/other';\n", "const m = await import('../view/other');\n",
    "const w = new Worker(new URL('../view/other.ts', import.meta.url));\n", "import '../view/other';\n", 'import {\n  a,\n} from "../view/other";\n',
  ])('with an import of a layer above is found: %j', (text) => {
    write('view/other.ts', '');
    write('engine/client.ts', text);
    expect(found().wrong).toEqual(['engine/client.ts: the layer engine must not import view/other.ts, which is built on it']);
  });

  it('with a file outside of every layer is found', () => {
    write('attic/box.ts', '');
    expect(found().wrong).toEqual(['attic/box.ts: the file stands outside of every layer']);
  });

  it('with a circle within a layer is found', () => {
    write('view/a.ts', "import './b';\n");
    write('view/b.ts', "import type { C } from './c';\n");
    write('view/c.ts', "import './a';\nimport './viewer';\n");
    expect(found()).toEqual({ wrong: [], circles: [['view/a.ts', 'view/b.ts', 'view/c.ts']] });
  });
});
