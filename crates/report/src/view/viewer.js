// The view of a run: spheres, bonds and walls of its frames. Data: view/encode.rs and view/head.rs.
"use strict";
(async () => {
const root = document.getElementById("view");
const find = name => root.querySelector("." + name);
const say = text => { find("say").textContent = text; };
const canvas = find("canvas");
const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
if (!gl || typeof DecompressionStream === "undefined") {
  say("This browser cannot show the view: it needs WebGL 2. The rest of the page does not.");
  root.dataset.state = "none";
  return;
}
const head = JSON.parse(document.getElementById("view-head").textContent);
const tracks = decoded(head.tracks, await inflated(document.getElementById("view-data").textContent));
const frames = head.times_s.length;

// ---- Data ----

async function inflated(base64) {
  const text = atob(base64.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function decoded(tracks, data) {
  const kinds = { 1: Uint8Array, 2: Uint16Array, 4: Int32Array };
  const found = {};
  let at = 0;
  for (const { name, bytes, counts } of tracks) {
    let last = new kinds[bytes](0);
    found[name] = counts.map(count => {
      if (count < 0) return last;
      const values = new kinds[bytes](count);
      for (let i = 0; i < count; i++) {
        let difference = 0;
        for (let plane = 0; plane < bytes; plane++) difference |= data[at + plane * count + i] << (8 * plane);
        const before = count === last.length ? last[i] : i > 0 ? values[i - 1] : 0;
        values[i] = before + difference;
      }
      at += bytes * count;
      return last = values;
    });
  }
  return found;
}

// ---- Colours ----

const rgb = hex => [1, 3, 5].map(k => parseInt(hex.slice(k, k + 2), 16));
const scale = head.scale.map(rgb);
const pieces = head.piece_colours.map(rgb);
const bodies = head.body_colours.map(rgb);
const BOND = [90, 96, 104], BROKEN = [214, 40, 40], NONE = [190, 192, 195];

function between(a, b, part) { return [0, 1, 2].map(k => a[k] + (b[k] - a[k]) * part); }
function on_scale(level) {
  const place = level / 255 * (scale.length - 1), below = Math.min(Math.floor(place), scale.length - 2);
  return between(scale[below], scale[below + 1], place - below);
}
function on_both_sides(level) {
  const part = (level - 128) / 127, white = [243, 241, 236];
  return part < 0 ? between(white, [33, 102, 172], Math.min(-part, 1)) : between(white, [178, 24, 43], Math.min(part, 1));
}
const ramps = {
  speed: { colours: levels(on_scale), from: "0", to: head.highest.speed },
  utilisation: { colours: levels(on_scale), from: "0", to: head.highest.utilisation },
  mass: { colours: levels(on_scale), from: "0", to: head.highest.mass },
  stress: { colours: levels(on_both_sides), from: "-" + head.highest.stress, to: "+" + head.highest.stress },
};
function levels(colour) { return Array.from({ length: 256 }, (_, level) => colour(level)); }

function colour_of(mode, frame) {
  const values = tracks[mode === "piece" ? "fragment" : mode][frame];
  const palette = mode === "piece" ? pieces : mode === "body" ? bodies : ramps[mode].colours;
  return i => palette[values[i]] || NONE;
}
function colour_of_bond(mode, frame) {
  const broken = tracks.broken[frame];
  const values = (tracks["bond_" + mode] || [])[frame];
  const palette = values && ramps[mode].colours;
  return i => broken[i] ? BROKEN : palette ? palette[values[i]] : BOND;
}

// ---- Programs ----

const COMMON = `#version 300 es
precision highp float;
uniform mat4 view, projection;
uniform vec3 origin;
uniform float resolution;
uniform vec4 cut;
`;
const SHADE = `#version 300 es
precision highp float;
vec3 shade(vec3 colour, vec3 normal, vec3 at) {
  vec3 light = normalize(vec3(-0.35, 0.65, 0.68));
  float diffuse = max(dot(normal, light), 0.0);
  float shine = pow(max(dot(reflect(-light, normal), normalize(-at)), 0.0), 24.0);
  return colour * (0.34 + 0.22 * normal.y + 0.62 * diffuse) + 0.10 * shine;
}
`;
const spheres = program(COMMON + `
in vec2 corner; in float x, y, z, radius; in vec4 colour;
uniform float radius_unit, size;
out vec3 on_quad; flat out vec3 centre; flat out float r; flat out vec3 c;
void main() {
  vec3 world = origin + resolution * vec3(x, y, z);
  centre = (view * vec4(world, 1.0)).xyz;
  r = radius * radius_unit * size;
  c = colour.rgb;
  float d2 = dot(centre, centre);
  if (dot(cut.xyz, world) > cut.w || d2 < 1.02 * r * r) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  vec3 toward = -centre / sqrt(d2);
  vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), toward));
  vec3 up = cross(toward, right);
  on_quad = centre + r * sqrt(d2 / (d2 - r * r)) * (right * corner.x + up * corner.y);
  gl_Position = projection * vec4(on_quad, 1.0);
}`, SHADE + `
in vec3 on_quad; flat in vec3 centre; flat in float r; flat in vec3 c;
uniform mat4 projection;
out vec4 pixel;
void main() {
  vec3 ray = normalize(on_quad);
  float along = dot(ray, centre);
  float inside = r * r - dot(centre, centre) + along * along;
  if (inside < 0.0) discard;
  vec3 at = ray * (along - sqrt(inside));
  vec4 clip = projection * vec4(at, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
  pixel = vec4(shade(c, (at - centre) / r, at), 1.0);
}`);
const tubes = program(COMMON + `
in vec3 corner; in vec3 a, b; in float thick; in vec4 colour;
out vec3 normal, at; flat out vec3 c;
void main() {
  vec3 from = origin + resolution * a, to = origin + resolution * b;
  vec3 along = to - from;
  float far = length(along);
  if (far == 0.0 || dot(cut.xyz, 0.5 * (from + to)) > cut.w) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  along /= far;
  vec3 side = normalize(cross(along, abs(along.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
  vec3 out_of = corner.x * side + corner.y * cross(along, side);
  vec4 eye = view * vec4(from + corner.z * far * along + thick * out_of, 1.0);
  normal = (view * vec4(out_of, 0.0)).xyz;
  at = eye.xyz;
  c = colour.rgb;
  gl_Position = projection * eye;
}`, SHADE + `
in vec3 normal, at; flat in vec3 c;
out vec4 pixel;
void main() { pixel = vec4(shade(c, normalize(normal), at), 1.0); }`);
const surfaces = program(COMMON + `
in float x, y, z;
out vec3 at, world;
void main() {
  world = origin + resolution * vec3(x, y, z);
  vec4 eye = view * vec4(world, 1.0);
  at = eye.xyz;
  gl_Position = projection * eye;
}`, SHADE + `
in vec3 at, world;
uniform vec4 cut;
uniform vec3 paint;
uniform float opacity;
out vec4 pixel;
void main() {
  if (dot(cut.xyz, world) > cut.w) discard;
  vec3 normal = normalize(cross(dFdx(at), dFdy(at)));
  pixel = vec4(shade(paint, normal.z < 0.0 ? -normal : normal, at), opacity);
}`);

const patches = program(COMMON + `
in float x, y, z; in vec4 colour;
out vec3 at, world; flat out vec3 c;
void main() {
  world = origin + resolution * vec3(x, y, z);
  vec4 eye = view * vec4(world, 1.0);
  at = eye.xyz;
  c = colour.rgb;
  gl_Position = projection * eye;
}`, SHADE + `
in vec3 at, world; flat in vec3 c;
uniform vec4 cut;
out vec4 pixel;
void main() {
  if (dot(cut.xyz, world) > cut.w) discard;
  vec3 normal = normalize(cross(dFdx(at), dFdy(at)));
  // Little shade, so that the colours are those of the scale.
  pixel = vec4(mix(c, shade(c, normal.z < 0.0 ? -normal : normal, at), 0.4), 1.0);
}`);

function program(vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const uniforms = {}, attributes = {};
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i++) {
    const { name } = gl.getActiveUniform(made, i);
    uniforms[name] = gl.getUniformLocation(made, name);
  }
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_ATTRIBUTES); i++) {
    const { name } = gl.getActiveAttrib(made, i);
    attributes[name] = gl.getAttribLocation(made, name);
  }
  return { made, uniforms, attributes, array: gl.createVertexArray(), buffers: {} };
}

// Fills an attribute. `each`: 1 for a value of each instance, 0 for one of each corner.
function fill(of, name, values, numbers, each, kind = gl.FLOAT, is_part = false) {
  gl.bindVertexArray(of.array);
  const buffer = of.buffers[name] ||= gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
  const place = of.attributes[name];
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, numbers, kind, is_part, 0, 0);
  gl.vertexAttribDivisor(place, each);
}

