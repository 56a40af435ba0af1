// The page that is played: what the pointers and buttons do to the cloth, and what is shown.
const short = (x) => String(Number(x.toPrecision(4))).replace("-", "−");

// A frame may take so much time for the cloth; the rest is for drawing. More steps than fit are left out, so that
// time slows down, and the cloth stays what it is.
const BUDGET_MS = 12, LONGEST_S = 1 / 20, FRAME_MS = 1000 / 60;
// The force of the wind that is chosen, in kg/(m² s): that of the scene `flag`.
const WIND = 1.5;

async function open() {
  if (!("DecompressionStream" in window)) throw new Error("This page needs a browser of 2023 or later.");
  const [{ data, bytes }, wasm] = await Promise.all([unpackedData(), unpacked("module", "gzip")]);
  const cloth = await Cloth.load(wasm);
  const canvas = $("scene"), pen = $("marks").getContext("2d");
  const camera = new Camera([0, 1, 0], [0, 0, 1], data.angle);
  const scene = new Scene(canvas, () => {
    topology = "";
    refresh();
  });
  const theme = new Theme(data.colors, () => {});
  let file = null, hasEdges = false, mode = "hand", isPaused = false, isStopped = false;
  let lattice, box, places, corners, facts, topology = "";
  // The first point of a cut, a line that is being drawn, and the OBJ file before the last cut.
  let first = null, drawn = null, before = null;

  let sayUntil = 0;
  const say = (text, seconds = 6) => {
    $("say").textContent = text;
    sayUntil = text ? performance.now() + seconds * 1000 : 0;
  };
  // Does something that the cloth may refuse; undefined if it did.
  const tried = (act) => {
    try {
      return act();
    } catch (error) {
      say(`${error.message}.`.replace(/\.+$/, "."));
      // A module that panicked has no state to go on from.
      if (error instanceof WebAssembly.RuntimeError) {
        isStopped = true;
        say("The simulation ended by an error of its own. Load the page again.", 3600);
      }
    }
  };

  // ---- The cloth

  const name = () => (file ? file.name : `sheet-${$("source").value}.obj`);
  const stem = () => name().replace(/\.obj$/i, "");

  const isOfFile = () => $("held").value.startsWith("file ");

  function start() {
    const values = Object.fromEntries(["held", "up", "method", "threshold"].map((id) => [id, $(id).value]));
    const source = $("source").value;
    // The scene of a file is of its own mesh.
    if (isOfFile() && !(source === "file" && file.name === data.file)) values.held = $("held").value = "rip";
    const settings = `cloth ${source === "file" ? `file ${file.name}` : `sheet ${source}`}\nscene ${values.held}\nup ${values.up}\nmethod ${values.method}\nthreshold ${values.threshold}\n`;
    const isStarted = tried(() => (cloth.start(settings), true)) ?? false;
    if (isStarted) begin();
    return isStarted;
  }

  // Shows a cloth that has just begun, or was replayed.
  function begin() {
    say("");
    hands.clear();
    first = drawn = before = null;
    isStopped = false;
    topology = "";
    $("made").hidden = true;
    $("hint").textContent = "Choose Cut, and draw a line through the cloth.";
    const raw = cloth.positions, all = boxOf(raw, cloth.indices);
    const side = Math.max(...sub(all.most, all.least)) || 1;
    lattice = { origin: add(cloth.facts.origin, all.least), corner: all.least, side };
    refresh();
    aim();
    const up = $("up").selectedOptions[0].textContent;
    const held = facts.heldFirst === 0 ? `Nothing holds it${isOfFile() ? "" : "; the floor is half its size below"}.`
      : $("held").value === "rip" ? `Held by its highest 3 % along ${up}: ${facts.heldFirst} vertices.`
      : `Held by ${facts.heldFirst} vertices.`;
    $("holds").textContent = held + (side > 20 ? ` It is ${short(side)} m long: is the file in millimetres?` : "");
    if ($("wind").value !== "scene") blow();
    slow.length = 0;
    cost = told = 0;
  }

  // Looks at the broad side, a little from the side and from above.
  function aim() {
    const up = $("up").value, axis = "xyz".indexOf(up.at(-1)), upright = [0, 0, 0];
    upright[axis] = up.length > 1 ? -1 : 1;
    const size = sub(box.most, box.least), level = [0, 1, 2].filter((i) => i !== axis);
    const thin = size[level[0]] < size[level[1]] ? level[0] : level[1];
    const look = times(upright, size[axis] < 0.02 ? 1 : 0.12);
    look[thin] += 1;
    look[level.find((i) => i !== thin)] += 0.3;
    Object.assign(camera, new Camera(upright, look, data.angle), { size: camera.size });
    fit();
  }

  // Sees the cloth, and where it will go: a cloth that nothing holds, down to the floor.
  function fit() {
    const room = times(sub(box.most, box.least), 0.12), down = times(camera.upright, facts.heldFirst || isOfFile() ? 0 : -0.5);
    const seen = { least: sub(box.least, room), most: add(box.most, room) };
    down.forEach((x, axis) => { seen[x < 0 ? "least" : "most"][axis] += x; });
    camera.goHome();
    camera.fit(seen);
  }

  // Takes over where the cloth was drawn last, and its faces once they are others.
  function refresh() {
    facts = cloth.facts;
    const raw = joined(cloth.positions, cloth.solidPositions), { corner, side } = lattice;
    places = new Float64Array(raw.length);
    for (let i = 0; i < raw.length; i++) places[i] = (raw[i] - corner[i % 3]) / side;
    const now = [facts.vertices, facts.faces, facts.pieces, facts.tears, facts.heals, facts.open].join();
    if (now !== topology) {
      topology = now;
      corners = joined(cloth.indices, cloth.solidIndices.map((v) => facts.vertices + v));
      scene.setState({ corners, kinds: cloth.edges, pieces: cloth.pieces });
      pins = Array.from(cloth.held.entries()).filter(([, is]) => is).map(([v]) => v);
    }
    box = boxOf(places, corners);
    scene.setPlaces(places);
  }
  // The vertices that are held.
  let pins = [];

  const world = (p) => p.map((x, axis) => lattice.origin[axis] + x * lattice.side);
  const point = (v) => [places[3 * v], places[3 * v + 1], places[3 * v + 2]];
  const ray = (pixel) => [...world(camera.eye), ...camera.direction(pixel)];

  function blow() {
    const speed = $("wind").value;
    if (speed === "scene") return tried(() => cloth.ask(cloth.wasm.wind_of_scene()));
    const u = times(camera.backward, -Number(speed));
    tried(() => cloth.ask(cloth.wasm.wind(...u, Number(speed) ? WIND : 0)));
    if (Number(speed)) say("It blows away from you.");
  }

  function mend() {
    const pairs = tried(() => cloth.wasm.heal());
    say(pairs > 0 ? `Mending ${pairs} pairs of vertices.` : facts.open ? "It is being mended." : "Nothing is torn.");
  }

  // ---- Hands: each pointer that hits the cloth has one, and leads it in a plane that faces the viewer

  const hands = new Map();

  function grab(id, pixel) {
    if (isStopped) return false;
    const hand = cloth.wasm.grab(...ray(pixel));
    if (hand < 0) {
      const why = cloth.text();
      if (why !== "there is no cloth there") say(`${why}.`);
      return false;
    }
    cloth.wasm.draw();
    const at = sub(cloth.facts.at, lattice.origin).map((x) => x / lattice.side);
    hands.set(id, { hand, pixel, depth: dot(sub(at, camera.eye), camera.backward), from: camera.pixel(at) });
    topology = "";
    return true;
  }

  // Where a hand is to be: under its pointer, as it was grabbed.
  function target({ pixel, depth }) {
    const direction = camera.direction(pixel);
    return add(camera.eye, times(direction, depth / dot(direction, camera.backward)));
  }

  function lead() {
    for (const held of hands.values()) tried(() => cloth.ask(cloth.wasm.lead(held.hand, ...world(target(held)))));
  }

  function release(id) {
    tried(() => cloth.wasm.release(hands.get(id).hand));
    hands.delete(id);
    topology = "";
  }

  function pin(pixel) {
    const is = tried(() => cloth.wasm.pin(...ray(pixel)));
    if (is === -1) say(`${cloth.text()}.`.replace(/^./, (c) => c.toUpperCase()));
    else if (is !== undefined) say(is ? "Pinned." : "Unpinned.");
    topology = "";
  }

  // ---- Cuts

  function cut(a, b) {
    first = null;
    if (Math.hypot(a[0] - b[0], a[1] - b[1]) < 3) return say("These points are too near each other.");
    const directions = [a, b].map((pixel) => camera.direction(pixel));
    const rays = raysThrough(camera, directions.map((d) => add(camera.eye, d)), lattice);
    const isFront = $("front").checked;
    tried(() => {
      const was = cloth.obj();
      const splits = cloth.wasm.cut(...rays.from, ...rays.rays.flat(), isFront);
      if (splits < 0) throw new Error(cloth.text());
      cloth.wasm.draw();
      refresh();
      if (!splits) return say("The line misses the cloth.");
      before = was;
      say(`Cut: ${splits} ${splits === 1 ? "vertex" : "vertices"} split, ${facts.pieces} ${facts.pieces === 1 ? "piece" : "pieces"}.`);
      $("line").textContent = `tearmesh cut ${quoted(`${stem()}-before.obj`)} ${raysTyped(rays)}${isFront ? " --layers first" : ""} -o ${quoted(`${stem()}-cut.obj`)}`;
      $("made").hidden = false;
      $("hint").textContent = `Made at ${facts.time.toFixed(2)} s.`;
    });
  }
  // A name as a shell takes it for one word.
  const quoted = (text) => (/^[\w.,+@%/-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

  // ---- Frames

  // How long the cloth took for 1/60 s, in milliseconds, in each of the last frames; and when frames were shown.
  const slow = [], shown = [];
  let last = 0, cost = 0, passed = 0, wanted = 0, healed = 0;

  function tick(now) {
    requestAnimationFrame(tick);
    const dt = Math.min(Math.max(now - last, 0) / 1000, LONGEST_S);
    last = now;
    shown.push(now);
    if (shown.length > 61) shown.shift();
    if (!isPaused && !isStopped) step(dt * Number($("speed").value));
    if (sayUntil && now > sayUntil) say("");
    draw();
    tell(now);
  }

  function step(dt) {
    lead();
    const begun = performance.now();
    const most = cost > 0 ? Math.max(1, Math.floor(BUDGET_MS / cost)) : 8;
    const timeBefore = facts.time;
    const steps = tried(() => cloth.wasm.advance(dt, most));
    if (steps === -1) {
      isPaused = isStopped = true;
      say(`The simulation stopped: ${cloth.text()}. Reset begins again.`, 3600);
    }
    tried(() => cloth.wasm.draw());
    const took = performance.now() - begun;
    if (steps > 0) {
      cost = cost > 0 ? cost + 0.1 * (took / steps - cost) : took / steps;
      slow.push(took / (60 * steps * facts.step));
      if (slow.length > 120) slow.shift();
    }
    refresh();
    passed += 0.05 * (facts.time - timeBefore - passed);
    wanted += 0.05 * (dt - wanted);
    if (facts.heals > healed) say(`Mended ${facts.sewn} pairs of vertices${facts.left ? `; ${facts.left} were held apart` : ""}.`);
    healed = facts.heals;
  }

  const quantile = (numbers, part) => [...numbers].sort((a, b) => a - b)[Math.floor(part * (numbers.length - 1))] ?? 0;

  let told = 0;
  function tell(now) {
    if (now - told < 200) return;
    told = now;
    const p95 = quantile(slow, 0.95), rate = shown.length > 1 ? 1000 * (shown.length - 1) / (now - shown[0] || 1) : 60;
    document.body.dataset.p95 = p95.toFixed(2);
    document.body.dataset.median = quantile(slow, 0.5).toFixed(2);
    const isSlow = rate < 57 || p95 > FRAME_MS;
    const share = wanted > 0 ? Math.min(1, passed / wanted) : 1;
    $("slow").textContent = isSlow && !isPaused ? `${Math.round(rate)} frames/s · p95 of the cloth for 1/60 s ${p95.toFixed(1)} ms${share < 0.95 ? ` · time at × ${share.toFixed(2)}` : ""}` : "";
    tellRows([
      ["time", `${facts.time.toFixed(2)} s`], ["vertices", facts.vertices], ["faces", facts.faces], ["pieces", facts.pieces],
      ["tears", facts.tears], ["pins", pins.length], ["step", `${short(facts.step * 1000)} ms`], ["size", `${short(lattice.side)} m`],
    ]);
  }

  function draw() {
    const { colors } = theme;
    scene.begin(colors.background);
    scene.drawFaces(camera, box, data.colors.pieces, data.light);
    if (hasEdges) scene.drawEdges(camera, box, colors.edge, 0.45);
    scene.drawLines("boundary", camera, box, colors.boundary, 1.7);
    scene.drawLines("seam", camera, box, colors.seam, 2);
    const [ink, faint, panel] = wiped(pen, camera);
    pen.fillStyle = faint;
    for (const v of pins) {
      const [x, y, z] = camera.pixel(point(v));
      if (z > 0) pen.fillRect(x - 1.5, y - 1.5, 3, 3);
    }
    for (const held of hands.values()) drawPoints(pen, [held.pixel], ink, panel);
    const points = drawn ?? (first ? (hover ? [first, hover] : [first]) : []);
    drawPoints(pen, points, ink, panel);
  }

  // ---- Pointers

  const pointers = new Map();
  let hover = null, pressed = null;

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    const pixel = placeOf(event), isFirst = pointers.size + hands.size === 0;
    const button = buttonOf(event);
    if (button === 0 && mode === "hand" && !pointers.size && grab(event.pointerId, pixel)) return hold();
    pointers.set(event.pointerId, pixel);
    // Two fingers that cut nothing move the view.
    pressed = isFirst && button === 0 && mode !== "hand" ? { id: event.pointerId, start: pixel, isMoved: false } : null;
    drawn = null;
    buttons = button;
  });
  let buttons = 0;
  const hold = () => canvas.classList.toggle("holding", hands.size > 0);
  canvas.addEventListener("pointermove", (event) => {
    const is = placeOf(event), was = pointers.get(event.pointerId);
    hover = event.pointerType === "touch" ? null : is;
    if (hands.has(event.pointerId)) hands.get(event.pointerId).pixel = is;
    if (!was) return;
    if (pointers.size === 2) return moveByTwo(camera, pointers, event.pointerId, is);
    pointers.set(event.pointerId, is);
    const [dx, dy] = [is[0] - was[0], is[1] - was[1]];
    if (pressed) {
      pressed.isMoved ||= isMoved(pressed.start, is, event);
      if (mode === "cut" && pressed.isMoved) drawn = [pressed.start, is];
    } else if (buttons) {
      camera.pan(dx, dy);
    } else {
      camera.turn(dx, dy);
    }
  });
  const up = (event) => {
    if (hands.has(event.pointerId)) {
      release(event.pointerId);
      return hold();
    }
    if (!pointers.delete(event.pointerId)) return;
    const done = pressed, line = drawn;
    pressed = drawn = null;
    if (event.type !== "pointerup" || done?.id !== event.pointerId) return;
    if (line) return cut(...line);
    if (done.isMoved) return;
    if (mode === "pin") return pin(done.start);
    if (first) return cut(first, done.start);
    first = done.start;
    say("Click the other end of the cut.");
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => { hover = null; });

  // ---- Buttons, choices and keys

  const choose = (chosen) => {
    mode = chosen;
    first = drawn = null;
    for (const id of ["hand", "cut", "pin"]) {
      $(id).setAttribute("aria-pressed", id === mode);
      canvas.classList.toggle(id, id === mode);
    }
    const hints = { hand: "", cut: "Draw a line through the cloth, or click its two ends.", pin: "Click the cloth to pin it, or to unpin it." };
    say(hints[mode]);
  };
  const pause = (is) => {
    isPaused = is;
    $("pause").textContent = is ? "Go on" : "Pause";
  };
  const actions = {
    hand: () => choose("hand"),
    cut: () => choose("cut"),
    pin: () => choose("pin"),
    mend,
    pause: () => pause(!isPaused && !isStopped),
    reset: () => {
      pause(false);
      start();
    },
    fit,
    edges: () => $("edges").setAttribute("aria-pressed", hasEdges = !hasEdges),
    finer: () => {
      $("finer").setAttribute("aria-pressed", scene.isFiner = !scene.isFiner);
      topology = "";
      refresh();
    },
    theme: () => theme.set(!theme.isDark),
    copy: () => copyLine().then(say),
    before: () => save(before, `${stem()}-before.obj`),
    save: () => tried(() => save(cloth.obj(), `${stem()}-torn.obj`)),
    record: () => tried(() => {
      save(cloth.log(), `${stem()}.log`);
      say(`Saved at ${facts.time.toFixed(2)} s: digest ${cloth.digest()}.`, 60);
    }),
    open: () => $("drop").click(),
  };
  for (const [id, action] of Object.entries(actions)) $(id).addEventListener("click", action);
  for (const id of ["held", "up", "method", "threshold"]) {
    $(id).addEventListener("change", () => {
      if (id === "held") $("wind").value = "scene";
      actions.reset();
    });
  }
  $("source").addEventListener("change", actions.reset);
  $("wind").addEventListener("change", blow);
  const keys = { h: "hand", c: "cut", m: "mend", " ": "pause", r: "reset", f: "fit", e: "edges", n: "finer", t: "theme" };
  listen(camera, (key) => {
    if (keys[key]) actions[keys[key]]();
    else if (key === "p") hover ? pin(hover) : choose("pin");
    else if (key === "Escape") first = drawn = null;
    else return false;
    return true;
  }, () => {});

  // ---- Files

  function save(bytes, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  function use(bytes, name) {
    cloth.file(bytes);
    file = { name: name.replaceAll("\n", " "), bytes };
    let option = $("source").querySelector("[value=file]");
    if (!option) {
      option = new Option("", "file");
      $("source").prepend(option);
    }
    option.textContent = file.name;
    $("source").value = "file";
    $("title").textContent = file.name;
  }

  async function take(dropped) {
    const bytes = new Uint8Array(await dropped.arrayBuffer());
    const head = new TextDecoder().decode(bytes.subarray(0, 16));
    if (head.startsWith("tearmesh play 1")) return replay(new TextDecoder().decode(bytes));
    const had = file, source = $("source").value, held = $("held").value;
    const isTaken = tried(() => (use(bytes, dropped.name), true));
    if (isTaken && start()) return pause(false);
    // A file that is refused changes nothing.
    const why = $("say").textContent;
    if (!isTaken) return say(`${dropped.name}: ${why}`, 30);
    if (had) use(had.bytes, had.name);
    else $("source").querySelector("[value=file]").remove();
    file = had;
    $("source").value = source;
    $("held").value = held;
    $("title").textContent = had ? had.name : data.title;
    say(`${dropped.name}: ${why}`, 30);
  }

  // Repeats a log at once, and shows where it ends.
  function replay(log) {
    say("Repeating …");
    const lines = Object.fromEntries(log.split("\n", 6).slice(1).map((line) => [line.split(" ")[0], line.slice(line.indexOf(" ") + 1)]));
    if (!tried(() => (cloth.replay(log), true))) return;
    const sheet = /^sheet (\d+)$/.exec(lines.cloth);
    $("source").value = sheet ? sheet[1] : "file";
    for (const [id, key] of [["held", "scene"], ["up", "up"], ["method", "method"], ["threshold", "threshold"]]) $(id).value = lines[key];
    $("wind").value = "scene";
    begin();
    pause(true);
    say(`Repeated ${facts.time.toFixed(2)} s: digest ${cloth.digest()}.`, 3600);
  }

  $("drop").addEventListener("change", () => {
    if ($("drop").files.length) take($("drop").files[0]);
    $("drop").value = "";
  });
  const dropping = (is) => (event) => {
    event.preventDefault();
    document.body.classList.toggle("dropping", is);
  };
  addEventListener("dragover", dropping(true));
  addEventListener("dragleave", dropping(false));
  addEventListener("drop", (event) => {
    dropping(false)(event);
    if (event.dataTransfer.files.length) take(event.dataTransfer.files[0]);
  });

  $("title").textContent = data.title;
  camera.size = stageSize();
  if (data.plan) {
    cloth.scene(data.plan);
    $("held").prepend(new Option(data.scene, `file ${data.scene}`));
    // It has a method and rules of its own.
    for (const id of ["method", "threshold"]) {
      $(id).prepend(new Option("of the scene", "scene"));
      $(id).value = "scene";
    }
  }
  $("held").value = data.plan ? `file ${data.scene}` : data.scene;
  $("up").value = data.up;
  if (data.file) use(bytes, data.file);
  choose("hand");
  start();
  if (!facts) return;
  followSize(camera, draw);
  requestAnimationFrame(tick);
  document.body.dataset.ready = "yes";
}

open().catch((error) => { $("say").textContent = error.message; });
