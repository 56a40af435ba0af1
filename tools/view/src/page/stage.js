// What every page does with its stage and beside it: words, theme, size, pointers and keys.
const $ = (id) => document.getElementById(id);

// The table of the mesh: names, and what they are.
function tellRows(rows) {
  $("facts").replaceChildren(...rows.flatMap((row) => row.map((text, i) => {
    const cell = document.createElement(i ? "dd" : "dt");
    cell.textContent = text;
    return cell;
  })));
}

// Copies the line of a cut, and says whether it could.
async function copyLine() {
  getSelection().selectAllChildren($("line"));
  const isCopied = await navigator.clipboard?.writeText($("line").textContent).then(() => true, () => false);
  return isCopied || document.execCommand("copy") ? "Copied." : "Press Ctrl+C to copy the line.";
}

// Light or dark: as the browser prefers it, until it is turned.
class Theme {
  constructor(both, changed) {
    const prefersDark = matchMedia("(prefers-color-scheme: dark)");
    Object.assign(this, { both, changed });
    prefersDark.addEventListener("change", () => this.set(prefersDark.matches));
    this.set(prefersDark.matches);
  }

  set(isDark) {
    const root = document.documentElement;
    this.isDark = isDark;
    this.colors = isDark ? this.both.dark : this.both.light;
    root.classList.toggle("dark", isDark);
    for (const [name, color] of [["ground", "background"], ["accent", "trace"], ["seam", "seam"]]) {
      root.style.setProperty(`--${name}`, `rgb(${this.colors[color]})`);
    }
    this.changed();
  }
}

// Wipes off what is written over the mesh; the colours to write with.
function wiped(pen, { size }) {
  const ratio = pen.canvas.width / size[0], style = getComputedStyle(document.documentElement);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, ...size);
  return ["--ink", "--faint", "--panel"].map((name) => style.getPropertyValue(name));
}

const stageSize = () => [$("stage").clientWidth || 1, $("stage").clientHeight || 1];

// Has both canvases and the camera follow the size of the stage.
function followSize(camera, draw) {
  const resize = () => {
    const size = stageSize(), ratio = Math.min(devicePixelRatio, 2);
    for (const canvas of [$("scene"), $("marks")]) [canvas.width, canvas.height] = size.map((side) => Math.round(side * ratio));
    camera.size = size;
    draw();
  };
  new ResizeObserver(resize).observe($("stage"));
}

// Where a pointer is on the stage, and whether it has moved since it came down: a finger that clicks trembles.
function placeOf({ clientX, clientY }) {
  const { left, top } = $("scene").getBoundingClientRect();
  return [clientX - left, clientY - top];
}
const isMoved = (start, pixel, { pointerType }) => Math.hypot(pixel[0] - start[0], pixel[1] - start[1]) >= (pointerType === "touch" ? 9 : 4);
const buttonOf = (event) => event.button || (event.shiftKey || event.ctrlKey ? 2 : 0);

// One of two pointers goes somewhere, and both pan and zoom.
function moveByTwo(camera, pointers, id, pixel) {
  const spread = () => {
    const [a, b] = [...pointers.values()];
    return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], wide: Math.hypot(a[0] - b[0], a[1] - b[1]) };
  };
  const before = spread();
  pointers.set(id, pixel);
  const after = spread();
  camera.pan(after.middle[0] - before.middle[0], after.middle[1] - before.middle[1]);
  camera.zoom(before.wide / Math.max(after.wide, 1), after.middle);
}

// The wheel zooms, and arrows turn; all other keys are for `press`, which says whether it knows one.
function listen(camera, press, changed) {
  const canvas = $("scene");
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    // Two fingers that spread on a touchpad come as small steps of a wheel, with Ctrl.
    const speed = [0.0015, 0.03, 0.5][event.deltaMode] * (event.ctrlKey ? 6 : 1);
    camera.zoom(Math.exp(event.deltaY * speed), placeOf(event));
    changed();
  }, { passive: false });
  // After a click on a button, a box or the slider, or a choice, keys are the page's; where one is reached by keys,
  // they are its own.
  addEventListener("click", ({ detail, target }) => {
    if (detail && target.matches("button, summary, #front, #time")) canvas.focus({ preventScroll: true });
  });
  addEventListener("change", ({ target }) => { if (target.matches("select")) target.blur(); });
  const isTyped = ({ key, target }) => target.matches("select, #gap") || target.matches("button, summary, input") && !/^([a-z]|Escape)$/i.test(key);
  const turns = { ArrowLeft: [20, 0], ArrowRight: [-20, 0], ArrowUp: [0, 20], ArrowDown: [0, -20] };
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyped(event)) return;
    if (!press(event.key.length === 1 ? event.key.toLowerCase() : event.key)) {
      if (!turns[event.key]) return;
      camera.turn(...turns[event.key]);
    }
    changed();
    event.preventDefault();
  });
}
