// The picture of the body, drawn with WebGL2: a parallel projection, coloured triangles whose corners look up positions and
// values in textures, and strokes that are made anew when the view turns.
const VERTEX = `#version 300 es
precision highp float; precision highp int; precision highp sampler2D;
layout(location = 0) in uint node; layout(location = 1) in uint cell; layout(location = 2) in vec3 point; layout(location = 3) in float own;
uniform sampler2D here, moved, values;
uniform float factor, lift, dot_size; uniform mat3 turn; uniform vec3 centre, scale; uniform int by_cell, loose;
out vec3 eye, world; out float value;
vec4 at(sampler2D list, uint i) { return texelFetch(list, ivec2(int(i & 1023u), int(i >> 10u)), 0); }
void main() {
  world = loose == 1 ? point : at(here, node).xyz + factor * at(moved, node).xyz;
  value = loose == 1 ? own : at(values, by_cell == 1 ? cell : node).x;
  eye = turn * (world - centre);
  gl_Position = vec4(eye * scale, 1.0); gl_Position.z -= lift; gl_PointSize = dot_size;
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 eye, world; in float value; out vec4 color;
uniform vec4 cut, paint; uniform vec2 range; uniform float bands; uniform int lit, painted; uniform sampler2D colors;
void main() {
  if (dot(world, cut.xyz) > cut.w) discard;
  vec3 k = paint.rgb;
  if (painted == 0) {
    float t = clamp((value - range.x) / max(range.y - range.x, 1e-37), 0.0, 1.0);
    if (bands > 0.0) t = (min(floor(t * bands), bands - 1.0) + 0.5) / bands;
    k = abs(value) < 1e37 ? texture(colors, vec2(t, 0.5)).rgb : vec3(0.62);
  }
  if (lit == 1) { vec3 n = normalize(cross(dFdx(eye), dFdy(eye))); k *= 0.5 + 0.55 * abs(dot(n, vec3(0.24, 0.32, 0.917))); }
  color = vec4(k, painted == 1 ? paint.a : 1.0);
}`;
const SIDES = { corner: [[0.8, 0, -0.6], [-0.3, 0.866, -0.4], [0.52, 0.5, 0.693]], x: [[0, 1, 0], [0, 0, 1], [1, 0, 0]], y: [[1, 0, 0], [0, 0, -1], [0, 1, 0]], z: [[1, 0, 0], [0, 1, 0], [0, 0, 1]] };
const LONGEST = 0.3, TYPICAL = 0.07;
const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross3 = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit3 = (a) => { const l = Math.hypot(...a) || 1; return a.map((x) => x / l); };
const rgb = (text) => { const n = parseInt(text.replace('#', ''), 16); return [n >> 16 & 255, n >> 8 & 255, n & 255].map((x) => x / 255); };

