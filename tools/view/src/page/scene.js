// The mesh on the graphics card: faces and edges fetch the places of their vertices from a texture; lines are
// quads as wide as they are on the screen.
const WIDE = 2048;
// The cells of a ground along each side.
const CELLS = 128;
const FETCH = `#version 300 es
precision highp float; precision highp int;
uniform highp sampler2D places; uniform mat4 matrix; uniform vec3 eye; uniform float nearer;
vec4 shown(vec3 p) { return matrix * vec4(eye + (p - eye) * nearer, 1); }
ivec2 texel(uint v) { return ivec2(int(v) % ${WIDE}, int(v) / ${WIDE}); }
`;
const FACES = [`${FETCH}
uniform vec3 colors[10]; in uint vertex; in uint piece; in vec3 corner; out vec3 normal; out vec2 sky; flat out vec3 color;
void main() {
  vec4 place = texelFetch(places, texel(vertex), 0);
  normal = corner;
  sky = vec2(mod(place.w, 256.), floor(place.w / 256.)) / 255.;
  color = colors[int(piece)];
  gl_Position = shown(place.xyz);
}`, `#version 300 es
precision highp float;
uniform vec3 backward, key; uniform float light[9];
in vec3 normal; in vec2 sky; flat in vec3 color; out vec4 pixel;
void main() {
  vec3 n = dot(normal, normal) > 0. ? normalize(normal) * (gl_FrontFacing ? 1. : -1.) : backward;
  float bright = light[0] + light[1] * max(dot(n, key), 0.) + light[2] * max(dot(n, backward), 0.);
  vec3 side = gl_FrontFacing ? color : mix(vec3(dot(color, vec3(1. / 3.))), color, light[6]) * light[7];
  float dark = light[8] * (1. - (gl_FrontFacing ? sky.x : sky.y));
  pixel = vec4(side * bright * (1. - dark), 1);
}`];
const GROUND = [`#version 300 es
precision highp float;
uniform mat4 matrix; uniform vec3 middle, across, down; out vec2 cell;
void main() {
  cell = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = matrix * vec4(middle + (cell.x * 2. - 1.) * across + (cell.y * 2. - 1.) * down, 1);
}`, `#version 300 es
precision highp float;
uniform sampler2D seen; uniform float shadow; in vec2 cell; out vec4 pixel;
void main() { pixel = vec4(0, 0, 0, shadow * (1. - texture(seen, cell).r)); }`];
const EDGES = [`${FETCH}
in uint vertex;
void main() { gl_Position = shown(texelFetch(places, texel(vertex), 0).xyz); }`, `#version 300 es
precision highp float;
uniform vec4 ink; out vec4 pixel;
void main() { pixel = vec4(ink.rgb * ink.a, ink.a); }`];
const LINES = [`${FETCH}
uniform vec2 size; uniform float wide; in vec3 from, to;
void main() {
  vec4 a = shown(from), b = shown(to);
  float least = 1e-5 * max(a.w, b.w);
  if (least <= 0.) { gl_Position = vec4(2, 2, 2, 1); return; }
  if (a.w < least) a = mix(b, a, (b.w - least) / (b.w - a.w));
  if (b.w < least) b = mix(a, b, (a.w - least) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * size;
  along = dot(along, along) > 0. ? normalize(along) : vec2(1, 0);
  bool end = gl_VertexID > 1;
  vec2 aside = vec2(-along.y, along.x) * (gl_VertexID % 2 == 0 ? -1. : 1.) + along * (end ? .5 : -.5);
  vec4 p = end ? b : a;
  gl_Position = vec4(p.xy + aside * wide / size * p.w, p.zw);
}`, EDGES[1]];

