// The unit normal of each vertex: the mean of those of its faces, by area.
function vertexNormals(places, corners) {
  const normals = new Float64Array(places.length);
  for (let f = 0; f < corners.length; f += 3) {
    const i = 3 * corners[f], j = 3 * corners[f + 1], k = 3 * corners[f + 2];
    const ux = places[j] - places[i], uy = places[j + 1] - places[i + 1], uz = places[j + 2] - places[i + 2];
    const vx = places[k] - places[i], vy = places[k + 1] - places[i + 1], vz = places[k + 2] - places[i + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    for (let corner = 0, at = i; corner < 3; corner++, at = corner === 1 ? j : k) {
      normals[at] += x;
      normals[at + 1] += y;
      normals[at + 2] += z;
    }
  }
  for (let at = 0; at < normals.length; at += 3) {
    const x = normals[at], y = normals[at + 1], z = normals[at + 2], scale = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
    normals[at] = x * scale;
    normals[at + 1] = y * scale;
    normals[at + 2] = z * scale;
  }
  return normals;
}

// A mesh drawn finer: each face is divided into n² and bent between the normals of its corners, as in pictures
// (Phong tessellation; Boubekeur and Alexa 2008). A vertex on an edge belongs to the numbers of the edge's ends, so
// the finer mesh is open where the mesh is.
class Finer {
  constructor(corners, n) {
    const faces = corners.length / 3, most = 3 * faces * (n - 1) + faces * (n - 1) * (n - 2) / 2;
    this.n = n;
    this.coarse = corners.reduce((last, v) => Math.max(last, v), -1) + 1;
    this.count = this.coarse;
    // Of each vertex that is added, the three that it lies between, and their weights.
    this.ends = new Uint32Array(3 * most);
    this.weights = new Float64Array(3 * most);
    // The first vertex on each edge, from the lower to the higher number; the others come behind it.
    this.edges = new Map();
    this.corners = new Uint32Array(corners.length * n * n);
    const grid = new Uint32Array((n + 1) * (n + 1)), at = (i, j) => grid[i * (n + 1) + j];
    for (let f = 0, out = 0; f < corners.length; f += 3) {
      const a = corners[f], b = corners[f + 1], c = corners[f + 2];
      grid[0] = a;
      grid[n * (n + 1)] = b;
      grid[n] = c;
      for (let i = 1; i < n; i++) {
        grid[i * (n + 1)] = this.on(a, b, i);
        grid[i] = this.on(a, c, i);
        grid[(n - i) * (n + 1) + i] = this.on(b, c, i);
        for (let j = 1; i + j < n; j++) grid[i * (n + 1) + j] = this.make(a, b, c, n - i - j, i, j);
      }
      for (let i = 0; i < n; i++) {
        for (let j = 0; j < n - i; j++) {
          const face = [at(i, j), at(i + 1, j), at(i, j + 1)];
          if (j + 1 < n - i) face.push(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
          for (const v of face) this.corners[out++] = v;
        }
      }
    }
  }

  // The vertex that is so many steps along an edge.
  on(from, to, steps) {
    const { n, edges } = this, low = Math.min(from, to), high = Math.max(from, to), key = low * 2 ** 26 + high;
    if (!edges.has(key)) {
      edges.set(key, this.count);
      for (let i = 1; i < n; i++) this.make(low, high, high, n - i, i, 0);
    }
    return edges.get(key) + (from < to ? steps : n - steps) - 1;
  }

  make(a, b, c, s, t, u) {
    const at = 3 * (this.count - this.coarse);
    this.ends.set([a, b, c], at);
    this.weights.set([s / this.n, t / this.n, u / this.n], at);
    return this.count++;
  }

  // All vertices along an edge.
  along(from, to) {
    return [from, ...Array.from({ length: this.n - 1 }, (_, i) => this.on(from, to, i + 1)), to];
  }

  // Numbers of the vertices, as many each, for the finer ones as well.
  mixed(numbers, each, Type = Float64Array) {
    const { ends, weights, coarse, count } = this, mixed = new Type(each * count);
    mixed.set(numbers.subarray(0, each * coarse));
    for (let i = 0, at = each * coarse; at < mixed.length; i += 3) {
      for (let j = 0; j < each; j++, at++) {
        mixed[at] = weights[i] * numbers[each * ends[i] + j] + weights[i + 1] * numbers[each * ends[i + 1] + j] + weights[i + 2] * numbers[each * ends[i + 2] + j];
      }
    }
    return mixed;
  }

  places(places, normals) {
    const { ends, weights } = this, finer = this.mixed(places, 3);
    for (let i = 0, at = 3 * this.coarse; at < finer.length; i += 3, at += 3) {
      let x = finer[at], y = finer[at + 1], z = finer[at + 2];
      for (let j = i; j < i + 3; j++) {
        const v = 3 * ends[j], nx = normals[v], ny = normals[v + 1], nz = normals[v + 2];
        const off = 0.75 * weights[j] * ((finer[at] - places[v]) * nx + (finer[at + 1] - places[v + 1]) * ny + (finer[at + 2] - places[v + 2]) * nz);
        x -= off * nx;
        y -= off * ny;
        z -= off * nz;
      }
      finer[at] = x;
      finer[at + 1] = y;
      finer[at + 2] = z;
    }
    return finer;
  }
}
