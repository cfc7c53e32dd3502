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

  /** Three numbers each, from the viewer's origin; colours three bytes, as they look on the screen. Null: none. */
  show(places: Float32Array | null, colours: Uint8Array = new Uint8Array()): void {
    const { points, viewer } = this;
    if (!places && !points.visible) return;
    points.visible = places !== null && places.length > 0;
    if (places) {
      set(points.geometry, 'position', places);
      set(points.geometry, 'color', linear(colours));
      points.material.size = (places.length > 3 * 50_000 ? 3 : 5) * Math.min(window.devicePixelRatio, 2);
    } else {
      points.geometry.dispose(); // what it holds on the graphics card
      for (const name of ['position', 'color']) points.geometry.deleteAttribute(name);
    }
    viewer.redraw();
  }
}

/** As the shader takes colours: 16 bits, so that dark ones stay apart. */
function linear(colours: Uint8Array): Uint16Array {
  const table = Uint16Array.from({ length: 256 }, (_, k) => Math.round(65_535 * new THREE.Color().setRGB(k / 255, 0, 0, THREE.SRGBColorSpace).r));
  const result = new Uint16Array(colours.length);
  for (let k = 0; k < colours.length; ++k) result[k] = table[colours[k]!]!;
  return result;
}

function set(geometry: THREE.BufferGeometry, name: string, data: Float32Array | Uint16Array): void {
  const old = geometry.getAttribute(name) as THREE.BufferAttribute | undefined;
  if (old?.array.length !== data.length) geometry.setAttribute(name, new THREE.BufferAttribute(data, 3, true));
  else {
    old.array = data;
    old.needsUpdate = true;
  }
}
