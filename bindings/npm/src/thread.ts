// The other side of `RemoteDocument`: a document in a worker.
import { Document, Surface } from './document.js';
import { KneadError } from './errors.js';
import { compiled } from './loading.js';
import type { Answer, Question } from './protocol.js';

interface Scope {
  postMessage(answer: Answer, transfer: ArrayBuffer[]): void;
  onmessage: ((event: { data: Question }) => void) | null;
}

let document: Document | undefined;
let stop: Int32Array | null = null;

const scope = globalThis as unknown as Scope;

/** What is handed over instead of copied. */
function buffersOf(value: unknown): ArrayBuffer[] {
  if (ArrayBuffer.isView(value)) return value.buffer instanceof ArrayBuffer ? [value.buffer] : [];
  return typeof value === 'object' && value !== null ? [...new Set(Object.values(value).flatMap(buffersOf))] : [];
}

/** A surface goes over as what names it. */
const sent = (value: unknown): unknown =>
  (value instanceof Surface ? { id: value.id, label: value.label, unit: value.unit } : Array.isArray(value) ? value.map(sent) : value);

async function answer(question: Question): Promise<unknown> {
  const { id } = question;
  if (question.call === 'begin') {
    stop = question.stop;
    document = await Document.begin(await compiled(question.engine as BufferSource | WebAssembly.Module, 'the engine could not be started: it is'), question.from);
    return null;
  }
  if (question.call === 'read') {
    const of = (question.surface === undefined ? document : document!.surface(question.surface)) as unknown as Record<string, unknown>;
    const member = of[question.member];
    return sent(typeof member === 'function' ? (member as (...given: unknown[]) => unknown).apply(of, question.given) : member);
  }
  const progress = question.told ? (done: number, total: number) => scope.postMessage({ id, done, total }, []) : undefined;
  const stops = () => stop !== null && Atomics.load(stop, 0) === id;
  if (question.call === 'act') document!.work((engine) => engine.query('execute', { commands: [question.command] }), { progress }, stops);
  else document!.runUntil(question.script, question.name, { progress }, stops);
  return null;
}

let last: Promise<void> = Promise.resolve();
scope.onmessage = ({ data: question }) => {
  const { id } = question;
  last = last.then(() => answer(question)).then(
    (value) => scope.postMessage({ id, value }, question.call === 'read' && question.member !== 'snapshot' ? buffersOf(value) : []),
    (error: unknown) => {
      const told = error instanceof KneadError ? { info: error.info, file: error.file, line: error.line } : { message: String(error) };
      scope.postMessage({ id, error: told }, []);
    });
};
