// Lines over time, as SVG. A click goes to that time.
function svg(name, attributes, parent, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  parent?.append(element);
  return element;
}

class Chart {
  constructor(parent, { name, unit, lines }, until, colors, seek) {
    const [width, height] = [288, 120];
    const [left, right, top, bottom] = [38, width - 6, 20, height - 16];
    const values = lines.flatMap((line) => line.points.map((point) => point[1])).filter(Number.isFinite);
    const [least, most] = [Math.min(0, ...values), Math.max(0, ...values) || 1];
    const step = niceStep(most - least, 3), upper = Math.ceil(most / step - 1e-9) * step;
    this.x = (t) => left + (right - left) * (until > 0 ? t / until : 0);
    const y = (value) => bottom - (bottom - top) * (value - least) / (upper - least);
    const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": name }, parent);
    svg("text", { x: 0, y: 12, class: "name" }, root, unit ? `${name}, ${unit}` : name);
    for (let n = Math.ceil(least / step - 1e-9); n * step <= upper * (1 + 1e-9); n++) {
      svg("line", { x1: left, x2: right, y1: y(n * step), y2: y(n * step), class: "rule" }, root);
      svg("text", { x: left - 4, y: y(n * step) + 4, "text-anchor": "end" }, root, told(n * step, step));
    }
    const second = niceStep(until || 1, 4);
    for (let n = 0; n * second <= until * (1 + 1e-9); n++) {
      svg("text", { x: this.x(n * second), y: height - 2, "text-anchor": !n ? "start" : this.x(n * second) > right - 12 ? "end" : "middle" }, root, `${told(n * second, second)} s`);
    }
    lines.forEach((line, i) => {
      const points = line.points.filter((point) => Number.isFinite(point[1]));
      const drawn = points.map(([t, value]) => `${this.x(t).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
      const stroke = `rgb(${colors[i % colors.length]})`;
      svg("polyline", { points: drawn, style: `stroke: ${stroke}` }, root);
      if (lines.length > 1) svg("text", { x: right - 46 * (lines.length - 1 - i), y: 12, "text-anchor": "end", style: `fill: ${stroke}` }, root, line.name);
    });
    this.now = svg("line", { y1: top, y2: bottom, class: "now" }, root);
    const go = (event) => {
      const box = root.getBoundingClientRect();
      const at = (event.clientX - box.left) / box.width * width;
      seek(Math.max(0, Math.min(1, (at - left) / (right - left))) * until);
    };
    root.addEventListener("pointerdown", (event) => {
      root.setPointerCapture(event.pointerId);
      go(event);
    });
    root.addEventListener("pointermove", (event) => { if (event.buttons) go(event); });
  }

  show(seconds) {
    this.now.setAttribute("x1", this.x(seconds));
    this.now.setAttribute("x2", this.x(seconds));
  }
}

