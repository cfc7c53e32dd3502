import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import ts from 'typescript';

const source = fileURLToPath(new URL('../../web/src', import.meta.url));

/** What the engine writes for people: a program reads codes and values. */
const prose = new Set(['what', 'where', 'remedy', 'message', 'note', 'notes']);
const called = new Set(['test', 'exec', 'match', 'matchAll', 'replace', 'replaceAll', 'search', 'split']);

/** Calls in which a regular expression meets a text of the engine: by the name of the member or variable that holds it. */
function readings(file: string, text: string): string[] {
  const parsed = ts.createSourceFile(file, text, ts.ScriptTarget.Latest, true);
  const found: string[] = [];
  const isPattern = (node: ts.Node): boolean =>
    node.kind === ts.SyntaxKind.RegularExpressionLiteral || (ts.isNewExpression(node) && node.expression.getText() === 'RegExp');
  const holds = (node: ts.Node, fits: (part: ts.Node) => boolean): boolean => fits(node) || (ts.forEachChild(node, (part) => holds(part, fits) || undefined) ?? false);
  const isMethod = (node: ts.Node): boolean => {
    const { parent } = node;
    return ts.isPropertyAccessExpression(parent) && parent.name === node && ts.isCallExpression(parent.parent) && parent.parent.expression === parent;
  };
  const isProse = (node: ts.Node): boolean => ts.isIdentifier(node) && !isMethod(node)
    && (prose.has(node.text) || (node.text === 'text' && ts.isPropertyAccessExpression(node.parent) && node.parent.name === node));
  const visit = (node: ts.Node): void => {
    if (ts.isCallExpression(node) && ts.isPropertyAccessExpression(node.expression) && called.has(node.expression.name.text)) {
      const parts = [node.expression.expression, ...node.arguments];
      const patterns = parts.some((part) => holds(part, isPattern)) || ['test', 'exec'].includes(node.expression.name.text);
      if (patterns && parts.some((part) => holds(part, isProse))) {
        found.push(`${file}:${parsed.getLineAndCharacterOfPosition(node.getStart()).line + 1}: reads the words of the engine`);
      }
    }
    ts.forEachChild(node, visit);
  };
  visit(parsed);
  return found;
}

describe('words of the engine', () => {
  const files = readdirSync(source, { recursive: true, encoding: 'utf8' }).filter((f) => f.endsWith('.ts') && !f.endsWith('generated.ts'));

  it('are read by nothing in the page', () => {
    expect(files).toContain(join('document', 'words.ts'));
    expect(files.flatMap((f) => readings(f, readFileSync(join(source, f), 'utf8')))).toEqual([]);
  });

  it('meet no pattern where sentences are made of them', () => {
    const text = readFileSync(join(source, 'document/words.ts'), 'utf8');
    const patterns: string[] = [];
    const visit = (node: ts.Node): void => {
      if (node.kind === ts.SyntaxKind.RegularExpressionLiteral || (ts.isIdentifier(node) && node.text === 'RegExp')) patterns.push(node.getText());
      ts.forEachChild(node, visit);
    };
    visit(ts.createSourceFile('words.ts', text, ts.ScriptTarget.Latest, true));
    expect(patterns).toEqual([]);
  });

  it.each([
    'const m = /folds/.exec(error.what);', 'if (/held$/.test(note)) act();', "const c = remedy.match(/{.*}/);", "info.message.replace(/a/g, 'b');",
    "const known = patterns.find((p) => p.test(error.what));", "new RegExp('fold').test(note.text);",
  ])('are found where they are read: %s', (text) => expect(readings('a.ts', text)).toHaveLength(1));

  it.each(["/\\.json$/.test(file.name) && isNet(await file.text());", "error.remedy.split('`');", "name.replace(/\\.[^.]*$/, '');"])(
    'are not where they are not: %s', (text) => expect(readings('a.ts', text)).toEqual([]));
});
