import * as THREE from 'three';

import type { Command } from '../engine/session_types';
import { selected } from '../engine/session_state';
import type { Viewport } from '../view/viewport';
import type { ToolHost } from './host';
import { wayOf } from './tool_way';

const finest = 64; // pieces of one motion

/** Sends changes made to a tool by hand: how far it was moved, turned and resized since the last command. */
export function followGizmo(host: ToolHost, viewport: Viewport): void {
  const { gizmo } = viewport;
  const sent = { position: new THREE.Vector3(), turn: new THREE.Quaternion(), scale: new THREE.Vector3(1, 1, 1) };
  let begun = false;
  let used = false;

  const take = (object: THREE.Object3D) => {
    sent.position.copy(object.position);
    sent.turn.copy(object.quaternion);
    sent.scale.copy(object.scale);
  };

  /** From the state sent last to the present one, and a step of the surface unless it is playing anyway. */
  const commands = (): Command[] => {
    const { object } = gizmo;
    const tool = host.viewer.tools.selected;
    if (!object || !tool) return [];
    const list: Command[] = [];
    const steps = !host.playing() && selected(host.state!).length > 0;
    const by = object.position.clone().sub(sent.position);
    if (by.lengthSq() > 0) {
      const size = host.state!.tools.find((t) => t.name === tool)?.size ?? null;
      list.push(...wayOf({ name: tool, size }, by.toArray(), steps ? finest : 1));
    }
    const turn = object.quaternion.clone().multiply(sent.turn.clone().invert());
    const sine = Math.hypot(turn.x, turn.y, turn.z);
    if (sine > 1e-9) {
      list.push({ do: 'turn', tool, axis: [turn.x, turn.y, turn.z],
        angle: THREE.MathUtils.radToDeg(2 * Math.atan2(sine, turn.w)) });
    }
    const ratio = object.scale.clone().divide(sent.scale);
    if (ratio.toArray().every((x) => Number.isFinite(x) && x > 1e-3) && ratio.distanceTo(new THREE.Vector3(1, 1, 1)) > 1e-9) {
      list.push({ do: 'scale', tool, by: ratio.toArray() });
    }
    take(object);
    if (list.length > 0 && steps) list.push({ do: 'step' });
    return list;
  };

  gizmo.addEventListener('dragging-changed', (event) => {
    if (event.value && gizmo.object) {
      take(gizmo.object);
      begun = used = false;
    } else if (used) {
      void host.client.followed().then(() => host.execute([]));
    }
  });
  gizmo.addEventListener('objectChange', () => {
    if (!gizmo.dragging) return;
    used = true;
    // The first command begins a history entry; later ones belong to it.
    host.client.follow(commands, begun);
    begun = true;
  });
}
