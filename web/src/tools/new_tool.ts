import * as THREE from 'three';

import type { Command } from '../engine/session_types';
import type { Placing, ToolHost } from './host';

const lying = ['plane', 'bowl', 'cylinder', 'cone', 'capsule', 'torus', 'supertoroid', 'box', 'ellipsoid', 'superellipsoid'];

/** The command that puts a tool of the chosen shape beside a point of the surface, its axis along the normal. `radius`: its size, file units. */
export function newTool(host: ToolHost, { shape, surface }: Placing, radius: number, point: THREE.Vector3, normal: THREE.Vector3): Command {
  const taken = new Set(host.state!.tools.map((t) => t.name));
  let number = 1;
  while (taken.has(`tool ${number}`)) ++number;
  const name = `tool ${number}`;
  const common = { do: 'tool', name, shape, plasticity: 1 };
  if (shape === 'surface') return { ...common, surface };
  // How far the shape reaches along its axis from its centre, towards the surface.
  const reach = shape === 'plane' || shape === 'cone' ? 0 : shape === 'torus' || shape === 'supertoroid' ? 0.25 * radius : shape === 'capsule' ? 2 * radius : radius;
  const centre = point.clone().addScaledVector(normal, reach * 1.02).add(new THREE.Vector3(...host.viewer.origin));
  // The material of a plane lies below it: it looks at the surface.
  const axis = shape === 'plane' ? normal.clone().negate() : normal;
  const boxlike = shape === 'box' || shape === 'ellipsoid' || shape === 'superellipsoid';
  return { ...common, position: centre.toArray(), ...(lying.includes(shape) ? { axis: axis.toArray() } : {}),
    ...(shape === 'plane' ? {} : boxlike ? { sizes: [radius, radius, radius] } : { radius }) };
}
