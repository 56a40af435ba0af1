// Cuts that could be made: their rays as they are typed, and where they would go.

// How far in pixels a cut may be from where it was shown, and how far its ends go for each part of an edge that
// is given to --snap.
const OFF = 1.2, TIP = 2.6;

// A number that is a few hundredths of a step off at most, with no more digits than that needs.
const rounded = (x, step) => Number(x.toFixed(Math.max(0, Math.min(100, 2 - Math.floor(Math.log10(step)))))) || 0;

// A point as it is typed, to a hundredth of a pixel.
const pointTyped = (p, camera, { origin, side }) => p.map((x, axis) => rounded(origin[axis] + side * x, side * camera.distance * camera.pixelAngle));

// The rays of a cut from the eye of a camera through two points, to a hundredth of a pixel.
function raysThrough(camera, targets, lattice) {
  const from = pointTyped(camera.eye, camera, lattice), { origin, side } = lattice;
  const rays = targets.map((target) => unit(sub(target, camera.eye)).map((x) => rounded(x, camera.pixelAngle)));
  // What is shown is what the typed numbers say.
  return { from, rays, eye: from.map((x, axis) => (x - origin[axis]) / side) };
}

const raysTyped = ({ from, rays }) => `--rays ${rays.map((ray) => `${from}:${ray}`).join(" ")}`;

// Where the plane of two rays meets the faces between them: the ends of a segment a face. Points on the plane
// count as in front of it.
function traceOf({ eye, rays }, places, { corners, kinds }, isFront) {
  const normal = cross(...rays), sides = [cross(normal, rays[0]), cross(rays[1], normal)];
  if (!(Math.hypot(...normal) > 0)) return { segments: [], faces: [] };
  const count = places.length / 3, offsets = new Float64Array(count);
  for (let v = 0; v < count; v++) {
    offsets[v] = (places[3 * v] - eye[0]) * normal[0] + (places[3 * v + 1] - eye[1]) * normal[1] + (places[3 * v + 2] - eye[2]) * normal[2];
  }
  const point = (v) => [places[3 * v], places[3 * v + 1], places[3 * v + 2]];
  // A vertex on the plane, or an edge between two faces.
  const nodeOf = (h, v, w) => {
    if (offsets[v] === 0) return -1 - v;
    if (offsets[w] === 0) return -1 - w;
    return kinds[h] ? null : Math.min(v, w) * count + Math.max(v, w);
  };
  const pieces = [];
  for (let face = 0; face < corners.length; face += 3) {
    const behind = [0, 1, 2].map((i) => offsets[corners[face + i]] < 0);
    if (behind[0] === behind[1] && behind[1] === behind[2]) continue;
    const line = [], ends = [];
    for (let i = 0; i < 3; i++) {
      const [v, w] = [corners[face + i], corners[face + (i + 1) % 3]];
      if (behind[i] === behind[(i + 1) % 3]) continue;
      line.push(between(point(v), point(w), offsets[v] / (offsets[v] - offsets[w])));
      ends.push(nodeOf(face + i, v, w));
    }
    let segment = line;
    for (const side of sides) segment = segment && inFront(segment, side, eye);
    // Where a ray ends a segment, no other goes on.
    if (segment) pieces.push({ face, line, segment, nodes: ends.filter((node, i) => node !== null && segment[i] === line[i]) });
  }
  const chosen = isFront ? firstLayers(pieces, eye, rays, sides) : pieces;
  return { segments: chosen.map((piece) => piece.segment), faces: chosen.map((piece) => piece.face) };
}

