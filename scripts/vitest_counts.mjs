// What a run of vitest found, from its results as JSON.
//   node vitest_counts.mjs counts RESULTS.json NPM_SCRIPT COUNTS FAILED   writes "passed failed skipped" to one file, and to
//                                                                         another a line for each failed test, which repeats it
//   node vitest_counts.mjs skipped RESULTS.json                           prints the files of which a test was skipped
import { readFileSync, writeFileSync } from 'node:fs';
import { basename } from 'node:path';

const [what, results, script, counts, failed] = process.argv.slice(2);
const { testResults } = JSON.parse(readFileSync(results, 'utf8'));
const tests = testResults.flatMap(({ name, assertionResults }) => assertionResults.map((test) => ({ ...test, file: basename(name) })));
const skipped = tests.filter(({ status }) => status !== 'passed' && status !== 'failed');

if (what === 'skipped') {
  console.log([...new Set(skipped.map(({ file }) => file))].join('\n'));
} else {
  const quoted = (text) => `'${text.replaceAll("'", `'\\''`)}'`;
  const again = (file) => `(cd web && npm run ${script} -- ${file}`;
  const lines = tests.filter(({ status }) => status === 'failed').map(({ file, fullName }) => `${again(file)} -t ${quoted(fullName)})`);
  // A file may fail as a whole, before its first test.
  for (const { name, status, assertionResults } of testResults) {
    if (status === 'failed' && !assertionResults.some((test) => test.status === 'failed')) lines.push(`${again(basename(name))})`);
  }
  writeFileSync(failed, lines.map((line) => `${line}\n`).join(''));
  writeFileSync(counts, `${tests.length - skipped.length - tests.filter(({ status }) => status === 'failed').length} ${lines.length} ${skipped.length}\n`);
}
