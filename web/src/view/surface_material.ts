import * as THREE from 'three';

/** One material for everything a surface can look like: lit from both sides, zebra stripes, or coloured by a display. */
export function surfaceMaterial(): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      mode: { value: 0 },
      front: { value: new THREE.Color(0x9fb4c8) },
      back: { value: new THREE.Color(0xb59d86) },
      limits: { value: new THREE.Vector2(-1, 1) },
      selected: { value: 1 },
      marks: { value: null },
      trim: { value: null },
      trimmed: { value: false },
      accent: { value: new THREE.Color(0x3fb6a8) },
    },
    vertexShader: /* glsl */ `
      attribute float value;
      attribute vec2 span;
      varying vec2 vSpan, vPlace;
      varying vec3 vNormal;
      varying vec3 vView;
      varying float vValue;
      void main() {
        vec4 place = modelViewMatrix * vec4(position, 1.0);
        vNormal = normalMatrix * normal;
        vView = isOrthographic ? vec3(0.0, 0.0, 1.0) : -place.xyz;
        vValue = value;
        vSpan = span;
        vPlace = uv;
        gl_Position = projectionMatrix * place;
      }`,
    fragmentShader: /* glsl */ `
      uniform int mode;
      uniform vec3 front, back;
      uniform float selected;
      uniform vec2 limits;
      varying vec3 vNormal, vView;
      varying float vValue;
      varying vec2 vSpan, vPlace;
      uniform sampler2D marks, trim;
      uniform bool trimmed;
      uniform vec3 accent;

      // Blue below, grey at zero, red above; the brightness changes evenly on both sides.
      vec3 diverging(float x) {
        x = clamp(x, -1.0, 1.0);
        vec3 middle = vec3(0.87);
        vec3 end = x < 0.0 ? vec3(0.17, 0.38, 0.74) : vec3(0.78, 0.23, 0.19);
        return mix(middle, end, abs(x));
      }

      // From pale to dark, for values that are never negative.
      vec3 rising(float x) {
        x = clamp(x, 0.0, 1.0);
        vec3 low = vec3(0.95, 0.94, 0.86), middle = vec3(0.93, 0.6, 0.25), high = vec3(0.55, 0.1, 0.25);
        return x < 0.5 ? mix(low, middle, 2.0 * x) : mix(middle, high, 2.0 * x - 1.0);
      }

      void main() {
        vec3 n = normalize(vNormal);
        if (!gl_FrontFacing) n = -n;
        vec3 v = normalize(vView);
        vec3 base = gl_FrontFacing ? front : back;
        // The legend shows the output of this, after the conversion to the screen's colours.
        if (mode == 2) base = pow(diverging(vValue < 0.0 ? -vValue / limits.x : vValue / limits.y), vec3(2.2));
        if (mode == 3) base = pow(rising(vValue / limits.y), vec3(2.2));
        if (mode == 1) {
          // Stripes of a striped environment: lines where the reflected ray meets bands of equal height.
          vec3 r = reflect(-v, n);
          float stripe = sin(24.0 * asin(clamp(r.y, -1.0, 1.0)));
          float width = max(fwidth(stripe), 1e-4);
          float s = smoothstep(-width, width, stripe);
          base = mix(vec3(0.02), vec3(0.9), s);
          gl_FragColor = vec4(base * (0.75 + 0.25 * n.z), 1.0);
        } else {
          vec3 lamp = normalize(vec3(-0.62, 0.42, 0.66));
          float key = max(dot(n, lamp), 0.0);
          float fill = max(dot(n, normalize(vec3(0.8, -0.15, 0.35))), 0.0);
          float sky = 0.5 + 0.5 * n.y;
          float rim = pow(1.0 - max(dot(n, v), 0.0), 3.0);
          float shine = pow(max(dot(n, normalize(lamp + v)), 0.0), 40.0);
          vec3 colour = base * (0.1 + 0.16 * sky + 0.86 * key * key + 0.2 * fill);
          if (mode == 0) colour += vec3(0.2) * shine + vec3(0.08) * rim;
          else colour = mix(colour, base, 0.6);
          gl_FragColor = vec4(mix(vec3(dot(colour, vec3(0.3, 0.5, 0.2))) * 0.85, colour, selected), 1.0);
        }
        if (trimmed && texture2D(trim, vPlace).a < 0.5) discard;
        // Frozen spans are hatched, painted ones tinted.
        vec3 marked = texture2D(marks, vSpan).rgb;
        gl_FragColor.rgb = mix(gl_FragColor.rgb, vec3(0.75, 0.4, 0.08), 0.6 * marked.b);
        float hatch = smoothstep(0.5, 0.75, abs(fract((gl_FragCoord.x + gl_FragCoord.y) / 10.0) * 2.0 - 1.0));
        vec3 ice = vec3(0.05, 0.2, 0.55);
        gl_FragColor.rgb = mix(gl_FragColor.rgb, ice, marked.r > 0.5 ? 0.25 + 0.55 * hatch : 0.0);
        if (marked.g > 0.1) gl_FragColor.rgb = mix(gl_FragColor.rgb, marked.g > 0.8 ? accent : vec3(0.9), 0.55);
        #include <colorspace_fragment>
      }`,
  });
}