class View {
  constructor(scene, canvas, overlay) {
    Object.assign(this, { scene, canvas, overlay, frame: 0, factor: 1, bands: 0, mesh: true, vectors: true, stretch: 1, showTools: true, clip: null, picked: null, mark: null, range: [0, 1] });
    const gl = canvas.getContext('webgl2', { alpha: false, antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error('this browser has no WebGL2');
    this.gl = gl;
    this.rows = scene.plane ? SIDES.z : SIDES.corner;
    this.centre = [0, 0, 0];
    this.half = scene.size;
    this.draw = gathered(() => this.paint());
    this.setUp();
    new ResizeObserver(() => this.draw()).observe(canvas);
    onColors.push(() => this.draw());
  }

  setUp() {
    const { gl, scene } = this;
    const shader = (kind, source) => {
      const made = gl.createShader(kind);
      gl.shaderSource(made, source); gl.compileShader(made);
      if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made));
      return made;
    };
    const program = gl.createProgram();
    gl.attachShader(program, shader(gl.VERTEX_SHADER, VERTEX)); gl.attachShader(program, shader(gl.FRAGMENT_SHADER, FRAGMENT));
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    this.at = Object.fromEntries(['here', 'moved', 'values', 'colors', 'factor', 'lift', 'dot_size', 'turn', 'centre', 'scale', 'by_cell', 'loose', 'cut', 'paint', 'range', 'bands', 'lit', 'painted'].map((name) => [name, gl.getUniformLocation(program, name)]));
    ['here', 'moved', 'values', 'colors'].forEach((name, unit) => { gl.uniform1i(this.at[name], unit); });
    this.textures = [0, 1, 2, 3].map(() => gl.createTexture());
    this.textures.forEach((texture, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit); gl.bindTexture(gl.TEXTURE_2D, texture);
      const filter = unit === 3 ? gl.LINEAR : gl.NEAREST;
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter); gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE); gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    });
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    // What an array does not give is still of the type that the shader reads.
    [0, 1].forEach((location) => gl.vertexAttribI4ui(location, 0, 0, 0, 0));
    const colors = new Uint8Array(DATA.colors.flatMap((color) => [...rgb(color).map((x) => 255 * x), 255]));
    gl.activeTexture(gl.TEXTURE3); gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, DATA.colors.length, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, colors);
    const list = (nodes, cells) => {
      const array = gl.createVertexArray();
      gl.bindVertexArray(array);
      [nodes, cells].forEach((data, location) => {
        if (!data) return;
        gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer()); gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
        gl.enableVertexAttribArray(location); gl.vertexAttribIPointer(location, 1, gl.UNSIGNED_INT, 0, 0);
      });
      return array;
    };
    const cells = new Uint32Array(scene.triangles.length);
    for (let i = 0; i < cells.length; i++) cells[i] = scene.triangleCells[Math.floor(i / 3)];
    this.faces = list(new Uint32Array(scene.triangles), cells);
    this.lines = list(new Uint32Array(scene.edges));
    this.looseArray = gl.createVertexArray();
    gl.bindVertexArray(this.looseArray);
    this.looseBuffers = [[2, 3], [3, 1]].map(([location, size]) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer); gl.enableVertexAttribArray(location); gl.vertexAttribPointer(location, size, gl.FLOAT, false, 0, 0);
      return buffer;
    });
    const reference = scene.points.reference.slice(0, 3 * scene.points.counts[0]);
    for (let i = 0; i < reference.length; i++) reference[i] -= scene.middle[i % 3];
    this.upload(0, reference, 3);
  }

  /** Lays a list of values into a texture of 1024 columns. */
  upload(unit, data, width) {
    const { gl } = this, rows = Math.max(1, Math.ceil(data.length / width / 1024));
    const full = new Float32Array(1024 * rows * width);
    for (let i = 0; i < data.length; i++) full[i] = Number.isFinite(data[i]) ? data[i] : 3e38;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.texImage2D(gl.TEXTURE_2D, 0, width === 3 ? gl.RGB32F : gl.R32F, 1024, rows, 0, width === 3 ? gl.RGB : gl.RED, gl.FLOAT, full);
  }

  /** Takes up a frame, and the values of a field: `{ values, counts, starts }`. */
  setFrame(frame, field, list) {
    const { scene } = this;
    Object.assign(this, { frame, field });
    const [first, count] = scene.span(scene.points, frame);
    this.upload(1, scene.points.displacement.subarray(3 * first, 3 * (first + count)), 3);
    this.now = list.values.subarray(list.starts[frame], list.starts[frame] + list.counts[frame]);
    this.upload(2, field.where === 'contact' ? new Float32Array(1) : this.now, 1);
    this.cutKey = undefined;
    this.draw();
  }

  /** The positions of the nodes as they are drawn. */
  nodes() { return this.scene.positions(this.scene.points, this.frame, this.factor); }

  eye(p) { const q = p.map((x, a) => x - this.centre[a]); return this.rows.map((row) => dot3(row, q)); }
  pixel() { return 2 * this.half / Math.max(this.canvas.clientHeight, 1); }
  screen(p) {
    const e = this.eye(p), size = this.pixel();
    return [this.canvas.clientWidth / 2 + e[0] / size, this.canvas.clientHeight / 2 - e[1] / size, e[2]];
  }

  /** Shows all nodes, in the frames that there are, and the arrows of this frame. */
  fit() {
    const { scene } = this, low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const few = scene.frames * scene.points.counts[0] > 2e6 ? [0, this.frame, scene.frames - 1] : [...Array(scene.frames).keys()];
    const lists = few.map((frame) => scene.positions(scene.points, frame, this.factor));
    if (this.vectors && this.now) lists.push(this.arrows().flatMap(([tail]) => tail));
    for (const p of lists) {
      for (let i = 0; i < p.length; i += 3) {
        for (let a = 0; a < 3; a++) {
          const e = this.rows[a][0] * p[i] + this.rows[a][1] * p[i + 1] + this.rows[a][2] * p[i + 2];
          if (e < low[a]) low[a] = e;
          if (e > high[a]) high[a] = e;
        }
      }
    }
    const mean = low.map((x, a) => 0.5 * (x + high[a]));
    this.centre = [0, 1, 2].map((c) => mean[0] * this.rows[0][c] + mean[1] * this.rows[1][c] + mean[2] * this.rows[2][c]);
    const ratio = Math.max(this.canvas.clientWidth - 70, 50) / Math.max(this.canvas.clientHeight, 50);
    this.half = Math.max(0.56 * (high[1] - low[1]), 0.56 * (high[0] - low[0]) / ratio, 1e-6 * scene.size);
    this.draw();
  }

  side(name) { this.rows = SIDES[name]; this.fit(); }

  /** Turns by angles about the axes of the screen. */
  turn(across, down) {
    if (this.scene.plane) return;
    const spin = (rows, i, j, angle) => {
      const [c, s] = [Math.cos(angle), Math.sin(angle)], out = rows.map((row) => [...row]);
      for (let a = 0; a < 3; a++) { out[i][a] = c * rows[i][a] - s * rows[j][a]; out[j][a] = s * rows[i][a] + c * rows[j][a]; }
      return out;
    };
    const z = unit3(spin(spin(this.rows, 2, 0, -across), 1, 2, down)[2]);
    const rows = spin(spin(this.rows, 2, 0, -across), 1, 2, down), x = unit3(rows[0].map((v, a) => v - dot3(rows[0], z) * z[a]));
    this.rows = [x, cross3(z, x), z];
    this.draw();
  }

  move(dx, dy) {
    const size = this.pixel();
    this.centre = this.centre.map((x, a) => x - dx * size * this.rows[0][a] + dy * size * this.rows[1][a]);
    this.draw();
  }

  zoom(factor, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2) {
    const next = clamp(this.half * factor, 1e-5 * this.scene.size, 50 * this.scene.size), part = 1 - next / this.half;
    const px = x - this.canvas.clientWidth / 2, py = y - this.canvas.clientHeight / 2;
    this.move(-px * part, -py * part);
    this.half = next;
    this.draw();
  }

  /** Brings a point into the middle, so near that `part` of the body's size is seen. */
  goTo(p, part = 0.2) {
    this.centre = [...p];
    this.half = Math.min(this.half, 0.5 * part * this.scene.size);
    this.draw();
  }

  /** The plane of the cut: what is beyond it is not drawn. */
  plane() {
    if (!this.clip) return [0, 0, 0, 1];
    const a = 'xyz'.indexOf(this.clip.axis), p = this.nodes();
    let [low, high] = [Infinity, -Infinity];
    for (let i = a; i < p.length; i += 3) { low = Math.min(low, p[i]); high = Math.max(high, p[i]); }
    const at = low + (high - low) * this.clip.at, sign = this.clip.flip ? -1 : 1, out = [0, 0, 0, sign * at];
    out[a] = sign;
    return out;
  }

  /** Triangles where the plane cuts the solid cells, with their values. */
  section(cut) {
    const { scene } = this, list = scene.tetrahedra;
    if (!list || this.field.where === 'contact') return null;
    const p = this.nodes(), count = p.length / 3, far = new Float32Array(count), points = [], values = [];
    for (let i = 0; i < count; i++) far[i] = cut[0] * p[3 * i] + cut[1] * p[3 * i + 1] + cut[2] * p[3 * i + 2] - cut[3];
    const byCell = this.field.where === 'cell';
    for (let t = 0; t < list.length; t += 4) {
      const inside = [], outside = [];
      for (let k = 0; k < 4; k++) (far[list[t + k]] <= 0 ? inside : outside).push(list[t + k]);
      if (!inside.length || !outside.length) continue;
      const own = byCell ? this.now[scene.tetrahedronCells[t / 4]] : 0;
      const between = (i, j) => {
        const w = far[i] / (far[i] - far[j]);
        for (let a = 0; a < 3; a++) points.push(p[3 * i + a] + w * (p[3 * j + a] - p[3 * i + a]));
        values.push(byCell ? own : this.now[i] + w * (this.now[j] - this.now[i]));
      };
      if (inside.length === 2) {
        const [a, b] = inside, [c, d] = outside;
        [[a, c], [a, d], [b, d], [a, c], [b, d], [b, c]].forEach(([i, j]) => between(i, j));
      } else {
        const [one, rest] = inside.length === 1 ? [inside[0], outside] : [outside[0], inside];
        rest.forEach((other) => between(one, other));
      }
    }
    return { points: new Float32Array(points), values: new Float32Array(values).map((x) => (Number.isFinite(x) ? x : 3e38)) };
  }

  /** Segments as strips of so many pixels that face the eye. */
  strokes(segments, width) {
    const out = new Float32Array(segments.length * 18), reach = 0.5 * width * this.pixel(), w = this.rows[2];
    segments.forEach(([a, b], i) => {
      const side = unit3(cross3([b[0] - a[0], b[1] - a[1], b[2] - a[2]], w)).map((x) => x * reach);
      [[a, 1], [b, 1], [b, -1], [a, 1], [b, -1], [a, -1]].forEach(([p, sign], k) => { for (let c = 0; c < 3; c++) out[18 * i + 3 * k + c] = p[c] + sign * side[c]; });
    });
    return out;
  }

  /** Lengths of space a unit of contact stress. */
  arrowScale() {
    const t = this.scene.traction;
    if (this.unitArrow === undefined && t) {
      const sizes = [];
      for (let i = 0; i < t.length; i += 3) { const size = Math.hypot(t[i], t[i + 1], t[i + 2]); if (size > 0) sizes.push(size); }
      sizes.sort((a, b) => a - b);
      this.unitArrow = sizes.length ? this.scene.size * Math.min(LONGEST / sizes[sizes.length - 1], TYPICAL / sizes[sizes.length >> 1]) : 0;
    }
    return (this.unitArrow || 0) * this.stretch;
  }

  arrows() {
    const { scene } = this, out = [];
    if (!scene.traction || !scene.contacts) return out;
    const [first, count] = scene.span(scene.contacts, this.frame), p = scene.positions(scene.contacts, this.frame, this.factor), scale = this.arrowScale();
    for (let i = 0; i < count; i++) {
      const t = [0, 1, 2].map((a) => scene.traction[3 * (first + i) + a]), size = Math.hypot(...t) * scale;
      if (!(size > 0)) continue;
      const tip = [p[3 * i], p[3 * i + 1], p[3 * i + 2]], d = unit3(t), head = Math.min(0.4 * size, 7 * this.pixel()), side = unit3(cross3(d, this.rows[2]));
      out.push([tip.map((x, a) => x - size * d[a]), tip]);
      [0.45, -0.45].forEach((s) => out.push([tip, tip.map((x, a) => x - head * (d[a] + s * side[a]))]));
    }
    return out;
  }

  loose(kind, points, values, options) {
    const { gl, at } = this;
    gl.bindVertexArray(this.looseArray);
    [points, values || new Float32Array(points.length / 3)].forEach((data, i) => { gl.bindBuffer(gl.ARRAY_BUFFER, this.looseBuffers[i]); gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW); });
    gl.uniform1i(at.loose, 1);
    this.style(options);
    gl.drawArrays(kind, 0, points.length / 3);
    gl.uniform1i(at.loose, 0);
  }

  style({ color = null, alpha = 1, lit = 0, lift = 0 }) {
    const { gl, at } = this;
    gl.uniform1i(at.painted, color ? 1 : 0);
    if (color) gl.uniform4f(at.paint, ...color, alpha);
    gl.uniform1i(at.lit, lit); gl.uniform1f(at.lift, lift);
  }

  paint() {
    const { gl, at, scene, canvas } = this;
    if (!canvas.clientWidth || !this.now) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2), [w, h] = [canvas.clientWidth, canvas.clientHeight].map((x) => Math.round(x * ratio));
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
    gl.viewport(0, 0, w, h);
    const back = rgb(styleColor('--stage')), ink = rgb(styleColor('--ink')), solid = scene.plane ? 0 : 1;
    gl.clearColor(...back, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.depthFunc(gl.LEQUAL);
    const scale = [canvas.clientHeight / canvas.clientWidth / this.half, 1 / this.half, -1 / (12 * scene.size + 12 * this.half)];
    gl.uniformMatrix3fv(at.turn, false, [0, 1, 2].flatMap((c) => this.rows.map((row) => row[c])));
    gl.uniform3f(at.centre, ...this.centre); gl.uniform3f(at.scale, ...scale);
    gl.uniform1f(at.factor, this.factor); gl.uniform1f(at.bands, this.bands); gl.uniform2f(at.range, ...this.range);
    gl.uniform1i(at.by_cell, this.field.where === 'cell' ? 1 : 0); gl.uniform1f(at.dot_size, 5 * ratio);
    // The cut is made anew when it or what it cuts has changed, not when the view turns.
    const key = this.clip && `${this.clip.axis} ${this.clip.at} ${this.clip.flip} ${this.factor}`;
    if (this.cutKey !== key) {
      this.cutPlane = this.plane();
      this.cutTriangles = this.clip && this.section(this.cutPlane);
      this.cutKey = key;
    }
    const cut = this.cutPlane;
    gl.uniform4f(at.cut, ...cut);
    const contact = this.field.where === 'contact', grey = rgb(styleColor('--solid'));
    gl.bindVertexArray(this.faces);
    gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(1, 1);
    this.style({ color: contact ? grey : null, lit: solid });
    gl.drawArrays(gl.TRIANGLES, 0, scene.triangles.length);
    if (this.clip) {
      gl.uniform4f(at.cut, 0, 0, 0, 1);
      if (this.cutTriangles) this.loose(gl.TRIANGLES, this.cutTriangles.points, this.cutTriangles.values, {});
      gl.uniform4f(at.cut, ...cut);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.bindVertexArray(this.lines);
    this.style({ color: ink.map((x, a) => (this.mesh ? 0.45 * x + 0.55 * back[a] : x)), lift: 2e-5 });
    gl.drawArrays(gl.LINES, 0, this.mesh ? scene.edges.length : 2 * scene.body.edge_count[1]);
    if (contact && scene.contacts) {
      this.loose(gl.POINTS, scene.positions(scene.contacts, this.frame, this.factor), this.now.map((x) => (Number.isFinite(x) ? x : 3e38)), { lift: 4e-4 });
    }
    gl.uniform4f(at.cut, 0, 0, 0, 1);
    if (this.vectors) this.loose(gl.TRIANGLES, this.strokes(this.arrows(), 1.7), null, { color: rgb(styleColor('--arrow')), lift: scene.plane ? 1e-3 : 1e-4 });
    if (this.showTools && scene.tools) this.paintTools(rgb(styleColor('--tool')));
    this.label(ratio);
  }

  paintTools(color) {
    const { gl, scene } = this, p = scene.positions(scene.tools, this.frame, this.factor);
    const point = (i) => [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
    if (scene.toolLines.length) {
      const segments = [];
      for (let i = 0; i < scene.toolLines.length; i += 2) segments.push([point(scene.toolLines[i]), point(scene.toolLines[i + 1])]);
      this.loose(gl.TRIANGLES, this.strokes(segments, 2.5), null, { color, lift: scene.plane ? 5e-4 : 1e-4 });
    }
    if (scene.toolTriangles.length) {
      const list = new Float32Array(3 * scene.toolTriangles.length);
      scene.toolTriangles.forEach((node, i) => { for (let a = 0; a < 3; a++) list[3 * i + a] = p[3 * node + a]; });
      gl.enable(gl.BLEND); gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA); gl.depthMask(false);
      this.loose(gl.TRIANGLES, list, null, { color, alpha: 0.22, lit: 1 });
      gl.disable(gl.BLEND); gl.depthMask(true);
    }
  }

  /** What is written over the picture: axes, lengths, the picked node and the place that was asked for. */
  label() {
    const { overlay, canvas, scene } = this, [w, h] = [canvas.clientWidth, canvas.clientHeight], parts = [];
    overlay.setAttribute('viewBox', `0 0 ${w} ${h}`);
    const names = DATA.space === 'axisymmetric' ? ['r', 'z', ''] : ['x', 'y', 'z'];
    names.forEach((name, a) => {
      const [dx, dy] = [this.rows[0][a], this.rows[1][a]];
      if (!name || Math.hypot(dx, dy) < 0.1) return;
      parts.push(element('line', { x1: 44, y1: h - 44, x2: 44 + 28 * dx, y2: h - 44 - 28 * dy }), element('text', { x: 44 + 37 * dx, y: h - 40 - 37 * dy, 'text-anchor': 'middle' }, name));
    });
    const bar = ticks(0, 130 * this.pixel(), 4).pop(), long = bar / this.pixel();
    if (long > 5) parts.push(element('path', { d: `M100 ${h - 26}v6h${long}v-6` }), element('text', { x: 100 + long / 2, y: h - 26, 'text-anchor': 'middle' }, shown(bar)));
    const scale = this.arrowScale();
    if (this.vectors && scale > 0) {
      const stress = ticks(0, 110 * this.pixel() / scale, 4).pop(), px = stress * scale / this.pixel();
      if (px > 5) parts.push(element('path', { d: `M${120 + long} ${h - 20}h${px}m-6 -3l6 3l-6 3`, class: 'arrow' }), element('text', { x: 120 + long + px / 2, y: h - 26, 'text-anchor': 'middle' }, `stress ${shown(stress)}`));
    }
    const ring = (p, kind) => { const [x, y] = this.screen(p); parts.push(element('circle', { cx: x, cy: y, r: 7, class: kind })); };
    if (this.picked !== null) ring(this.nodeAt(this.picked), 'picked');
    if (this.mark) ring(this.mark, 'mark');
    overlay.replaceChildren(...parts);
  }

  nodeAt(place) {
    const { scene } = this, first = scene.points.starts[this.frame], own = scene.points.still ? 0 : first;
    return [0, 1, 2].map((a) => scene.points.reference[3 * (own + place) + a] - scene.middle[a] + this.factor * scene.points.displacement[3 * (first + place) + a]);
  }

  /** The node nearest to a place of the picture, of the triangle that is seen there. */
  pick(x, y) {
    const { scene } = this, p = this.nodes(), flat = new Float32Array(p.length), cut = this.plane();
    for (let i = 0; i < p.length; i += 3) flat.set(this.screen([p[i], p[i + 1], p[i + 2]]), i);
    const off = (i) => cut[0] * p[3 * i] + cut[1] * p[3 * i + 1] + cut[2] * p[3 * i + 2] > cut[3];
    let best = null, depth = -Infinity;
    for (let t = 0; t < scene.triangles.length; t += 3) {
      const nodes = [scene.triangles[t], scene.triangles[t + 1], scene.triangles[t + 2]], [a, b, c] = nodes.map((n) => [flat[3 * n], flat[3 * n + 1], flat[3 * n + 2]]);
      if (this.clip && nodes.every(off)) continue;
      const area = (p0, p1, q) => (p1[0] - p0[0]) * (q[1] - p0[1]) - (p1[1] - p0[1]) * (q[0] - p0[0]), all = area(a, b, c);
      if (!all) continue;
      const parts = [area(b, c, [x, y]), area(c, a, [x, y]), area(a, b, [x, y])].map((part) => part / all);
      if (Math.min(...parts) < 0) continue;
      const z = parts[0] * a[2] + parts[1] * b[2] + parts[2] * c[2];
      if (z > depth) { depth = z; best = nodes[parts.indexOf(Math.max(...parts))]; }
    }
    return best;
  }
}