// What `--layers first` cuts: all that hangs together, from node to node, with what the first ray hits first,
// and the same of the second. A ray that misses turns towards the other until it hits.
function firstLayers(pieces, eye, rays, sides) {
  const around = new Map(), chosen = new Set();
  for (const piece of pieces) {
    for (const node of piece.nodes) around.set(node, [...(around.get(node) ?? []), piece]);
  }
  rays.forEach((ray, i) => {
    let first, least = Infinity;
    const take = (piece, far) => { if (far < least) [first, least] = [piece, far]; };
    const from = (p) => sub(p, eye);
    for (const piece of pieces) {
      const [d, e] = piece.line.map((p) => dot(from(p), sides[i]));
      const far = dot(from(between(...piece.line, d / (d - e))), ray);
      if ((d < 0) !== (e < 0) && far >= 0) take(piece, far);
    }
    for (const piece of first ? [] : pieces) {
      for (const p of piece.segment) {
        const [own, other] = [sides[i], sides[1 - i]].map((side) => Math.max(0, dot(from(p), side)));
        const part = own / (own + other) || 0;
        if (dot(from(p), between(ray, rays[1 - i], part)) >= 0) take(piece, part);
      }
    }
    for (const open = first ? [first] : []; open.length;) {
      const piece = open.pop();
      if (chosen.has(piece)) continue;
      chosen.add(piece);
      for (const node of piece.nodes) open.push(...around.get(node));
    }
  });
  return pieces.filter((piece) => chosen.has(piece));
}

function inFront([p, q], normal, from) {
  const [d, e] = [dot(sub(p, from), normal), dot(sub(q, from), normal)];
  if (d < 0 && e < 0) return null;
  if (d < 0) return [between(p, q, d / (d - e)), q];
  if (e < 0) return [p, between(p, q, d / (d - e))];
  return [p, q];
}

// The part of an edge within which a cut may take an end of it for a crossing, so that it goes where it was
// shown: less than usual where edges are long in the picture, and none where nothing else would be left of it.
function snapFor({ segments, faces }, places, corners, camera, usual) {
  let seen = 0, edge = 0;
  for (const f of faces) {
    const ends = [0, 1, 2].map((i) => [0, 1, 2].map((axis) => places[3 * corners[f + i] + axis]));
    const pixels = ends.map((p) => camera.pixel(p));
    for (let i = 0; i < 3; i++) {
      const j = (i + 1) % 3, [a, b] = [pixels[i], pixels[j]];
      seen = Math.max(seen, a[2] > 0 && b[2] > 0 ? Math.hypot(a[0] - b[0], a[1] - b[1]) : Infinity);
      edge = Math.max(edge, Math.hypot(...sub(ends[i], ends[j])));
    }
  }
  const longest = segments.reduce((most, [p, q]) => Math.max(most, Math.hypot(...sub(p, q))), 0);
  const snap = OFF / (TIP * seen);
  if (longest < 4 * Math.min(snap, usual) * edge) return 0;
  return snap < usual ? Number(snap.toPrecision(1)) : usual;
}

// How far along a ray the first face is; none if it meets none.
function firstHit(eye, direction, places, corners) {
  let first = Infinity;
  for (let f = 0; f < corners.length; f += 3) {
    const [i, j, k] = [3 * corners[f], 3 * corners[f + 1], 3 * corners[f + 2]];
    const ux = places[j] - places[i], uy = places[j + 1] - places[i + 1], uz = places[j + 2] - places[i + 2];
    const vx = places[k] - places[i], vy = places[k + 1] - places[i + 1], vz = places[k + 2] - places[i + 2];
    const px = direction[1] * vz - direction[2] * vy, py = direction[2] * vx - direction[0] * vz, pz = direction[0] * vy - direction[1] * vx;
    const volume = ux * px + uy * py + uz * pz;
    if (volume === 0) continue;
    const tx = eye[0] - places[i], ty = eye[1] - places[i + 1], tz = eye[2] - places[i + 2];
    const s = (tx * px + ty * py + tz * pz) / volume;
    if (s < 0 || s > 1) continue;
    const qx = ty * uz - tz * uy, qy = tz * ux - tx * uz, qz = tx * uy - ty * ux;
    const t = (direction[0] * qx + direction[1] * qy + direction[2] * qz) / volume;
    const far = (vx * qx + vy * qy + vz * qz) / volume;
    if (t >= 0 && s + t <= 1 && far > 0 && far < first) first = far;
  }
  return Number.isFinite(first) ? first : null;
}

