import * as THREE from 'three';

import type { Assembly } from '../engine/context';
import { boundsOf } from '../view/bounds';
import { boxOf } from '../view/near';
import { placedBox } from '../view/placing';
import type { App } from './app';
import { type AssemblyNode, assemblyTree } from './assembly_tree';
import { h } from './dom';
import { note, panel } from './panel';

const counted = (count: number, one: string, many = `${one}s`) => (count === 1 ? `1 ${one}` : `${count} ${many}`);
/** More products of one assembly are counted, not listed. */
const mostListed = 60;

/** The product tree of the opened file, as `knead info` lists it. A click goes to a place of a part, another one to its next place. */
export function assemblyPanel(app: App): HTMLElement {
  const { placing } = app.viewer;
  let shown: Assembly | null = null;
  let opened = 0;
  const assembly = () => {
    if (placing.assembly !== shown) [shown, opened] = [placing.assembly, opened + 1];
    return shown;
  };
  return panel(app, 'Assembly', (a) => [assembly() && opened, a.state?.surfaces.map((s) => s.id), a.state?.selection, a.state?.bodies.map((b) => b.id), a.state?.body], () => {
    const all = assembly();
    if (!all) return [];
    const places = all.parts.reduce((sum, part) => sum + part.places.length, 0);
    const repeated = all.parts.some((part) => part.places.length > 1);
    return [
      note(`${counted(all.parts.length, 'part')} in ${counted(places, 'place')}.${repeated ? ' A part that stands in several places is sculpted once, and changes in all of them.' : ''}`),
      ...all.warnings.map((warning) => note(warning)),
      h('ul', { class: 'list assembly-tree' }, ...items(app, all, assemblyTree(all))),
    ];
  }, true, () => (assembly()?.parts.length ?? 0) > 0);
}

function items(app: App, all: Assembly, { within }: AssemblyNode): HTMLElement[] {
  const listed = [...within.values()].slice(0, mostListed).map((node) => item(app, all, node));
  const left = within.size - listed.length;
  return left > 0 ? [...listed, h('li', {}, h('small', {}, `and ${counted(left, 'other product')}`))] : listed;
}

function item(app: App, all: Assembly, node: AssemblyNode): HTMLElement {
  const inner = node.within.size > 0 ? h('ul', {}, ...items(app, all, node)) : null;
  const name = node.name || 'without a name';
  if (node.places.length === 0) return h('li', {}, h('span', { class: 'assembly-name' }, name), inner);
  const part = all.parts[node.places[0]!.part]!;
  const { state } = app;
  const ids = state?.surfaces.filter((s) => part.surfaces.includes(s.id)).map((s) => s.id) ?? [];
  const chosen = state ? [...state.selection.map((k) => state.surfaces[k]!.id), ...(state.body === null ? [] : [state.bodies[state.body]!.id])] : [];
  const on = !app.viewer.waiting && chosen.some((id) => ids.includes(id) || part.curves.includes(id));
  const count = node.places.length > 1 ? ` × ${node.places.length}` : '';
  let next = 0;
  const show = () => goTo(app, node.places[next++ % node.places.length]!);
  return h('li', {}, h('button', { class: on ? 'item on' : 'item', type: 'button', onclick: show, aria: { pressed: String(on) },
    title: node.places.length > 1 ? 'Shows one place after the other; tools work there' : 'Shows it' },
    h('span', {}, `${name}${count}`),
    h('small', {}, ids.length > 0 ? counted(ids.length, 'surface') : part.faces.length > 0 ? counted(part.faces.length, 'face') : counted(part.curves.length, 'curve'))), inner);
}

/** Shows a part in one of its places, where it is worked on from now on. */
function goTo(app: App, { part, place }: { part: number; place: number }): void {
  const { viewer } = app;
  const at = viewer.placing.ofPart(part)[place];
  if (!at) return; // beyond what is drawn
  viewer.workAt(at);
  const { surfaces, faces, curves } = viewer.placing.assembly!.parts[part]!;
  const boxes = viewer.surfaces.flatMap(({ picture }, k) =>
    (picture && surfaces.includes(app.state!.surfaces[k]!.id) ? [placedBox(new THREE.Box3().setFromArray(picture.positions), at)] : []));
  const lines = viewer.bodies.drawn.filter(({ body, standing }) => standing === at && curves.includes(app.state!.bodies[body]!.id)).map(boxOf);
  const grey = viewer.context.boxAt(new Set(faces), at);
  if (boxes.length + lines.length > 0 || grey) viewer.fit(boundsOf([...boxes, ...lines, grey]));
  app.changed();
}
