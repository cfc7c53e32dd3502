import * as THREE from 'three';

import { disc } from './surface_view';
import type { Viewer } from './viewer';

/** Points of data, in the coordinates of the model; hidden where faces lie before them. */
export class DataPoints {
  private readonly points = new THREE.Points(new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ sizeAttenuation: false, vertexColors: true, alphaMap: disc(), alphaTest: 0.5 }));

  constructor(private readonly viewer: Viewer) {
    const { points } = this;
    Object.assign(points, { name: 'data points', frustumCulled: false, renderOrder: 5, visible: false });
    viewer.marks.add(points);
  }

  /** Three numbers each; `colours` from 0 to 1, as they look on the screen. Null: none. */
  show(places: Float64Array | null, colours: Float32Array = new Float32Array()): void {
    const { points, viewer } = this;
    if (!places && !points.visible) return;
    points.visible = places !== null && places.length > 0;
    if (places) {
      const { origin } = viewer;
      set(points.geometry, 'position', Float32Array.from(places, (x, k) => x - origin[k % 3]!));
      const colour = new THREE.Color();
      for (let k = 0; k < colours.length; k += 3) colour.setRGB(colours[k]!, colours[k + 1]!, colours[k + 2]!, THREE.SRGBColorSpace).toArray(colours, k);
      set(points.geometry, 'color', colours);
      points.material.size = (places.length > 3 * 50_000 ? 3 : 5) * Math.min(window.devicePixelRatio, 2);
    }
    viewer.redraw();
  }
}

function set(geometry: THREE.BufferGeometry, name: string, data: Float32Array): void {
  const old = geometry.getAttribute(name) as THREE.BufferAttribute | undefined;
  if (old?.array.length !== data.length) geometry.setAttribute(name, new THREE.BufferAttribute(data, 3));
  else {
    (old.array as Float32Array).set(data);
    old.needsUpdate = true;
  }
}