fill(spheres, "corner", new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), 2, 0);
const SIDES = 7, ring = [];
for (let k = 0; k <= SIDES; k++) for (const end of [0, 1]) {
  ring.push(Math.cos(2 * Math.PI * k / SIDES), Math.sin(2 * Math.PI * k / SIDES), end);
}
fill(tubes, "corner", new Float32Array(ring), 3, 0);
const corners = gl.createBuffer();

// ---- One frame into the buffers ----

const shown = { frame: -1, mode: "", loads: "", spheres: 0, bonds: 0, corners: 0, triangles: null, patch_corners: 0 };
const choice = {
  frame: 0, mode: head.modes[0], spheres: true, bonds: false, walls: true, axis: "", cut: 0.5, playing: false,
  loads: head.loads.length > 0 ? head.loads[0].track : "",
};

function load() {
  if (shown.frame === choice.frame && shown.mode === choice.mode && shown.loads === choice.loads) return;
  const k = shown.frame = choice.frame;
  shown.mode = choice.mode;
  shown.loads = choice.loads;
  for (const axis of ["x", "y", "z"]) fill(spheres, axis, tracks[axis][k], 1, 1, gl.INT);
  fill(spheres, "radius", tracks.radius[k], 1, 1, gl.UNSIGNED_SHORT);
  shown.spheres = tracks.radius[k].length;
  fill(spheres, "colour", painted(shown.spheres, colour_of(choice.mode, k)), 4, 1, gl.UNSIGNED_BYTE, true);
  load_bonds(k);
  load_walls(k);
  load_patches(k);
}

