import * as THREE from 'three';

import { shapes, type ToolCommand } from '@knead/generated';
import type { Placing, ToolHost } from './host';

/** Shapes whose own z axis points at the surface: the material of a plane lies below it, and a wedge presses with its ridge. */
const facing = ['plane', 'wedge'];

/** How far a shape reaches along its axis from its centre, towards the surface, in radii. */
const reaches: Record<string, number> = { plane: 0, cone: 0, torus: 0.25, supertoroid: 0.25, capsule: 2 };

/** The measures of a shape of this radius. */
function measures(shape: string, radius: number): Partial<ToolCommand> {
  const { fields } = shapes[shape]!;
  if (fields.some((f) => f.name === 'radius')) return { radius };
  return Object.fromEntries(fields.filter((f) => f.length).map(({ name, initial }) =>
    [name, initial.length > 1 ? initial.map((x) => radius * x) : radius * initial[0]!]));
}

/** The command that puts a tool of the chosen shape beside a point of the surface, its axis along the normal. `radius`: its size, file units. */
export function newTool(host: ToolHost, { shape, surface }: Placing, radius: number, point: THREE.Vector3, normal: THREE.Vector3): ToolCommand {
  const taken = new Set(host.state!.tools.map((t) => t.name));
  let number = 1;
  while (taken.has(`tool ${number}`)) ++number;
  const name = `tool ${number}`;
  const common = { do: 'tool', name, shape: shape as ToolCommand['shape'], plasticity: 1, touches: 'visible' } satisfies ToolCommand;
  if (shape === 'surface') return { ...common, surface };
  const centre = point.clone().addScaledVector(normal, (reaches[shape] ?? 1) * radius * 1.02).add(new THREE.Vector3(...host.viewer.origin));
  const axis = facing.includes(shape) ? normal.clone().negate() : normal;
  return { ...common, position: centre.toArray(), ...(shape === 'sphere' ? {} : { axis: axis.toArray() }), ...measures(shape, radius) };
}
