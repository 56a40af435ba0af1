// The page itself: what is clicked and dragged, and what is shown then.
async function open() {
  if (!("DecompressionStream" in window)) throw new Error("This page needs a browser of 2023 or later.");
  const data = await unpack();
  const canvas = $("scene"), pen = $("marks").getContext("2d");
  const camera = new Camera(data.up, data.look, data.angle);
  const { moments, states } = data;
  const isPlayed = moments.length > 1;
  // A simulation or many meshes are a film; a few meshes are looked at one after another.
  const isFilm = moments.length >= data.few || moments[0].time !== null;
  const scene = new Scene(canvas, () => {
    state = "";
    show(now);
  });
  // The box round all that is drawn, and the one that is drawn, which crumbs far away do not widen.
  let now = 0, state = "", box, frame, isDirty = false;
  let hasEdges = false, hasBox = true, isDrawing = false;
  // The points that were clicked, a line that is being drawn, and the cut between them.
  let targets = [], drawn = null, cut = null;

  const say = (text) => { $("say").textContent = text; };
  const redraw = () => {
    if (isDirty) return;
    isDirty = true;
    requestAnimationFrame(draw);
  };
  const theme = new Theme(data.colors, redraw);

  function draw() {
    isDirty = false;
    const { colors } = theme;
    scene.begin(colors.background);
    scene.drawGround(camera, moments[now].sky.ground, data.shadow);
    scene.drawFaces(camera, box, data.colors.pieces, data.light);
    if (hasEdges) scene.drawEdges(camera, box, colors.edge, 0.45);
    if (hasBox) scene.drawLines("box", camera, box, colors.box, 1);
    scene.drawLines("boundary", camera, box, colors.boundary, 1.7);
    scene.drawLines("seam", camera, box, colors.seam, 2.4);
    scene.drawLines("trace", camera, box, colors.trace, 2.4, 0.35);
    scene.drawLines("trace", camera, box, colors.trace, 2.4);
    const [ink, faint, panel] = wiped(pen, camera);
    if (hasBox) drawAxes(pen, camera, frame, data, faint);
    const points = drawn ?? targets.map((p) => camera.pixel(p)).filter((pixel) => pixel[2] > 0);
    drawPoints(pen, points, ink, panel);
    tellView();
  }

  // The box around what is shown: in a film, around all moments of it.
  let filmBox;
  const seenBox = () => (isFilm ? filmBox ??= boxOfMoments(moments, data) : box);

  // The faces of the moment that is shown, once they are others.
  function load() {
    const moment = moments[now], drawn = drawnAt(moment, data);
    if (state !== `${moment.state} ${moment.vertices}`) {
      state = `${moment.state} ${moment.vertices}`;
      scene.setState(drawn);
    }
    box = boxOf(drawn.places, drawn.corners);
    frame = isFilm ? boxOfMoments([moment], data) : box;
    // All moments of a film are above one ground.
    moment.sky ??= skyOf(drawn.places, drawn.corners, seenBox(), unit(data.up), isFilm);
    scene.setPlaces(drawn.places, moment.sky);
    const edges = [];
    for (let bits = 0; bits < 8; bits++) {
      for (const axis of [1, 2, 4]) if (!(bits & axis)) edges.push(...boxCorner(frame, bits), ...boxCorner(frame, bits | axis));
    }
    scene.setLines("box", edges);
  }

  function show(number) {
    now = number;
    load();
    trace();
    tellFacts();
    if (isPlayed) {
      const { seconds, label, time } = moments[now];
      $("time").value = now;
      $("clock").textContent = time === null ? label : `${seconds.toFixed(2)} s`;
      charts.forEach((chart) => chart.show(seconds));
    }
    redraw();
  }

  // ---- What is said of the mesh

  const pieces = states.map((one) => new Set(one.pieces).size);
  const tornCounts = states.map(({ kinds }) => kinds.filter((kind) => kind === TORN).length);
  // The moments with more torn edges than the one before.
  const tears = moments.flatMap(({ state }, i) => (i && tornCounts[state] > tornCounts[moments[i - 1].state] ? [i] : []));

  function tellFacts() {
    const moment = moments[now], { corners } = states[moment.state], { least, most } = boxOf(moment.places, corners);
    const short = (x, step) => String(rounded(x, step)).replaceAll("-", "−");
    const from = (corner) => corner.map((x, axis) => short(data.origin[axis] + x * data.side, data.side / 10)).join(", ");
    tellRows([
      ...(isPlayed && moment.label ? [["shown", moment.label]] : []),
      ["vertices", moment.vertices], ["faces", corners.length / 3], ["pieces", pieces[moment.state]],
      ["boundary loops", moment.loops], ["torn", moment.torn ? `${short(moment.torn, moment.torn / 10)} long${moment.torn_at_rest ? " at rest" : ""}` : "nothing"],
      ["from", from(least)], ["to", from(most)],
      ...data.facts,
    ]);
  }

  // The picture that `tearmesh render` draws from here.
  function tellView() {
    const file = moments[now].cut;
    $("view").hidden = !file;
    if (!file) return;
    const [eye, at] = [camera.eye, camera.at].map((p) => pointTyped(p, camera, data));
    const up = camera.up.map((x) => rounded(x, camera.pixelAngle));
    $("render").textContent = `tearmesh render ${file[0]} --camera ${eye}@${at} --up ${up} --fov ${data.angle} --size ${camera.size.join("x")} -o view.png`;
  }

  // ---- Cuts

  function choose(pixel) {
    if (targets.length > 1) clear();
    const { places, state } = moments[now];
    const direction = camera.direction(pixel);
    const far = firstHit(camera.eye, direction, places, states[state].corners);
    // What misses the mesh is as far away as what is looked at.
    const level = dot(sub(camera.at, camera.eye), camera.backward) / dot(direction, camera.backward);
    targets.push(add(camera.eye, times(direction, far ?? level)));
    if (targets.length > 1) plan();
    else say("Click the second point.");
    redraw();
  }

  function plan() {
    const [a, b] = targets.map((p) => camera.pixel(p));
    if (Math.hypot(a[0] - b[0], a[1] - b[1]) < 3) {
      targets.pop();
      say("These points are too near each other: click another second point.");
      return;
    }
    cut = raysThrough(camera, targets, data);
    trace(true);
  }

  // Draws where the cut goes in the mesh as it is now, and tells how to make it.
  function trace(isNew = false) {
    const { places, state, cut: file } = moments[now], { corners } = states[state];
    const isFront = $("front").checked;
    const found = cut ? traceOf(cut, places, states[state], isFront) : { segments: [], faces: [] };
    scene.setLines("trace", found.segments.flat(2));
    if (isNew) cut.snap = snapFor(found, places, corners, camera, data.snap);
    const isMade = found.segments.length > 0;
    $("made").hidden = !cut;
    $("hint").hidden = isMade;
    $("line").hidden = $("copy").hidden = !(isMade && file);
    if (!cut) {
      $("hint").textContent = "Click two points, or choose Draw cut and drag a line.";
    } else if (!isMade) {
      $("hint").textContent = "The line misses the mesh: click two other points.";
    } else if (!file) {
      $("hint").hidden = false;
      const last = moments.findLast((moment) => moment.cut);
      $("hint").textContent = "There is no file of this moment to be cut" + (last ? `: go to ${last.label}.` : ".");
    } else {
      const [name, options, output] = file;
      const snap = cut.snap < data.snap ? ` --snap ${cut.snap}` : "";
      const layers = isFront ? " --layers first" : "";
      const gap = $("gap").value && $("gap").validity.valid ? ` --gap ${$("gap").value}%` : "";
      $("line").textContent = `tearmesh cut ${name}${options} ${raysTyped(cut)}${layers}${snap}${gap} -o ${output}`;
    }
    if (isNew) say(isMade ? "" : "The line misses the mesh.");
  }

  function clear() {
    targets = [];
    cut = drawn = null;
    say("");
    trace();
    redraw();
  }

  // ---- Pointers: one turns, two pan and zoom, and one that does not move is a click

  const pointers = new Map();
  let isClick = false, start = null, button = 0;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, placeOf(event));
    isClick = pointers.size === 1;
    start = placeOf(event);
    button = buttonOf(event);
    if (pointers.size > 1) drawn = null;
  });
  canvas.addEventListener("pointermove", (event) => {
    const was = pointers.get(event.pointerId);
    if (!was) return;
    const is = placeOf(event), [dx, dy] = [is[0] - was[0], is[1] - was[1]];
    if (pointers.size === 2) {
      moveByTwo(camera, pointers, event.pointerId, is);
      return redraw();
    }
    pointers.set(event.pointerId, is);
    isClick &&= !isMoved(start, is, event);
    if (isClick) return;
    if (isDrawing && button === 0) drawn = [start, is];
    else if (button === 0) camera.turn(dx, dy);
    else camera.pan(dx, dy);
    redraw();
  });
  const up = (event) => {
    if (!pointers.delete(event.pointerId) || pointers.size) return;
    const line = event.type === "pointerup" && drawn;
    drawn = null;
    if (line) {
      clear();
      line.forEach(choose);
    } else if (isClick && event.type === "pointerup" && button === 0) {
      choose(placeOf(event));
    }
    redraw();
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);

  // ---- Buttons and keys

  const pressed = (id, is) => $(id).setAttribute("aria-pressed", is);
  const fit = () => {
    camera.goHome();
    camera.fit(seenBox());
    redraw();
  };
  const actions = {
    fit,
    edges: () => pressed("edges", hasEdges = !hasEdges),
    finer: () => {
      pressed("finer", scene.isFiner = !scene.isFiner);
      state = "";
      load();
    },
    box: () => pressed("box", hasBox = !hasBox),
    draw: () => {
      pressed("draw", isDrawing = !isDrawing);
      canvas.classList.toggle("drawing", isDrawing);
      say(isDrawing ? "Drag a line across the mesh." : "");
    },
    theme: () => theme.set(!theme.isDark),
  };
  for (const [id, action] of Object.entries(actions)) {
    $(id).addEventListener("click", () => {
      action();
      redraw();
    });
  }
  $("copy").addEventListener("click", () => copyLine().then(say));
  $("clear").addEventListener("click", clear);
  for (const id of ["front", "gap"]) {
    $(id).addEventListener("input", () => {
      trace(cut !== null);
      redraw();
    });
  }
  const keys = { f: "fit", e: "edges", n: "finer", b: "box", d: "draw", t: "theme" };
  listen(camera, (key) => {
    if (keys[key]) $(keys[key]).click();
    else if (key === "Escape") clear();
    else if (isPlayed && key === " ") play(!isPlaying);
    else if (isPlayed && key === "ArrowRight") step(1);
    else if (isPlayed && key === "ArrowLeft") step(-1);
    else return false;
    return true;
  }, redraw);

  // ---- Playing

  let isPlaying = false, clock = 0, last = 0;
  const charts = [];
  const until = moments.at(-1).seconds;
  // The last moment that is not after this time.
  const momentAt = (seconds) => Math.max(0, moments.findLastIndex((moment) => moment.seconds <= seconds + 1e-9));
  const seek = (seconds) => {
    clock = seconds;
    show(momentAt(seconds));
  };
  const step = (by) => {
    play(false);
    show(Math.max(0, Math.min(moments.length - 1, now + by)));
  };

  function play(is) {
    if (is === isPlaying) return;
    isPlaying = is;
    $("play").textContent = is ? "Pause" : "Play";
    if (!is) return;
    clock = now === moments.length - 1 ? 0 : moments[now].seconds;
    last = performance.now();
    requestAnimationFrame(tick);
  }

  function tick(time) {
    if (!isPlaying) return;
    clock += Math.max(0, time - last) / 1000 * Number($("speed").value);
    last = time;
    const next = momentAt(clock);
    if (next !== now) show(next);
    if (next === moments.length - 1) play(false);
    else requestAnimationFrame(tick);
  }

  if (isPlayed) {
    $("player").hidden = false;
    $("time").max = moments.length - 1;
    $("tears").style.setProperty("--moment", `${100 / (moments.length - 1)}%`);
    for (const tear of tears) {
      const mark = document.createElement("i");
      mark.style.left = `${100 * tear / (moments.length - 1)}%`;
      $("tears").append(mark);
    }
    $("time").addEventListener("input", () => {
      play(false);
      show(Number($("time").value));
    });
    $("play").addEventListener("click", () => play(!isPlaying));
    const counted = { name: "pieces", unit: "", lines: [{ name: "", points: moments.map((m) => [m.seconds, pieces[m.state]]) }] };
    const plots = [...data.plots, ...(moments.length >= data.few && states.length > 1 ? [counted] : [])];
    $("plots").hidden = !plots.length;
    for (const plot of plots) charts.push(new Chart($("plots"), plot, until, data.colors.pieces, seek));
  }

  $("title").textContent = data.title;
  camera.size = stageSize();
  say("");
  show(isFilm && tears.length ? tears[0] : 0);
  fit();
  followSize(camera, draw);
  document.body.dataset.ready = "yes";
}

open().catch((error) => { $("say").textContent = error.message; });