function painted(count, colour) {
  const all = new Uint8Array(4 * count);
  for (let i = 0; i < count; i++) {
    const [r, g, b] = colour(i);
    all[4 * i] = r; all[4 * i + 1] = g; all[4 * i + 2] = b; all[4 * i + 3] = 255;
  }
  return all;
}

function load_bonds(k) {
  const [x, y, z] = ["x", "y", "z"].map(axis => tracks[axis][k]);
  const ends = { a: tracks.a[k], b: tracks.b[k] }, thick = tracks.bond_radius[k], broken = tracks.broken[k];
  shown.bonds = thick.length;
  for (const end of ["a", "b"]) {
    const places = new Float32Array(3 * shown.bonds);
    for (let i = 0; i < shown.bonds; i++) {
      const sphere = ends[end][i];
      places[3 * i] = x[sphere]; places[3 * i + 1] = y[sphere]; places[3 * i + 2] = z[sphere];
    }
    fill(tubes, end, places, 3, 1);
  }
  const radii = new Float32Array(shown.bonds);
  for (let i = 0; i < shown.bonds; i++) radii[i] = thick[i] * head.radius_unit_m * (broken[i] ? 0.06 : 0.28);
  fill(tubes, "thick", radii, 1, 1);
  fill(tubes, "colour", painted(shown.bonds, colour_of_bond(choice.mode, k)), 4, 1, gl.UNSIGNED_BYTE, true);
}

function load_walls(k) {
  if (!tracks.wall_x) return;
  for (const axis of ["x", "y", "z"]) fill(surfaces, axis, tracks["wall_" + axis][k], 1, 0, gl.INT);
  if (shown.triangles === tracks.corner[k]) return;
  shown.triangles = tracks.corner[k];
  shown.corners = shown.triangles.length;
  gl.bindVertexArray(surfaces.array);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, corners);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(shown.triangles), gl.STATIC_DRAW);
}

function load_patches(k) {
  shown.patch_corners = choice.loads ? tracks.load_x[k].length : 0;
  if (shown.patch_corners === 0) return;
  for (const axis of ["x", "y", "z"]) fill(patches, axis, tracks["load_" + axis][k], 1, 0, gl.INT);
  const levels = tracks[choice.loads][k], ramp = ramps.speed.colours;
  const colours = painted(shown.patch_corners, i => ramp[levels[Math.floor(i / 3)]]);
  fill(patches, "colour", colours, 4, 0, gl.UNSIGNED_BYTE, true);
}

// ---- Camera ----

