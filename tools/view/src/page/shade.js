// How much of the sky a surface sees: where folds shade each other, and the shadow below, as in pictures. The sky
// is seen from some directions in turn, and from each a map of depths tells what lies behind something else.

// How far from the surface it is asked what the surface sees, in texels.
const OFFSET = 1.5;
// The side of the ground whose shade is known, as a part of the radius of the mesh; in cells; and how far it is below.
const GROUND_SIDE = 5, CELLS = 64, BELOW = 0.02;
// How many cells are averaged on each side to blur the shade of the ground, and how often.
const BLUR = 2, BLURS = 3;
// From how many faces on fewer directions have to do.
const MANY_FACES = 1 << 17;

// Directions all around, and the part of the sky of each: the points of an octahedron whose edges are divided in n.
function directionsAround(n) {
  const all = [], range = Array.from({ length: 2 * n + 1 }, (_, i) => i - n);
  for (const x of range) for (const y of range) for (const z of range) {
    if (Math.abs(x) + Math.abs(y) + Math.abs(z) !== n) continue;
    const far = Math.sqrt(x * x + y * y + z * z);
    all.push({ towards: [x / far, y / far, z / far], weight: 1 / (far * far * far) });
  }
  return all;
}

// The depths of a mesh within the unit sphere, as seen from far away: the largest way towards the eye in each texel.
class DepthMap {
  constructor(side, points, corners, towards) {
    const aside = Math.abs(towards[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], right = unit(cross(aside, towards));
    this.side = side;
    // There are two texels around the sphere, for what is just outside of it.
    this.texel = 2 / (side - 4);
    this.axes = [times(right, 1 / this.texel), times(cross(towards, right), 1 / this.texel), towards];
    this.nearest = new Float64Array(side * side).fill(-Infinity);
    const places = new Float64Array(points.length);
    for (let i = 0; i < points.length; i += 3) this.place(points[i], points[i + 1], points[i + 2], places, i);
    for (let f = 0; f < corners.length; f += 3) this.add(places, 3 * corners[f], 3 * corners[f + 1], 3 * corners[f + 2]);
  }

  // Right and up in texels, and towards the eye.
  place(x, y, z, out, at) {
    const [r, u, t] = this.axes, middle = this.side / 2;
    out[at] = r[0] * x + r[1] * y + r[2] * z + middle;
    out[at + 1] = u[0] * x + u[1] * y + u[2] * z + middle;
    out[at + 2] = t[0] * x + t[1] * y + t[2] * z;
  }

  // Draws a face into all texels whose middle it covers.
  add(p, a, b, c) {
    const { side, nearest } = this, ax = p[a], ay = p[a + 1];
    const ux = p[b] - ax, uy = p[b + 1] - ay, vx = p[c] - ax, vy = p[c + 1] - ay, area = ux * vy - uy * vx;
    if (!area) return;
    const part = 1 / area;
    const left = Math.max(0, Math.floor(Math.min(ax, p[b], p[c]) - 0.5)), right = Math.min(side, Math.max(ax, p[b], p[c]) + 0.5);
    const low = Math.max(0, Math.floor(Math.min(ay, p[b + 1], p[c + 1]) - 0.5)), high = Math.min(side, Math.max(ay, p[b + 1], p[c + 1]) + 0.5);
    const deep = p[a + 2], du = p[b + 2] - deep, dv = p[c + 2] - deep;
    for (let row = low; row < high; row++) {
      const y = row + 0.5 - ay;
      for (let column = left; column < right; column++) {
        const x = column + 0.5 - ax, s = (x * vy - y * vx) * part, t = (ux * y - uy * x) * part;
        if (s < 0 || t < 0 || s + t > 1) continue;
        const near = deep + s * du + t * dv, at = row * side + column;
        if (near > nearest[at]) nearest[at] = near;
      }
    }
  }

  // How much of the eye a point sees: the part of the four texels around it that are not in front of it.
  free(px, py, pz) {
    const { side, nearest, seen } = this;
    this.place(px, py, pz, seen, 0);
    const x = seen[0] - 0.5, y = seen[1] - 0.5, deep = seen[2], i = Math.floor(x), j = Math.floor(y);
    if (!(i >= 0 && j >= 0 && i < side - 1 && j < side - 1)) return 1;
    const at = j * side + i, across = x - i, up = y - j;
    const low = (nearest[at] <= deep) * (1 - across) + (nearest[at + 1] <= deep) * across;
    const high = (nearest[at + side] <= deep) * (1 - across) + (nearest[at + side + 1] <= deep) * across;
    return low * (1 - up) + high * up;
  }
  seen = new Float64Array(3);
}

// What a mesh in a box leaves of the sky: the parts of 255 that the front and the back of each vertex see, and a
// ground just below the box, with the parts that its cells see. What moves has fewer directions.
function skyOf(places, corners, box, upright, isMoving) {
  const middle = between(box.least, box.most, 0.5), radius = Math.hypot(...sub(box.most, middle)) || 1;
  const few = isMoving || corners.length / 3 >= MANY_FACES, side = isMoving ? 128 : 256;
  const points = new Float64Array(places.length), normals = vertexNormals(places, corners);
  for (let i = 0; i < places.length; i++) points[i] = (places[i] - middle[i % 3]) / radius;
  const heights = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => dot(sub(boxCorner(box, bits), middle), upright));
  const below = times(upright, Math.min(...heights) / radius - BELOW);
  const aside = Math.abs(upright[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], across = unit(sub(aside, times(upright, dot(aside, upright))));
  const sides = [across, cross(upright, across)].map((axis) => times(axis, GROUND_SIDE / 2));
  const part = (i) => (2 * i + 1) / CELLS - 1;
  const cellPoint = (cell) => add(below, add(times(sides[0], part(cell % CELLS)), times(sides[1], part(Math.floor(cell / CELLS)))));
  const cellPoints = Array.from({ length: CELLS * CELLS }, (_, cell) => cellPoint(cell));
  const count = places.length / 3, is = new Float64Array(2 * count), could = new Float64Array(2 * count);
  let cells = new Float64Array(CELLS * CELLS), whole = 0;
  for (const { towards, weight } of directionsAround(few ? 2 : 4)) {
    const map = new DepthMap(side, points, corners, towards), [tx, ty, tz] = towards;
    for (let v = 0, i = 0; v < count; v++, i += 3) {
      const cosine = normals[i] * tx + normals[i + 1] * ty + normals[i + 2] * tz, share = weight * Math.abs(cosine);
      const off = (cosine < 0 ? -OFFSET : OFFSET) * map.texel, at = cosine < 0 ? count + v : v;
      could[at] += share;
      is[at] += share * map.free(points[i] + normals[i] * off, points[i + 1] + normals[i + 1] * off, points[i + 2] + normals[i + 2] * off);
    }
    const cosine = dot(upright, towards);
    if (!(cosine > 0)) continue;
    // Once for the slope, and once for a sky that is brighter overhead.
    whole += weight * cosine * cosine;
    for (let cell = 0; cell < cells.length; cell++) cells[cell] += weight * cosine * cosine * map.free(...cellPoints[cell]);
  }
  // Blurs away the borders of the shadow that each direction throws, and of the part that is known.
  for (let blur = 0; blur < 2 * BLURS; blur++) {
    const step = blur % 2 ? CELLS : 1, before = cells;
    cells = before.map((_, cell) => {
      const at = Math.floor(cell / step) % CELLS, from = Math.max(at - BLUR, 0), to = Math.min(at + BLUR, CELLS - 1);
      let sum = 0;
      for (let other = from; other <= to; other++) sum += before[cell + (other - at) * step];
      return sum / (to - from + 1);
    });
  }
  const near = (cell) => Math.max(0, 1 - part(cell % CELLS) ** 2 - part(Math.floor(cell / CELLS)) ** 2);
  const parts = Uint8Array.from(is, (sum, i) => Math.round(255 * (could[i] > 0 ? sum / could[i] : 1)));
  return {
    front: parts.subarray(0, count),
    back: parts.subarray(count),
    ground: {
      middle: add(middle, times(below, radius)),
      sides: sides.map((axis) => times(axis, radius)),
      cells: Uint8Array.from(cells, (sum, cell) => Math.round(255 * (1 - (1 - sum / whole) * near(cell)))),
    },
  };
}
