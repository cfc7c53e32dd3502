import * as THREE from 'three';

import type { Display } from './display';

/** Objects on this layer are what relief is seen of. */
export const reliefLayer = 1;
const coarser = 4; // pixels of the screen per pixel of the passes, in each direction
const reach = 6; // of a comparison, in pixels of the passes

const none = new THREE.DataTexture(new Uint8Array([128, 128, 128, 255]), 1, 1);
none.needsUpdate = true;

/** What the materials of surfaces read: how far each place of the screen stands out, 0.5 for not at all. */
export const reliefUniforms = { relief: { value: none as THREE.Texture }, reliefSize: { value: new THREE.Vector2(1, 1) } };

const comparison = /* glsl */ `
  uniform sampler2D depth;
  uniform mat4 projection;
  uniform vec4 part; // of the picture, pixels: lower left corner, size

  float at(ivec2 place) { return texelFetch(depth, place, 0).r; }
  // 1 / distance in perspective, distance in parallel projection: either is linear over the picture of a plane.
  float linear(float d) {
    float z = 2.0 * d - 1.0;
    return projection[3][3] == 0.0 ? (z + projection[2][2]) / projection[3][2] : (projection[3][2] - z) / projection[2][2];
  }
  void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    float d = at(here);
    if (d >= 1.0) { gl_FragColor = vec4(0.5); return; }
    bool perspective = projection[3][3] == 0.0;
    float middle = linear(d);
    float away = perspective ? 1.0 / middle : 1.0;
    // Length of the reach at this distance.
    float size = ${reach}.0 * 2.0 * away / (projection[1][1] * part.w);
    float toLength = perspective ? -away * away : 1.0;
    float sum = 0.0, weight = 0.0;
    for (int k = 0; k < 8; ++k) {
      float angle = 0.7854 * float(k) * 0.5 + 0.2;
      ivec2 step = ivec2(round(float(k % 2 == 0 ? ${reach} : ${reach} / 2) * vec2(cos(angle), sin(angle))));
      ivec2 a = here + step, b = here - step;
      vec4 inside = vec4(part.xy, part.xy + part.zw - 1.0);
      if (any(lessThan(vec2(min(a, b)), inside.xy)) || any(greaterThan(vec2(max(a, b)), inside.zw))) continue;
      float da = at(a), db = at(b);
      if (da >= 1.0 || db >= 1.0) continue;
      // How much farther than this place the middle of two opposite ones is: 0 on every plane.
      float x = toLength * (0.5 * (linear(da) + linear(db)) - middle) / size;
      if (k % 2 == 1) x *= 2.0;
      sum += x / (1.0 + 12.0 * x * x); // what is far behind or before is another object
      weight += 1.0;
    }
    gl_FragColor = vec4(0.5 + clamp(weight > 0.0 ? 6.0 * sum / weight : 0.0, -0.5, 0.5));
  }`;

/** The mean of 6 × 6 values: where triangles end is rounded to a share of a pixel, and what follows of that is noise. */
const smoothing = /* glsl */ `
  uniform sampler2D rough;
  void main() {
    vec2 size = vec2(textureSize(rough, 0));
    float sum = 0.0;
    for (int k = 0; k < 9; ++k) sum += texture(rough, (gl_FragCoord.xy + 2.0 * vec2(k % 3 - 1, k / 3 - 1) + 0.5) / size).r;
    gl_FragColor = vec4(sum / 9.0);
  }`;

/** A pass over all pixels of a target. */
function pass(fragmentShader: string, uniforms: Record<string, THREE.IUniform>): THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial> {
  const mesh = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
    depthTest: false, depthWrite: false, uniforms, fragmentShader, vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
  }));
  mesh.frustumCulled = false;
  return mesh;
}

/**
 * Brightens what stands out of its surroundings on the screen and darkens what lies in a hollow, in the manner of the
 * unsharp mask of the depth buffer (T. Luft, C. Colditz, O. Deussen: Image enhancement by unsharp masking the depth buffer,
 * ACM Transactions on Graphics 25, 2006), by second differences: opposite neighbours are compared in pairs, so that planes,
 * their rims and what lies before them give nothing. Three passes at a quarter of the resolution.
 */
export class Relief {
  private readonly depth = new THREE.WebGLRenderTarget(1, 1, { depthTexture: new THREE.DepthTexture(1, 1, THREE.UnsignedIntType), stencilBuffer: false });
  private readonly rough = new THREE.WebGLRenderTarget(1, 1, { depthBuffer: false });
  private readonly result = new THREE.WebGLRenderTarget(1, 1, { depthBuffer: false });
  private readonly camera = new THREE.OrthographicCamera();
  private readonly compare = pass(comparison, {
    depth: { value: this.depth.depthTexture }, projection: { value: new THREE.Matrix4() }, part: { value: new THREE.Vector4() },
  });
  private readonly smooth = pass(smoothing, { rough: { value: this.rough.texture } });

  /** Whether surfaces are to show it. */
  static wanted({ relief, surface, stripes }: Display): boolean {
    return relief && surface && stripes === 'none';
  }

  /** For a picture of this many pixels. */
  begin(renderer: THREE.WebGLRenderer, wanted: boolean): void {
    reliefUniforms.relief.value = wanted ? this.result.texture : none;
    if (!wanted) return;
    const size = renderer.getDrawingBufferSize(reliefUniforms.reliefSize.value);
    const ratio = renderer.getPixelRatio() * coarser;
    const [width, height] = [Math.ceil(size.x / ratio), Math.ceil(size.y / ratio)];
    size.set(width * ratio, height * ratio);
    for (const target of [this.depth, this.rough, this.result]) if (target.width !== width || target.height !== height) target.setSize(width, height);
  }

  /** Of one view, a part of the picture as the renderer counts. */
  draw(renderer: THREE.WebGLRenderer, scene: THREE.Scene, camera: THREE.Camera, [x, y, width, height]: [number, number, number, number]): void {
    const [left, below] = [Math.floor(x / coarser), Math.floor(y / coarser)];
    const part = new THREE.Vector4(x / coarser, y / coarser, width / coarser, height / coarser);
    const { uniforms } = this.compare.material;
    uniforms.projection!.value.copy(camera.projectionMatrix);
    uniforms.part!.value.copy(part);
    for (const target of [this.depth, this.rough, this.result]) {
      target.viewport.copy(part);
      target.scissor.set(left, below, Math.ceil(part.x + part.z) - left, Math.ceil(part.y + part.w) - below);
      target.scissorTest = true;
    }
    const layers = camera.layers.mask;
    camera.layers.set(reliefLayer);
    renderer.setRenderTarget(this.depth);
    renderer.clear();
    renderer.render(scene, camera);
    camera.layers.mask = layers;
    renderer.setRenderTarget(this.rough);
    renderer.render(this.compare, this.camera);
    renderer.setRenderTarget(this.result);
    renderer.render(this.smooth, this.camera);
    renderer.setRenderTarget(null);
  }
}