const camera = {};
function reset() {
  const [fx, fy, fz] = head.from;
  camera.target = [...head.focus_m];
  camera.distance = 3 * head.reach_m;
  camera.turn = Math.atan2(fy, fx);
  camera.rise = Math.atan2(fz, Math.hypot(fx, fy));
}
function axes() {
  const [ct, st, cr, sr] = [Math.cos(camera.turn), Math.sin(camera.turn), Math.cos(camera.rise), Math.sin(camera.rise)];
  return { back: [cr * ct, cr * st, sr], right: [-st, ct, 0], up: [-sr * ct, -sr * st, cr] };
}
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
function matrices() {
  const { back, right, up } = axes();
  const eye = back.map((part, k) => camera.target[k] + camera.distance * part);
  const view = [0, 1, 2].flatMap(k => [right[k], up[k], back[k], 0]);
  view.push(-dot(right, eye), -dot(up, eye), -dot(back, eye), 1);
  const near = camera.distance / 50, far = camera.distance + 40 * head.reach_m;
  const aspect = canvas.width / canvas.height;
  // The angle of view is that of the shorter side, so that upright screens show the whole as well.
  const f = Math.min(1, aspect) / Math.tan(0.3);
  const projection = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
  return { view, projection };
}

// ---- Drawing ----

let is_waiting = false;
function draw() {
  if (!is_waiting) { is_waiting = true; requestAnimationFrame(drawn); }
}
function cut_plane() {
  const k = "xyz".indexOf(choice.axis);
  if (k < 0 || choice.axis === "") return [0, 0, 0, 1];
  const normal = [0, 0, 0];
  normal[k] = 1;
  const { low_m, high_m } = head;
  return [...normal, low_m[k] + choice.cut * (high_m[k] - low_m[k])];
}
function use(of, { view, projection }) {
  gl.useProgram(of.made);
  gl.bindVertexArray(of.array);
  gl.uniformMatrix4fv(of.uniforms.view, false, view);
  gl.uniformMatrix4fv(of.uniforms.projection, false, projection);
  gl.uniform3fv(of.uniforms.origin, head.origin_m);
  gl.uniform1f(of.uniforms.resolution, head.resolution_m);
  gl.uniform4fv(of.uniforms.cut, cut_plane());
}
function drawn() {
  is_waiting = false;
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight].map(px => Math.max(1, Math.round(px * ratio)));
  if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  load();
  const set = matrices();
  gl.viewport(0, 0, width, height);
  const ground = rgb(getComputedStyle(root).getPropertyValue("--view-ground").trim() || "#f4f5f7");
  gl.clearColor(...ground.map(part => part / 255), 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  if (choice.spheres && shown.spheres > 0) {
    use(spheres, set);
    gl.uniform1f(spheres.uniforms.radius_unit, head.radius_unit_m);
    gl.uniform1f(spheres.uniforms.size, choice.bonds ? 0.45 : 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, shown.spheres);
  }
  if (choice.bonds && shown.bonds > 0) {
    use(tubes, set);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, ring.length / 3, shown.bonds);
  }
  if (choice.walls && shown.patch_corners > 0) draw_patches(set);
  if (choice.walls && shown.corners > 0) draw_walls(set);
  find("time").textContent = head.time_texts[choice.frame];
  root.dataset.frame = choice.frame;
  root.dataset.state = "ready";
}
// In front of the walls that they are part of.
function draw_patches(set) {
  use(patches, set);
  gl.enable(gl.POLYGON_OFFSET_FILL);
  gl.polygonOffset(-1, -2);
  gl.drawArrays(gl.TRIANGLES, 0, shown.patch_corners);
  gl.disable(gl.POLYGON_OFFSET_FILL);
}
function draw_walls(set) {
  use(surfaces, set);
  gl.uniform3f(surfaces.uniforms.paint, 0.40, 0.45, 0.52);
  gl.uniform1f(surfaces.uniforms.opacity, 0.38);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.depthMask(false);
  gl.drawElements(gl.TRIANGLES, shown.corners, gl.UNSIGNED_INT, 0);
  gl.depthMask(true);
  gl.disable(gl.BLEND);
}

// ---- Hands ----