class Scene {
  // From the cosine `crease` on, two faces are one smooth surface: from −1 on, all faces of a vertex.
  constructor(canvas, crease) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!gl) throw new Error("This page needs WebGL 2, which this browser does not have or has turned off.");
    this.gl = gl;
    this.canvas = canvas;
    this.crease = crease;
    this.faces = this.program(FACES);
    this.edges = this.program(EDGES);
    this.lines = this.program(LINES);
    this.ground = this.program(GROUND);
    this.buffers = {};
    this.texture = gl.createTexture();
    this.groundTexture = gl.createTexture();
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(sources) {
    const { gl } = this, program = gl.createProgram();
    sources.forEach((source, i) => {
      const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    });
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const names = {}, count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < count; i++) {
      const { name } = gl.getActiveUniform(program, i);
      names[name.replace("[0]", "")] = gl.getUniformLocation(program, name);
    }
    return { program, names };
  }

  // Puts numbers into a buffer of this name.
  fill(name, numbers) {
    const { gl } = this;
    this.buffers[name] ??= { buffer: gl.createBuffer() };
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name].buffer);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
    this.buffers[name].length = numbers.length;
  }

  setState({ corners, pieces }) {
    this.fill("corners", corners);
    const numbers = new Uint8Array(corners.length);
    for (let i = 0; i < numbers.length; i++) numbers[i] = pieces[i / 3 | 0] % 10;
    this.fill("pieces", numbers);
    this.corners = corners;
    this.hasEdges = false;
    // The corners at each vertex, one after another: those of v are from first[v] up to first[v + 1].
    const count = corners.reduce((most, v) => Math.max(most, v), 0) + 1;
    this.first = new Uint32Array(count + 1);
    for (const v of corners) this.first[v + 1]++;
    for (let v = 0; v < count; v++) this.first[v + 1] += this.first[v];
    const next = this.first.slice();
    this.around = new Uint32Array(corners.length);
    corners.forEach((v, corner) => { this.around[next[v]++] = corner; });
  }

  // Without a shade, all vertices see all of the sky.
  setPlaces(places, shade) {
    const { gl } = this, count = places.length / 3, rows = Math.ceil(count / WIDE);
    const texels = new Float32Array(4 * WIDE * rows);
    for (let v = 0; v < count; v++) {
      for (let axis = 0; axis < 3; axis++) texels[4 * v + axis] = places[3 * v + axis];
      texels[4 * v + 3] = shade ? shade.front[v] + 256 * shade.back[v] : 65535;
    }
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, WIDE, rows, 0, gl.RGBA, gl.FLOAT, texels);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    this.fill("normals", this.normals(places));
  }

  // The normal of each corner: the mean, by area, of those faces of its vertex that go on without a crease.
  normals(places) {
    const { corners, first, around, crease } = this, faces = corners.length / 3;
    if (crease <= -1) return this.smoothNormals(places);
    const spanned = new Float64Array(corners.length), sizes = new Float64Array(faces);
    for (let f = 0; f < faces; f++) {
      const [i, j, k] = [3 * corners[3 * f], 3 * corners[3 * f + 1], 3 * corners[3 * f + 2]];
      const ux = places[j] - places[i], uy = places[j + 1] - places[i + 1], uz = places[j + 2] - places[i + 2];
      const vx = places[k] - places[i], vy = places[k + 1] - places[i + 1], vz = places[k + 2] - places[i + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      spanned[3 * f] = x;
      spanned[3 * f + 1] = y;
      spanned[3 * f + 2] = z;
      sizes[f] = Math.sqrt(x * x + y * y + z * z);
    }
    const normals = new Float32Array(3 * corners.length);
    for (let corner = 0; corner < corners.length; corner++) {
      const f = (corner / 3) | 0, v = corners[corner], least = crease * sizes[f];
      const [a, b, c] = [spanned[3 * f], spanned[3 * f + 1], spanned[3 * f + 2]];
      let x = 0, y = 0, z = 0;
      for (let at = first[v]; at < first[v + 1]; at++) {
        const g = (around[at] / 3) | 0, [d, e, h] = [spanned[3 * g], spanned[3 * g + 1], spanned[3 * g + 2]];
        if (a * d + b * e + c * h < least * sizes[g]) continue;
        x += d;
        y += e;
        z += h;
      }
      const scale = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
      normals[3 * corner] = x * scale;
      normals[3 * corner + 1] = y * scale;
      normals[3 * corner + 2] = z * scale;
    }
    return normals;
  }

  smoothNormals(places) {
    const { corners } = this, sums = new Float64Array(places.length), normals = new Float32Array(3 * corners.length);
    for (let f = 0; f < corners.length; f += 3) {
      const i = 3 * corners[f], j = 3 * corners[f + 1], k = 3 * corners[f + 2];
      const ux = places[j] - places[i], uy = places[j + 1] - places[i + 1], uz = places[j + 2] - places[i + 2];
      const vx = places[k] - places[i], vy = places[k + 1] - places[i + 1], vz = places[k + 2] - places[i + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (const at of [i, j, k]) {
        sums[at] += x;
        sums[at + 1] += y;
        sums[at + 2] += z;
      }
    }
    for (let corner = 0; corner < corners.length; corner++) {
      const at = 3 * corners[corner], [x, y, z] = [sums[at], sums[at + 1], sums[at + 2]];
      const scale = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
      normals[3 * corner] = x * scale;
      normals[3 * corner + 1] = y * scale;
      normals[3 * corner + 2] = z * scale;
    }
    return normals;
  }

  // Segments, each as six numbers.
  setLines(name, numbers) {
    this.fill(name, Float32Array.from(numbers));
  }

  // The buffer of each attribute, with how many numbers it takes; integers are of the type given.
  attributes({ program }, wanted) {
    const { gl } = this;
    for (let i = 0; i < 4; i++) gl.disableVertexAttribArray(i);
    for (const [attribute, { name, type, stride, offset }] of Object.entries(wanted)) {
      const at = gl.getAttribLocation(program, attribute);
      if (at < 0) continue;
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name].buffer);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribDivisor(at, stride ? 1 : 0);
      if (type) gl.vertexAttribIPointer(at, 1, type, 0, 0);
      else gl.vertexAttribPointer(at, 3, gl.FLOAT, false, stride, offset);
    }
  }

  use(which, camera, box, nearer) {
    const { gl } = this, { program, names } = which;
    gl.useProgram(program);
    gl.uniformMatrix4fv(names.matrix, false, camera.matrix(box));
    gl.uniform3fv(names.eye, camera.eye);
    gl.uniform1f(names.nearer, nearer);
    if (names.places) gl.uniform1i(names.places, 0);
    return names;
  }

  begin(background) {
    const { gl } = this, { width, height } = this.canvas;
    gl.viewport(0, 0, width, height);
    gl.clearColor(...background.map((x) => x / 255), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  }

  // The shadow on the ground, which is below all else.
  drawGround(camera, { middle, sides, cells }, shadow) {
    const { gl } = this, [across, down] = sides;
    if (dot(sub(camera.eye, middle), camera.upright) <= 0) return;
    const reach = across.map((x, axis) => Math.abs(x) + Math.abs(down[axis]));
    const { program, names } = this.ground;
    gl.useProgram(program);
    gl.uniformMatrix4fv(names.matrix, false, camera.matrix({ least: sub(middle, reach), most: add(middle, reach) }));
    gl.uniform3fv(names.middle, middle);
    gl.uniform3fv(names.across, across);
    gl.uniform3fv(names.down, down);
    gl.uniform1f(names.shadow, shadow);
    gl.uniform1i(names.seen, 1);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.groundTexture);
    if (this.cells !== cells) {
      this.cells = cells;
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, CELLS, CELLS, 0, gl.RED, gl.UNSIGNED_BYTE, cells);
      for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);
      for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    }
    gl.activeTexture(gl.TEXTURE0);
    this.attributes(this.ground, {});
    gl.disable(gl.DEPTH_TEST);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.enable(gl.DEPTH_TEST);
  }

  drawFaces(camera, box, colors, [ambient, key, head, b, u, r, ...back]) {
    const { gl } = this, names = this.use(this.faces, camera, box, 1);
    gl.uniform3fv(names.colors, colors.flat().map((x) => x / 255));
    gl.uniform1fv(names.light, [ambient, key, head, b, u, r, ...back]);
    gl.uniform3fv(names.backward, camera.backward);
    gl.uniform3fv(names.key, unit(add(add(times(camera.backward, b), times(camera.up, u)), times(camera.right, r))));
    this.attributes(this.faces, { vertex: { name: "corners", type: gl.UNSIGNED_INT }, piece: { name: "pieces", type: gl.UNSIGNED_BYTE }, corner: { name: "normals", stride: 0, offset: 0 } });
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.drawArrays(gl.TRIANGLES, 0, this.corners.length);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  drawEdges(camera, box, color, cover) {
    const { gl, corners } = this;
    if (!this.hasEdges) {
      const ends = new Uint32Array(2 * corners.length);
      for (let i = 0; i < corners.length; i++) {
        ends[2 * i] = corners[i];
        ends[2 * i + 1] = corners[i - i % 3 + (i + 1) % 3];
      }
      this.fill("edges", ends);
      this.hasEdges = true;
    }
    const names = this.use(this.edges, camera, box, 0.9997);
    gl.uniform4fv(names.ink, [...color.map((x) => x / 255), cover]);
    this.attributes(this.edges, { vertex: { name: "edges", type: gl.UNSIGNED_INT } });
    gl.drawArrays(gl.LINES, 0, this.buffers.edges.length);
  }

  // Lines, so many pixels wide; those that are hidden as well if `cover` is less than one.
  drawLines(name, camera, box, color, wide, cover = 1) {
    const { gl } = this, count = (this.buffers[name]?.length ?? 0) / 6;
    if (!count) return;
    const names = this.use(this.lines, camera, box, 0.9985);
    gl.uniform4fv(names.ink, [...color.map((x) => x / 255), cover]);
    gl.uniform2fv(names.size, camera.size);
    gl.uniform1f(names.wide, wide);
    this.attributes(this.lines, { from: { name, stride: 24, offset: 0 }, to: { name, stride: 24, offset: 12 } });
    if (cover < 1) gl.disable(gl.DEPTH_TEST);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    gl.enable(gl.DEPTH_TEST);
  }
}

