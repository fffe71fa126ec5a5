/* A small viewer: bodies hang on each other by joints, sliders move them, WebGL draws them. Nothing is loaded. */

const M = {
  mul(a, b) {  // 4x4, row-major
    const c = new Float64Array(16);
    for (let i = 0; i < 4; i++) for (let j = 0; j < 4; j++)
      c[4 * i + j] = a[4 * i] * b[j] + a[4 * i + 1] * b[4 + j] + a[4 * i + 2] * b[8 + j] + a[4 * i + 3] * b[12 + j];
    return c;
  },
  motion(joint, q) {
    const [x, y, z] = joint.axis;
    if (joint.kind === 'prismatic') return [1, 0, 0, q * x, 0, 1, 0, q * y, 0, 0, 1, q * z, 0, 0, 0, 1];
    const c = Math.cos(q), s = Math.sin(q), v = 1 - c;
    return [c + x * x * v, x * y * v - z * s, x * z * v + y * s, 0, y * x * v + z * s, c + y * y * v, y * z * v - x * s, 0,
      z * x * v - y * s, z * y * v + x * s, c + z * z * v, 0, 0, 0, 0, 1];
  },
  columns(m) { const t = new Float32Array(16); for (let i = 0; i < 16; i++) t[i] = m[4 * (i % 4) + (i >> 2)]; return t; },
};

function bytes(text) {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
  return out.buffer;
}

/* Corners of every triangle with its normal: flat faces look right and need no welding. */
function triangles(body) {
  const points = new Uint16Array(bytes(body.v)), faces = body.wide ? new Uint32Array(bytes(body.f)) : new Uint16Array(bytes(body.f));
  const out = new Float32Array(faces.length * 6), p = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  for (let f = 0; f < faces.length; f += 3) {
    for (let k = 0; k < 3; k++) for (let a = 0; a < 3; a++) p[k][a] = body.lo[a] + body.step[a] * points[3 * faces[f + k] + a];
    const u = p[1].map((v, a) => v - p[0][a]), w = p[2].map((v, a) => v - p[0][a]);
    const n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
    const l = Math.hypot(...n) || 1;
    for (let k = 0; k < 3; k++) out.set([...p[k], n[0] / l, n[1] / l, n[2] / l], 6 * (f + k));
  }
  return out;
}

const VERTEX = 'attribute vec3 p; attribute vec3 n; uniform mat4 pose, view; varying vec3 normal, place;' +
  'void main() { normal = mat3(pose) * n; vec4 w = pose * vec4(p, 1.0); place = w.xyz; gl_Position = view * w; }';
const FRAGMENT = 'precision mediump float; varying vec3 normal, place; uniform vec3 color, eye; uniform float flat_;' +
  'void main() { if (flat_ > 0.5) { gl_FragColor = vec4(color, 1.0); return; } vec3 to = normalize(eye - place);' +
  'vec3 n = normalize(normal); float facing = abs(dot(n, to)); float sky = 0.5 + 0.5 * n.z * sign(dot(n, to));' +
  'gl_FragColor = vec4(color * (0.35 + 0.45 * facing + 0.25 * sky), 1.0); }';

function program(gl) {
  const made = gl.createProgram();
  for (const [kind, code] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, code);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  return made;
}

class Viewer {
  constructor(root) {
    this.root = root;
    this.canvas = root.querySelector('canvas');
    this.scene = JSON.parse(document.getElementById(root.dataset.scene).textContent);
    this.joints = Object.fromEntries(this.scene.joints.map(j => [j.name, j]));
    this.q = Object.fromEntries(this.scene.joints.map(j => [j.name, j.rest]));
    this.home();
    this.marked = new Set(); this.selected = null; this.playing = null;
    this.gl = this.canvas.getContext('webgl', { antialias: true, preserveDrawingBuffer: true });
    if (!this.gl) {
      root.querySelector('.status').textContent = 'This browser draws no WebGL; the picture below shows the object.';
      return;
    }
    this.upload();
    this.bind();
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
    this.draw();
    root.dataset.ready = 'yes';
  }

  upload() {
    const gl = this.gl;
    this.program = program(gl);
    this.meshes = this.scene.bodies.map(body => {
      if (!body.f) return null;
      const data = triangles(body), buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      return { buffer, count: data.length / 6 };
    });
    this.line = gl.createBuffer();
  }

