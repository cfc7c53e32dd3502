import { trimGlsl } from './trim_shader';

/** How far the colours just outside a tolerance are from grey. */
export const justOutside = 0.3;

/** The shaders of surfaces: a look, stripes or colours; lines over it; marks of spans. */

export const vertexShader = /* glsl */ `
  attribute float value;
  attribute vec2 span, isocurve;
  varying vec2 vSpan, vPlace, vIsocurve;
  varying vec3 vNormal, vView, vSceneNormal, vScene;
  varying float vValue;
  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    vNormal = normalMatrix * normal;
    vView = isOrthographic ? vec3(0.0, 0.0, 1.0) : -place.xyz;
    vValue = value;
    vScene = (modelMatrix * vec4(position, 1.0)).xyz;
    vSceneNormal = mat3(modelMatrix) * normal;
    vSpan = span;
    vIsocurve = isocurve;
    vPlace = uv;
    gl_Position = projectionMatrix * place;
  }`;

export const fragmentShader = /* glsl */ `
  uniform int mode; // 0 plain, 1 zebra, 2 diverging, 3 rising, 4 highlight lines
  uniform vec3 front, back, accent;
  uniform float selected, reliefStrength, tolerance;
  uniform vec2 limits, reliefSize;
  uniform sampler2D marks, look, relief;
  uniform bool mirrors, flipped;
  uniform vec4 isocurveColour, sections; // of the latter: unit vector across them, then how many per length
  uniform float sectionOffset, stripePeriod;
  uniform vec3 sectionColour, stripeAxis;
  varying vec2 vSpan, vPlace, vIsocurve;
  varying vec3 vNormal, vView, vSceneNormal, vScene;
  varying float vValue;
  ${trimGlsl}

  // Blue below, grey at zero, red above; the brightness changes evenly on both sides. Within the tolerance all is grey, and
  // just outside it no longer.
  vec3 diverging(float value) {
    float size = abs(value), limit = value < 0.0 ? -limits.x : limits.y;
    float x = clamp(size / limit, 0.0, 1.0);
    if (tolerance > 0.0) {
      float edge = max(fwidth(value), 1e-12);
      x = smoothstep(-0.5 * edge, 0.5 * edge, size - tolerance) *
          mix(${justOutside}, 1.0, clamp((size - tolerance) / max(limit - tolerance, 1e-12), 0.0, 1.0));
    }
    return mix(vec3(0.87), value < 0.0 ? vec3(0.17, 0.38, 0.74) : vec3(0.78, 0.23, 0.19), x);
  }

  // From pale to dark.
  vec3 rising(float x) {
    x = clamp(x, 0.0, 1.0);
    vec3 low = vec3(0.95, 0.94, 0.86), middle = vec3(0.93, 0.6, 0.25), high = vec3(0.55, 0.1, 0.25);
    return x < 0.5 ? mix(low, middle, 2.0 * x) : mix(middle, high, 2.0 * x - 1.0);
  }

  // How much of a pixel lines at whole numbers of x cover; they fade where they lie closer than 14 pixels, and are gone at 3.
  float lines(float x, float thickness) {
    float width = max(fwidth(x), 1e-6);
    float near = abs(fract(x - 0.5) - 0.5) / width;
    return (1.0 - smoothstep(0.3 * thickness, 0.3 * thickness + 0.8, near)) * (1.0 - smoothstep(0.07, 0.33, width));
  }

  // Stripes of a striped environment: lines where the reflected ray meets bands of equal angles.
  vec3 zebra(vec3 n, vec3 v) {
    float stripe = sin(6.2831853 * asin(clamp(dot(reflect(-v, n), stripeAxis), -1.0, 1.0)) / stripePeriod);
    float width = max(fwidth(stripe), 1e-4);
    return mix(vec3(0.02), vec3(0.9), smoothstep(-width, width, stripe)) * (0.75 + 0.25 * n.z);
  }

  // Where the normal points at one of the straight lamps that lie in parallel, far away, at equal angles; none is straight
  // above, as all of a level face would be lit.
  vec3 highlights(vec3 shade) {
    vec3 n = gl_FrontFacing ? vSceneNormal : -vSceneNormal;
    float angle = atan(dot(n, stripeAxis), n.z);
    return mix(0.3 * shade, vec3(1.0, 0.93, 0.7), lines(angle / stripePeriod + 0.5, 3.0));
  }

  void main() {
    if (hidden(vPlace)) discard;
    vec3 n = normalize(vNormal);
    if (!gl_FrontFacing) n = -n;
    vec3 v = normalize(vView);
    vec3 base = gl_FrontFacing != flipped ? front : back;
    // The legend shows the output of this, after the conversion to the screen's colours.
    bool valued = vValue > -1e20; // what has none holds -1e30 (studio_picture.hpp)
    if (mode == 2 && valued) base = pow(diverging(vValue), vec3(2.2));
    if (mode == 3 && valued) base = pow(rising((vValue - limits.x) / (limits.y - limits.x)), vec3(2.2));
    if (mode == 1) {
      gl_FragColor = vec4(zebra(n, v), 1.0);
    } else if (mode == 4) {
      gl_FragColor = vec4(highlights(base * texture2D(look, 0.5 + 0.496 * n.xy).rgb), 1.0);
    } else {
      vec3 seen = mirrors ? normalize(reflect(-v, n) + vec3(0.0, 0.0, 1.0001)) : n;
      vec4 light = texture2D(look, 0.5 + 0.496 * seen.xy);
      vec3 colour = base * light.rgb;
      if (mode == 0) colour += light.a;
      else colour = mix(colour, base, 0.6);
      float stands = texture2D(relief, gl_FragCoord.xy / reliefSize).r - 0.502;
      colour *= 1.0 + reliefStrength * stands;
      gl_FragColor = vec4(mix(vec3(dot(colour, vec3(0.3, 0.5, 0.2))) * 0.85, colour, selected), 1.0);
    }
    if (isocurveColour.a > 0.0) gl_FragColor.rgb = mix(gl_FragColor.rgb, isocurveColour.rgb, isocurveColour.a * max(lines(vIsocurve.x, 1.0), lines(vIsocurve.y, 1.0)));
    if (sections.w > 0.0) {
      float x = dot(vScene, sections.xyz) * sections.w + sectionOffset;
      gl_FragColor.rgb = mix(gl_FragColor.rgb, sectionColour, lines(x, 2.5));
    }
    // Frozen spans are hatched, painted ones tinted.
    vec3 marked = texture2D(marks, vSpan).rgb;
    gl_FragColor.rgb = mix(gl_FragColor.rgb, vec3(0.75, 0.4, 0.08), 0.6 * marked.b);
    float hatch = smoothstep(0.5, 0.75, abs(fract((gl_FragCoord.x + gl_FragCoord.y) / 10.0) * 2.0 - 1.0));
    vec3 ice = vec3(0.05, 0.2, 0.55);
    gl_FragColor.rgb = mix(gl_FragColor.rgb, ice, marked.r > 0.5 ? 0.25 + 0.55 * hatch : 0.0);
    if (marked.g > 0.1) gl_FragColor.rgb = mix(gl_FragColor.rgb, marked.g > 0.8 ? accent : vec3(0.9), 0.55);
    #include <colorspace_fragment>
  }`;

/** Only how far away it is: for `Relief`. */
export const depthShaders = {
  vertexShader: /* glsl */ `
    varying vec2 vPlace;
    void main() {
      vPlace = uv;
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    }`,
  fragmentShader: /* glsl */ `
    varying vec2 vPlace;
    ${trimGlsl}
    void main() {
      if (hidden(vPlace)) discard;
      gl_FragColor = vec4(1.0);
    }`,
};
