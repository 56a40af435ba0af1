// What the page shows: a text in JSON, and the faces and places of every moment behind it, and of solids. Places
// are counted from the corner of the box, in its longest side.
const STEPS = 65536;

async function unpack() {
  const { data, bytes } = await unpackedData();
  data.solids ??= [];
  data.states = readStates(bytes.subarray(0, data.faceBytes), data);
  readPlaces(bytes.subarray(data.faceBytes), [...data.moments, ...data.solids]);
  const rate = data.moments.length < data.few ? 1 : data.rate;
  data.moments.forEach((moment, number) => Object.assign(moment, { number, seconds: moment.time ?? number / rate }));
  return data;
}

const unfolded = (x) => (x & 1 ? -(x + 1) / 2 : x / 2);

// The faces of every state, each as what changed since the one before, and the corners of solids.
function readStates(bytes, { states: count, solids }) {
  let at = 0;
  const number = () => {
    let sum = 0, place = 1, byte;
    do {
      byte = bytes[at++];
      sum += (byte & 127) * place;
      place *= 128;
    } while (byte & 128);
    return sum;
  };
  const changed = (before) => {
    const now = new Uint32Array(number());
    now.set(before.subarray(0, now.length));
    for (let i = 0, last = 0; i < now.length;) {
      i += number();
      for (let run = number(); run > 0; run--) now[i++] = last += unfolded(number());
    }
    return now;
  };
  const none = new Uint32Array(0);
  let state = { corners: none, kinds: none, pieces: none };
  const states = Array.from({ length: count }, () => {
    state = { corners: changed(state.corners), kinds: changed(state.kinds), pieces: changed(state.pieces) };
    return state;
  });
  for (const solid of solids) solid.corners = changed(none);
  return states;
}

// Puts `places` into each moment, and into each solid behind them: three numbers a vertex.
function readPlaces(bytes, moments) {
  const first = 3 * moments[0].vertices;
  const floats = new Float32Array(first), raw = new Uint8Array(floats.buffer);
  for (let i = 0; i < first; i++) {
    for (let byte = 0; byte < 4; byte++) raw[4 * i + byte] = bytes[byte * first + i];
  }
  moments[0].places = new Float64Array(first);
  for (let axis = 0; axis < 3; axis++) {
    for (let v = 0; v < moments[0].vertices; v++) moments[0].places[3 * v + axis] = floats[axis * moments[0].vertices + v];
  }
  const planes = bytes.subarray(4 * first), total = planes.length / 3;
  let at = 0, was = moments[0].places.map((x) => Math.round(x * STEPS));
  for (let m = 1; m < moments.length; m++) {
    const { vertices } = moments[m], now = new Float64Array(3 * vertices);
    for (let axis = 0; axis < 3; axis++) {
      for (let v = 0, moved = 0; v < vertices; v++, at++) {
        moved += unfolded(planes[at] + 256 * planes[total + at] + 65536 * planes[2 * total + at]);
        now[3 * v + axis] = (was[3 * v + axis] ?? 0) + moved;
      }
    }
    moments[m].places = now.map((x) => x / STEPS);
    was = now;
  }
}

// What is drawn at a moment: its mesh, and behind that the solids, where they are then.
function drawnAt(moment, { states, solids }) {
  let { corners, kinds, pieces } = states[moment.state], { places } = moment;
  for (const solid of solids) {
    const [xx, xy, xz, yx, yy, yz, zx, zy, zz, ...off] = solid.placings[moment.number];
    const p = solid.places, placed = new Float64Array(p.length), first = places.length / 3;
    for (let i = 0; i < p.length; i += 3) {
      placed[i] = xx * p[i] + yx * p[i + 1] + zx * p[i + 2] + off[0];
      placed[i + 1] = xy * p[i] + yy * p[i + 1] + zy * p[i + 2] + off[1];
      placed[i + 2] = xz * p[i] + yz * p[i + 1] + zz * p[i + 2] + off[2];
    }
    corners = joined(corners, solid.corners.map((v) => first + v));
    places = joined(places, placed);
  }
  return { corners, kinds, pieces, places };
}

// The box round some moments, but for crumbs: pieces that have come off since the first of all, and have less than a
// tenth of the faces.
function boxOfMoments(shown, data) {
  const { states, moments } = data, first = new Set(states[moments[0].state].pieces);
  const box = { least: [Infinity, Infinity, Infinity], most: [-Infinity, -Infinity, -Infinity] };
  for (const number of new Set(shown.map((moment) => moment.state))) {
    const { corners, pieces } = states[number], faces = new Map();
    for (const piece of pieces) faces.set(piece, (faces.get(piece) ?? 0) + 1);
    const large = corners.filter((_, corner) => {
      const piece = pieces[corner / 3 | 0];
      return first.has(piece) || 10 * faces.get(piece) >= pieces.length;
    });
    for (const moment of shown.filter((moment) => moment.state === number)) {
      const drawn = drawnAt(moment, data);
      for (const some of [large, drawn.corners.subarray(corners.length)]) {
        const { least, most } = boxOf(drawn.places, some);
        box.least = box.least.map((x, axis) => Math.min(x, least[axis]));
        box.most = box.most.map((x, axis) => Math.max(x, most[axis]));
      }
    }
  }
  return box;
}