  bind() {
    const canvas = this.canvas;
    this.sliders = [...this.root.querySelectorAll('input[type=range]')];
    for (const slider of this.sliders) {
      slider.addEventListener('input', () => { this.stop(); this.set(slider.dataset.joint, +slider.value); });
      slider.addEventListener('focus', () => { this.selected = slider.dataset.joint; this.draw(); });
    }
    for (const button of this.root.querySelectorAll('button[data-play]'))
      button.addEventListener('click', () => this.play(button.dataset.play));
    this.root.querySelector('button[data-reset]').addEventListener('click', () => this.reset());
    let last = null;
    canvas.addEventListener('pointerdown', e => { last = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); });
    canvas.addEventListener('pointerup', () => { last = null; });
    canvas.addEventListener('pointermove', e => {
      if (!last) return;
      const dx = e.clientX - last[0], dy = e.clientY - last[1];
      last = [e.clientX, e.clientY];
      if (e.shiftKey || e.buttons & 2) this.pan(dx, dy); else this.orbit(-dx / 150, dy / 150);
    });
    canvas.addEventListener('contextmenu', e => e.preventDefault());
    canvas.addEventListener('wheel', e => { e.preventDefault(); this.zoom(Math.exp(e.deltaY / 800)); }, { passive: false });
    canvas.addEventListener('keydown', e => {
      const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[e.key];
      if (step) this.orbit(...step);
      else if (e.key === '+' || e.key === '=') this.zoom(0.9);
      else if (e.key === '-') this.zoom(1.1);
      else if (e.key === '0') this.reset();
      else return;
      e.preventDefault();
    });
  }

  orbit(turn, lift) { this.turn += turn; this.lift = Math.max(-1.5, Math.min(1.5, this.lift + lift)); this.draw(); }
  zoom(factor) { this.far = Math.max(0.2, Math.min(6, this.far * factor / this.scene.size)) * this.scene.size; this.draw(); }
  pan(dx, dy) {
    const scale = this.far / this.canvas.clientHeight, [right, up] = this.axes();
    this.center = this.center.map((c, a) => c + scale * (dy * up[a] - dx * right[a]));
    this.draw();
  }

  set(name, value) {
    this.q[name] = value;
    this.selected = name;
    for (const slider of this.sliders) if (slider.dataset.joint === name) slider.value = value;
    this.draw();
  }
  show(q, links, joint = null) {
    this.stop();
    for (const joint of this.scene.joints) this.set(joint.name, joint.name in q ? q[joint.name] : joint.rest);
    const names = this.scene.joints.map(item => item.name);
    const moved = this.scene.bodies.filter(body => joint !== null && names[body.joint] === joint);
    this.marked = new Set([...links, ...moved.flatMap(body => body.links)]);
    this.selected = null;
    this.draw();
  }
  home() { this.turn = this.scene.turn; this.lift = 0.42; this.far = this.scene.size; this.center = [...this.scene.center]; }
  reset() { this.home(); this.show({}, []); }
  stop() {
    if (this.playing === null) return;
    cancelAnimationFrame(this.playing);
    this.playing = null;
    for (const button of this.root.querySelectorAll('button[data-play]')) button.setAttribute('aria-pressed', 'false');
  }
  play(name) {
    const was = this.playing !== null && this.sweeping === name;
    this.stop();
    if (was) return;
    this.sweeping = name;
    const button = [...this.root.querySelectorAll('button[data-play]')].find(b => b.dataset.play === name);
    button.setAttribute('aria-pressed', 'true');
    const joint = this.joints[name], start = performance.now();
    const tick = now => {
      const share = 0.5 - 0.5 * Math.cos((now - start) / 800);
      this.set(name, joint.lower + share * (joint.upper - joint.lower));
      this.playing = requestAnimationFrame(tick);
    };
    this.playing = requestAnimationFrame(tick);
  }

  value(joint) {
    return joint.mimic ? joint.mimic.multiplier * this.value(this.joints[joint.mimic.joint]) + joint.mimic.offset : this.q[joint.name];
  }
  poses() {
    const poses = [];
    for (const body of this.scene.bodies) {
      if (body.parent < 0) { poses.push(body.T); continue; }
      const joint = this.scene.joints[body.joint];
      poses.push(M.mul(M.mul(poses[body.parent], body.T), M.motion(joint, this.value(joint))));
    }
    return poses;
  }

  axes() {
    const ct = Math.cos(this.turn), st = Math.sin(this.turn), cl = Math.cos(this.lift), sl = Math.sin(this.lift);
    return [[-ct, -st, 0], [st * sl, -ct * sl, cl], [st * cl, -ct * cl, -sl].map(v => -v)];  // right, up, towards the eye
  }
  camera(aspect) {
    const [right, up, back] = this.axes(), eye = this.center.map((c, a) => c + this.far * 1.6 * back[a]);
    const row = v => [...v, -(v[0] * eye[0] + v[1] * eye[1] + v[2] * eye[2])];
    const near = 0.02 * this.far, end = 8 * this.far, f = 2.6, view = [...row(right), ...row(up), ...row(back), 0, 0, 0, 1];
    const lens = [f / Math.max(aspect, 1), 0, 0, 0, 0, f * Math.min(aspect, 1), 0, 0, 0, 0, (end + near) / (near - end), 2 * end * near / (near - end), 0, 0, -1, 0];
    if (aspect > 1) { lens[0] = f / aspect; lens[5] = f; }
    return [M.mul(lens, view), eye];
  }

  draw() {
    const gl = this.gl, canvas = this.canvas, ratio = devicePixelRatio || 1;
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const css = getComputedStyle(this.root), rgb = name => {
      const hex = css.getPropertyValue(name).trim().slice(1);
      return [0, 2, 4].map(k => parseInt(hex.slice(k, k + 2), 16) / 255);
    };
    gl.viewport(0, 0, width, height);
    gl.clearColor(...rgb('--card'), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.program);
    const at = name => gl.getUniformLocation(this.program, name), [view, eye] = this.camera(width / height), poses = this.poses();
    gl.uniformMatrix4fv(at('view'), false, M.columns(view));
    gl.uniform3fv(at('eye'), eye);
    gl.uniform1f(at('flat_'), 0);
    this.scene.bodies.forEach((body, k) => {
      const mesh = this.meshes[k];
      if (!mesh) return;
      gl.uniformMatrix4fv(at('pose'), false, M.columns(poses[k]));
      gl.uniform3fv(at('color'), body.links.some(link => this.marked.has(link)) ? rgb('--error') : body.color);
      this.attributes(mesh.buffer);
      gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
    });
    this.drawAxis(at, poses, rgb('--note'));
    this.tell();
  }
  attributes(buffer) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    for (const [name, offset] of [['p', 0], ['n', 12]]) {
      const place = gl.getAttribLocation(this.program, name);
      if (place < 0) continue;
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 24, offset);
    }
  }
  /* The axis of the joint that was moved last, seen through everything. */
  drawAxis(at, poses, color) {
    const k = this.scene.bodies.findIndex(body => body.joint >= 0 && this.scene.joints[body.joint].name === this.selected);
    if (k < 0) return;
    const gl = this.gl, half = 0.35 * this.scene.size, axis = this.scene.joints[this.scene.bodies[k].joint].axis;
    gl.disable(gl.DEPTH_TEST);
    gl.uniform1f(at('flat_'), 1);
    gl.uniform3fv(at('color'), color);
    gl.uniformMatrix4fv(at('pose'), false, M.columns(poses[k]));
    gl.bindBuffer(gl.ARRAY_BUFFER, this.line);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([...axis.map(v => -half * v), 0, 0, 1, ...axis.map(v => half * v), 0, 0, 1]), gl.DYNAMIC_DRAW);
    this.attributes(this.line);
    gl.drawArrays(gl.LINES, 0, 2);
  }
  tell() {
    for (const slider of this.sliders) {
      const joint = this.joints[slider.dataset.joint], value = +this.q[joint.name];
      const words = joint.kind === 'prismatic' ? (1000 * value).toFixed(1) + ' mm' : (180 / Math.PI * value).toFixed(1) + ' deg';
      slider.closest('label').querySelector('output').textContent = words;
      slider.setAttribute('aria-valuetext', words);
    }
  }
}

/* The page is read before the view is there: preparing it waits until everything else stands. */
const viewers = [];
addEventListener('load', () => setTimeout(() => {
  for (const root of document.querySelectorAll('.viewer')) viewers.push(new Viewer(root));
}));
document.addEventListener('click', event => {
  const button = event.target.closest && event.target.closest('button[data-show]');
  if (!button) return;
  const viewer = viewers.find(v => v.root.dataset.scene === button.dataset.scene), place = JSON.parse(button.dataset.show);
  if (!viewer || !viewer.gl) return;
  viewer.show(place.q, place.links, place.joint);
  viewer.canvas.scrollIntoView({ block: 'center' });
  viewer.canvas.focus({ preventScroll: true });
});
