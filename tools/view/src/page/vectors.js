// Vectors are arrays of three numbers.
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => times(a, 1 / Math.hypot(...a));
const between = (a, b, t) => add(a, times(sub(b, a), t));

// The box round the vertices of some faces: its corners with the smallest and the largest coordinates.
function boxOf(places, corners) {
  const least = [Infinity, Infinity, Infinity], most = [-Infinity, -Infinity, -Infinity];
  for (const v of corners) {
    for (let axis = 0; axis < 3; axis++) {
      const x = places[3 * v + axis];
      if (x < least[axis]) least[axis] = x;
      if (x > most[axis]) most[axis] = x;
    }
  }
  return { least, most };
}

const boxCorner = ({ least, most }, bits) => [0, 1, 2].map((axis) => (bits >> axis & 1 ? most : least)[axis]);

// The numbers of two typed arrays, one behind the other.
function joined(a, b) {
  const all = new a.constructor(a.length + b.length);
  all.set(a);
  all.set(b, a.length);
  return all;
}
