import * as THREE from 'three';

import { type Display, type Palette, toleranceOf } from './display';
import { lookTexture } from './looks';
import { reliefUniforms } from './relief';
import { depthShaders, fragmentShader, vertexShader } from './surface_shader';
import { trimGlsl, trimUniforms, type TrimUniforms } from './trim_shader';

/** One material for everything a surface can look like: a look, zebra stripes, or coloured by a display. */
export function surfaceMaterial(): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      mode: { value: 0 },
      front: { value: new THREE.Color() },
      back: { value: new THREE.Color() },
      limits: { value: new THREE.Vector2(-1, 1) },
      selected: { value: 1 },
      marks: { value: null },
      ...trimUniforms(),
      flipped: { value: false },
      accent: { value: new THREE.Color(0x3fb6a8) },
      look: { value: null },
      mirrors: { value: false },
      isocurveColour: { value: new THREE.Vector4() },
      reliefStrength: { value: 0 },
      tolerance: { value: 0 },
      stripeAxis: { value: new THREE.Vector3(0, 1, 0) },
      stripePeriod: { value: 1 },
      sections: { value: new THREE.Vector4() },
      sectionOffset: { value: 0 },
      sectionColour: { value: new THREE.Color() },
      ...reliefUniforms,
    },
    vertexShader,
    fragmentShader,
  });
}

/** Draws how far away the surface is, with the trim of its other material. */
export function depthMaterial({ uniforms }: THREE.ShaderMaterial): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({ side: THREE.DoubleSide, uniforms: { ...trimOf(uniforms) }, ...depthShaders });
}

const trimOf = ({ trimNodes, trimSegments, trimmed }: Record<string, THREE.IUniform>): TrimUniforms =>
  ({ trimNodes: trimNodes!, trimSegments: trimSegments!, trimmed: trimmed! });

/** Lines over the surface end where its trims do. */
export function trimmedLines(material: THREE.LineBasicMaterial, { uniforms }: THREE.ShaderMaterial): THREE.LineBasicMaterial {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, trimOf(uniforms));
    shader.vertexShader = shader.vertexShader.replace('void main() {', 'varying vec2 vPlace;\nvoid main() {\n  vPlace = uv;');
    shader.fragmentShader = shader.fragmentShader.replace('void main() {', `varying vec2 vPlace;\n${trimGlsl}\nvoid main() {\n  if (hidden(vPlace)) discard;`);
  };
  return material;
}

/** Makes a material show what the display asks for. */
export function restyleMaterial({ uniforms }: THREE.ShaderMaterial, display: Display, palette: Palette): void {
  const { colour, stripes, look } = display;
  const plain = colour === null && stripes === 'none';
  uniforms.mode!.value = stripes === 'zebra' ? 1 : stripes === 'highlight' ? 4 : !colour ? 0 : colour.palette === 'rising' ? 3 : 2;
  uniforms.limits!.value.set(...display.limits);
  uniforms.tolerance!.value = toleranceOf(display);
  const shown = plain ? look : 'studio';
  uniforms.look!.value = lookTexture(shown);
  uniforms.mirrors!.value = shown === 'chrome';
  // Looks other than the studio's light have a colour of their own.
  const own = shown === 'studio' ? palette.front : 0xffffff;
  uniforms.front!.value.set(own);
  uniforms.back!.value.set(display.sides ? palette.back : own);
  uniforms.flipped!.value = display.flipped;
  uniforms.reliefStrength!.value = plain ? 1 : 0.4;
  const line = new THREE.Color(palette.isocurve);
  uniforms.isocurveColour!.value.set(line.r, line.g, line.b, display.isocurves ? palette.isocurveOpacity : 0);
  const angle = THREE.MathUtils.degToRad(display.stripeAngle);
  // Across the stripes: upwards on the screen, or along x of the scene.
  if (stripes === 'highlight') uniforms.stripeAxis!.value.set(Math.cos(angle), Math.sin(angle), 0);
  else uniforms.stripeAxis!.value.set(-Math.sin(angle), Math.cos(angle), 0);
  uniforms.stripePeriod!.value = THREE.MathUtils.degToRad(display.stripeSpacing);
  uniforms.sectionColour!.value.set(palette.section);
}

/** Lines where the surface is cut at multiples of a length along an axis of the file. */
export function placeSections({ uniforms }: THREE.ShaderMaterial, { sections }: Display, spacing: number, origin: readonly number[]): void {
  const k = 'xyz'.indexOf(sections);
  const across = new THREE.Vector3();
  if (k >= 0) across.setComponent(k, 1);
  uniforms.sections!.value.set(across.x, across.y, across.z, k < 0 ? 0 : 1 / spacing);
  uniforms.sectionOffset!.value = k < 0 ? 0 : (origin[k]! / spacing) % 1;
}
