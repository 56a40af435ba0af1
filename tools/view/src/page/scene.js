// The mesh on the graphics card: faces and edges fetch the places of their vertices from a texture; lines are
// quads as wide as they are on the screen.
const WIDE = 2048;
// The colour of solids.
const GREY = [158, 158, 158];
// The kind of a half-edge that is torn.
const TORN = 2;
// Into how many parts a finer mesh divides each edge.
const FINER = 3;
const FETCH = `#version 300 es
precision highp float; precision highp int;
uniform highp sampler2D places; uniform mat4 matrix; uniform vec3 eye; uniform float nearer;
vec4 shown(vec3 p) { return matrix * vec4(eye + (p - eye) * nearer, 1); }
ivec2 texel(uint v) { return ivec2(int(v) % ${WIDE}, int(v) / ${WIDE}); }
`;
const FACES = [`${FETCH}
uniform vec3 colors[11]; in uint vertex; in uint piece; in vec3 corner; out vec3 normal; out vec2 sky; flat out vec3 color;
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
  // A browser may lose what is on its graphics card; what was set is to be set again then.
  constructor(canvas, restored) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!gl) throw new Error("This page needs WebGL 2, which this browser does not have or has turned off.");
    this.gl = gl;
    this.canvas = canvas;
    this.isFiner = false;
    this.build();
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.build();
      restored();
    });
  }

  build() {
    const { gl } = this;
    this.faces = this.program(FACES);
    this.edges = this.program(EDGES);
    this.lines = this.program(LINES);
    this.ground = this.program(GROUND);
    this.buffers = {};
    this.cells = null;
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

  // Faces behind those of pieces are of solids, and their edges are not of any kind.
  setState({ corners, kinds, pieces }) {
    this.finer = this.isFiner ? new Finer(corners, FINER) : null;
    this.coarse = corners;
    this.corners = this.finer?.corners ?? corners;
    this.fill("corners", this.corners);
    const parts = this.corners.length / corners.length, numbers = new Uint8Array(this.corners.length);
    for (let i = 0; i < numbers.length; i++) {
      const face = Math.floor(i / 3 / parts);
      numbers[i] = face < pieces.length ? pieces[face] % 10 : 10;
    }
    this.fill("pieces", numbers);
    this.hasEdges = false;
    // The ends of edges that have a face on one side only.
    this.open = { boundary: [], seam: [] };
    kinds.forEach((kind, h) => {
      if (kind) this.open[kind === TORN ? "seam" : "boundary"].push(corners[h], corners[h - h % 3 + (h + 1) % 3]);
    });
  }

  // Without a shade, all vertices see all of the sky.
  setPlaces(places, shade) {
    const { gl, finer, corners } = this;
    let normals = vertexNormals(places, this.coarse), [front, back] = [shade?.front, shade?.back];
    if (finer) {
      places = finer.places(places, normals);
      normals = vertexNormals(places, corners);
      if (shade) [front, back] = [front, back].map((side) => finer.mixed(side, 1, Uint8Array));
    }
    this.places = places;
    const count = places.length / 3, rows = Math.ceil(count / WIDE), texels = new Float32Array(4 * WIDE * rows);
    for (let v = 0; v < count; v++) {
      for (let axis = 0; axis < 3; axis++) texels[4 * v + axis] = places[3 * v + axis];
      texels[4 * v + 3] = shade ? front[v] + 256 * back[v] : 65535;
    }
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, WIDE, rows, 0, gl.RGBA, gl.FLOAT, texels);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    const ofCorners = new Float32Array(3 * corners.length);
    for (let i = 0, at = 0; i < corners.length; i++) {
      for (let axis = 0; axis < 3; axis++, at++) ofCorners[at] = normals[3 * corners[i] + axis];
    }
    this.fill("normals", ofCorners);
    for (const [name, ends] of Object.entries(this.open)) this.setEdges(name, ends);
  }

  // Lines along edges of the mesh, by the numbers of their ends.
  setEdges(name, ends) {
    const { finer, places } = this, numbers = [];
    for (let i = 0; i < ends.length; i += 2) {
      const along = finer?.along(ends[i], ends[i + 1]) ?? [ends[i], ends[i + 1]];
      for (let j = 1; j < along.length; j++) {
        for (const v of [along[j - 1], along[j]]) numbers.push(places[3 * v], places[3 * v + 1], places[3 * v + 2]);
      }
    }
    this.setLines(name, numbers);
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
    if (names.places) {
      gl.uniform1i(names.places, 0);
      gl.bindTexture(gl.TEXTURE_2D, this.texture);
    }
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
      const side = Math.sqrt(cells.length);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, side, side, 0, gl.RED, gl.UNSIGNED_BYTE, cells);
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
    gl.uniform3fv(names.colors, [...colors, GREY].flat().map((x) => x / 255));
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

