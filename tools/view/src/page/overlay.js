// What is written over the mesh: numbers along the box, and the points that were clicked.

// A step of 1, 2 or 5 times a power of ten that divides a length about so often.
function niceStep(length, times) {
  const rough = length / times, power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5, 10].find((nice) => nice * power >= rough * 0.999) ?? 10);
}

// A number on a scale of such steps.
function told(x, step) {
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  if (Math.abs(x) < step / 1000) return "0";
  if (digits <= 6 && Math.abs(x) < 1e9) return x.toFixed(digits).replace("-", "−");
  const exponent = Math.floor(Math.log10(Math.abs(x)));
  return x.toExponential(Math.max(0, Math.min(15, exponent + digits))).replace("e+", "e").replaceAll("-", "−");
}

// The edge of the box along an axis that is farthest out in the picture, left or below rather than right or
// above, and where its middle is from the middle of the box.
function outerEdge(camera, box, axis) {
  const middle = camera.pixel(between(box.least, box.most, 0.5));
  let best = null;
  for (let bits = 0; bits < 8; bits++) {
    if (bits >> axis & 1) continue;
    const ends = [bits, bits | 1 << axis].map((b) => boxCorner(box, b)), pixels = ends.map((p) => camera.pixel(p));
    if (pixels.some((pixel) => pixel[2] <= 0)) return null;
    const off = [0, 1].map((i) => (pixels[0][i] + pixels[1][i]) / 2 - middle[i]);
    const along = [0, 1].map((i) => pixels[1][i] - pixels[0][i]);
    const aside = Math.abs(off[0] * along[1] - off[1] * along[0]) / (Math.hypot(...along) || 1);
    const far = aside + 0.1 * (off[1] - off[0]);
    if (!best || far > best.far) best = { ends, pixels, off, far };
  }
  return best;
}

function drawAxes(pen, camera, box, { origin, side }, ink) {
  pen.font = "11px system-ui, sans-serif";
  pen.fillStyle = pen.strokeStyle = ink;
  pen.textBaseline = "middle";
  for (let axis = 0; axis < 3; axis++) {
    const edge = outerEdge(camera, box, axis);
    const long = (box.most[axis] - box.least[axis]) * side;
    if (!edge || !(long > 0)) continue;
    const pixels = Math.hypot(edge.pixels[1][0] - edge.pixels[0][0], edge.pixels[1][1] - edge.pixels[0][1]);
    if (pixels < 24) continue;
    const along = [0, 1].map((i) => (edge.pixels[1][i] - edge.pixels[0][i]) / pixels);
    let aside = [-along[1], along[0]];
    if (aside[0] * edge.off[0] + aside[1] * edge.off[1] < 0) aside = aside.map((x) => -x);
    const label = (text, [x, y], far) => {
      pen.textAlign = aside[0] < -0.5 ? "right" : aside[0] > 0.5 ? "left" : "center";
      pen.fillText(text, x + aside[0] * far, y + aside[1] * far);
    };
    const step = niceStep(long, Math.max(1, Math.min(5, pixels / 56)));
    const least = origin[axis] + box.least[axis] * side;
    for (let n = Math.ceil(least / step - 1e-6); n * step <= least + long * (1 + 1e-6); n++) {
      const at = camera.pixel(between(edge.ends[0], edge.ends[1], (n * step - least) / long));
      pen.beginPath();
      pen.moveTo(at[0], at[1]);
      pen.lineTo(at[0] + aside[0] * 5, at[1] + aside[1] * 5);
      pen.stroke();
      label(told(n * step, step), at, aside[0] ** 2 > 0.25 ? 9 : 14);
    }
    const middle = [0, 1].map((i) => (edge.pixels[0][i] + edge.pixels[1][i]) / 2);
    pen.font = "bold 12px system-ui, sans-serif";
    label("xyz"[axis], middle, aside[0] ** 2 > 0.25 ? 50 : 32);
    pen.font = "11px system-ui, sans-serif";
  }
}

// The points that were clicked, and the line between them.
function drawPoints(pen, points, ink, ground) {
  if (points.length > 1) {
    pen.setLineDash([2, 5]);
    pen.strokeStyle = ink;
    pen.beginPath();
    points.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
    pen.stroke();
    pen.setLineDash([]);
  }
  for (const [x, y] of points) {
    pen.beginPath();
    pen.arc(x, y, 4, 0, 7);
    pen.fillStyle = ground;
    pen.fill();
    pen.strokeStyle = ink;
    pen.stroke();
  }
}

