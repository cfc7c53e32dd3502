// Draws what html_of of _display.py lists: surfaces as grids of points, curves as lines; dragging turns, the wheel zooms.
function show(data) {
  const canvas = document.querySelector('canvas');
  const gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
  document.querySelector('#caption').textContent = data.caption;
  if (!gl) {
    canvas.outerHTML = document.querySelector('noscript').textContent;
    return;
  }
  if (data.most > 0) {
    const number = data.most.toPrecision(3) + ' ' + data.unit;
    const bar = 'width:14px;height:120px;background:linear-gradient(#c02020,#d8d8d8,#2040c0)';
    document.querySelector('#legend').innerHTML = '<div></div><div style="' + bar + '"></div><div></div>';
    const ends = document.querySelectorAll('#legend div');
    ends[0].textContent = 'moved +' + number;
    ends[2].textContent = '−' + number;
  }
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const compile = (kind, source) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, '#version 300 es\nprecision highp float;\n' + source);
    gl.compileShader(shader);
    return shader;
  };
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER,
    'in vec3 place; in float value; uniform mat3 turn; uniform vec2 zoom; out vec3 at; out float moved;' +
    'void main() { at = turn * place; moved = value; gl_Position = vec4(at.xy * zoom, at.z * 0.2, 1.0); }'));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER,
    'in vec3 at; in float moved; uniform bool line; out vec4 colour; void main() {' +
    'vec3 n = normalize(cross(dFdx(at), dFdy(at))); float light = line ? 0.3 : 0.35 + 0.65 * abs(n.z);' +
    'vec3 end = moved > 0.0 ? vec3(0.75, 0.13, 0.13) : vec3(0.13, 0.25, 0.75);' +
    'colour = vec4(light * mix(vec3(0.85), end, min(abs(moved), 1.0)), 1.0); }'));
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  const buffer = (kind, content) => {
    gl.bindBuffer(kind, gl.createBuffer());
    gl.bufferData(kind, content, gl.STATIC_DRAW);
  };
  const drawn = data.parts.map((part) => {
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    for (const [name, size, type, content] of [['place', 3, gl.SHORT, part.points], ['value', 1, gl.BYTE, part.values]]) {
      buffer(gl.ARRAY_BUFFER, bytes(content));
      const location = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, type, true, 0, 0);
    }
    const [m, n] = part.shape;
    if (n === undefined) return { array, mode: gl.LINE_STRIP, count: m };
    const indices = [];
    for (let i = 0; i + 1 < m; ++i) {
      for (let j = 0; j + 1 < n; ++j) {
        const a = i * n + j;
        indices.push(a, a + n, a + 1, a + 1, a + n, a + n + 1);
      }
    }
    buffer(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(indices));
    return { array, mode: gl.TRIANGLES, count: indices.length };
  });
  let around = 0.6, above = 0.9, zoom = 0.95;
  const draw = () => {
    const width = (canvas.width = canvas.clientWidth * devicePixelRatio);
    const height = (canvas.height = canvas.clientHeight * devicePixelRatio);
    gl.viewport(0, 0, width, height);
    gl.clearColor(1, 1, 1, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const [c, s, d, t] = [Math.cos(around), Math.sin(around), Math.cos(above), Math.sin(above)];
    gl.uniformMatrix3fv(gl.getUniformLocation(program, 'turn'), false, [c, s * d, s * t, -s, c * d, c * t, 0, t, -d]);
    gl.uniform2f(gl.getUniformLocation(program, 'zoom'), zoom * Math.min(1, height / width), zoom * Math.min(1, width / height));
    for (const { array, mode, count } of drawn) {
      gl.bindVertexArray(array);
      gl.uniform1i(gl.getUniformLocation(program, 'line'), mode === gl.LINE_STRIP);
      if (mode === gl.LINE_STRIP) gl.drawArrays(mode, 0, count);
      else gl.drawElements(mode, count, gl.UNSIGNED_INT, 0);
    }
  };
  canvas.onpointerdown = (event) => canvas.setPointerCapture(event.pointerId);
  canvas.onpointermove = (event) => {
    if (!event.buttons) return;
    around += event.movementX / 150;
    above = Math.max(0, Math.min(Math.PI, above + event.movementY / 150));
    draw();
  };
  canvas.onwheel = (event) => {
    event.preventDefault();
    zoom *= Math.exp(-event.deltaY / 800);
    draw();
  };
  addEventListener('resize', draw);
  draw();
}