const pointers = new Map();
canvas.addEventListener("pointerdown", event => {
  canvas.focus({ preventScroll: true });
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
});
for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, event => pointers.delete(event.pointerId));
canvas.addEventListener("contextmenu", event => event.preventDefault());
canvas.addEventListener("pointermove", event => {
  const before = pointers.get(event.pointerId);
  if (!before) return;
  const now = [event.clientX, event.clientY], moved = [now[0] - before[0], now[1] - before[1]];
  if (pointers.size === 1) {
    if (event.buttons & 6 || event.shiftKey) shift(moved);
    else {
      camera.turn -= moved[0] * 0.008;
      camera.rise = Math.max(-1.55, Math.min(1.55, camera.rise + moved[1] * 0.008));
    }
  } else {
    const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
    const apart = place => Math.hypot(place[0] - other[0], place[1] - other[1]) || 1;
    zoom(apart(before) / apart(now));
    shift(moved.map(part => part / 2));
  }
  pointers.set(event.pointerId, now);
  draw();
});
canvas.addEventListener("wheel", event => {
  if (document.activeElement !== canvas) return;
  event.preventDefault();
  zoom(Math.exp(event.deltaY * 0.001));
  draw();
}, { passive: false });
canvas.addEventListener("keydown", event => {
  const keys = { "+": () => zoom(0.8), "-": () => zoom(1.25), ArrowLeft: () => go(choice.frame - 1), ArrowRight: () => go(choice.frame + 1), " ": () => play(!choice.playing) };
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
  draw();
});
function zoom(factor) { camera.distance = Math.max(1e-3 * head.reach_m, Math.min(100 * head.reach_m, camera.distance * factor)); }
function shift(moved) {
  const { right, up } = axes(), unit = 0.62 * camera.distance / Math.min(canvas.clientWidth, canvas.clientHeight);
  for (let k = 0; k < 3; k++) camera.target[k] += unit * (moved[1] * up[k] - moved[0] * right[k]);
}

// ---- Controls ----

function go(frame) {
  choice.frame = Math.max(0, Math.min(frames - 1, frame));
  find("slider").value = choice.frame;
  draw();
}
let timer = 0;
function play(is_on) {
  choice.playing = is_on;
  find("play").textContent = is_on ? "Pause" : "Play";
  clearInterval(timer);
  if (is_on) timer = setInterval(() => go((choice.frame + 1) % frames), Math.max(40, 6000 / frames));
}
function legend() {
  find("bodies").hidden = choice.mode !== "body";
  find("pieces").hidden = choice.mode !== "piece";
  show_scale(find("mode-legend"), ramps[choice.mode]);
  const of_walls = head.loads.find(one => one.track === choice.loads);
  show_scale(find("loads-legend"), of_walls && { colours: ramps.speed.colours, from: "0", to: of_walls.highest });
}
function show_scale(element, ramp) {
  element.hidden = !ramp;
  if (!ramp) return;
  const stops = [0, 32, 64, 96, 128, 160, 192, 224, 255].map(level => `rgb(${ramp.colours[level].map(Math.round)})`);
  element.querySelector(".ramp").style.background = `linear-gradient(90deg, ${stops})`;
  element.querySelector(".low").textContent = ramp.from;
  element.querySelector(".high").textContent = ramp.to;
}
head.body_names.forEach((name, at) => {
  const chip = document.createElement("i"), label = document.createElement("span");
  chip.style.background = head.body_colours[at];
  label.append(chip, name);
  find("bodies").append(label);
});
const names = { piece: "fragment", body: "body", speed: "speed", utilisation: "utilisation of bonds", stress: "stress of bonds", mass: "fragment mass" };
for (const mode of head.modes) find("mode").add(new Option(names[mode], mode));
for (const { name, track } of head.loads) find("loads").add(new Option(name, track));
find("loads").add(new Option("none", ""));
find("loads-choice").hidden = head.loads.length === 0;
find("loads").addEventListener("change", event => { choice.loads = event.target.value; legend(); draw(); });
find("slider").max = frames - 1;
find("slider").addEventListener("input", event => { play(false); go(+event.target.value); });
find("play").addEventListener("click", () => play(!choice.playing));
find("mode").addEventListener("change", event => { choice.mode = event.target.value; legend(); draw(); });
for (const name of ["spheres", "bonds", "walls"]) {
  find(name).checked = choice[name];
  find(name).addEventListener("change", event => { choice[name] = event.target.checked; draw(); });
}
find("axis").addEventListener("change", event => { choice.axis = event.target.value; find("cut").disabled = !choice.axis; draw(); });
find("cut").addEventListener("input", event => { choice.cut = +event.target.value; draw(); });
find("reset").addEventListener("click", () => { reset(); draw(); });
find("full").addEventListener("click", () => document.fullscreenElement ? document.exitFullscreen() : root.requestFullscreen());
new ResizeObserver(draw).observe(canvas);
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
canvas.addEventListener("webglcontextlost", () => say("The graphics were reset: load the page again."));
reset();
legend();
find("controls").hidden = false;
say("");
go(frames - 1 > 0 ? Math.round(head.opening * (frames - 1)) : 0);
})().catch(error => {
  document.querySelector("#view .say").textContent = "The view failed: " + error.message;
  document.getElementById("view").dataset.state = "failed";
});
