// What crosses the border of the module of `play`: each parameter of each export × each number that JavaScript may
// hand over, and texts that are none. A call of this function with a compiled module returns every row that is not as
// the tables have it, and how many there were. An export without rows is a finding too.
async (compiled) => {
  // Outcomes: + done, x refused in words, o a ray that meets no cloth, ! done, but the next step is refused in words.
  const LEVELS = { nan: NaN, "-inf": -Infinity, inf: Infinity, none: undefined, "-1": -1, "2^31": 2 ** 31, "2^32-1": 2 ** 32 - 1,
    "-2^31": -(2 ** 31), "2^32": 2 ** 32, 0: 0, 1: 1, 2: 2, "1/2": 0.5, "5e5": 5e5, "4.5e6": 4.5e6, "1e308": 1e308, "1e-12": 1e-12,
    "1e-200": 1e-200, "5e-324": 5e-324 };
  // Behind `~` is what the words of a refusal speak of. Hand 0 holds the cloth; block 8 is the text.
  const NUMBERS = `
                nan -inf inf none -1 2^31 2^32-1 -2^31 2^32 0 1 2 1/2 5e5 4.5e6 1e308 1e-12 1e-200 5e-324 ~
address.block    x   x   x   x    x   x     x     x     x   + + +  x   x    x     x     x     x     x     ~ no block
length.block     x   x   x   x    x   x     x     x     x   + + +  x   x    x     x     x     x     x     ~ no block
room.length      x   x   x   x    x   x     x     x     x   + + +  x   +    +     x     x     x     x     ~ no room
advance.dt       x   x   x   x    x   +     +     x     +   + + +  +   +    +     +     +     +     +     ~ dt
advance.steps    x   x   x   x    x   +     +     x     x   + + +  x   +    +     x     x     x     x     ~ steps
grab.x           x   x   x   x    o   o     o     o     o   + + o  +   o    o     x     +     +     +     ~ origin
grab.y           x   x   x   x    o   o     o     o     o   + x o  +   o    o     x     +     +     +     ~ origin|held
grab.z           x   x   x   x    o   +     +     o     +   + + +  +   +    +     x     +     +     +     ~ origin
grab.dx          x   x   x   x    o   o     o     o     o   + o o  o   o    o     o     +     +     +     ~ direction
grab.dy          x   x   x   x    o   o     o     o     o   + o o  o   o    o     o     +     +     +     ~ direction
grab.dz          x   x   x   x    +   o     o     +     o   x o o  o   o    o     o     o     o     o     ~ direction
lead.hand        x   x   x   x    x   x     x     x     x   + x x  x   x    x     x     x     x     x     ~ no such hand
lead.x           x   x   x   x    +   +     +     +     +   + + +  +   +    +     x     +     +     +     ~ to
lead.y           x   x   x   x    +   +     +     +     +   + + +  +   +    +     x     +     +     +     ~ to
lead.z           x   x   x   x    +   +     +     +     +   + + +  +   +    +     x     +     +     +     ~ to
release.hand     x   x   x   x    x   x     x     x     x   + x x  x   x    x     x     x     x     x     ~ no such hand
pin.x            x   x   x   x    o   o     o     o     o   + + o  +   o    o     x     +     +     +     ~ origin
pin.y            x   x   x   x    o   o     o     o     o   + + o  +   o    o     x     +     +     +     ~ origin
pin.z            x   x   x   x    o   +     +     o     +   + + +  +   +    +     x     +     +     +     ~ origin
pin.dx           x   x   x   x    o   o     o     o     o   + o o  o   o    o     o     +     +     +     ~ direction
pin.dy           x   x   x   x    o   o     o     o     o   + o o  o   o    o     o     +     +     +     ~ direction
pin.dz           x   x   x   x    +   o     o     +     o   x o o  o   o    o     o     o     o     o     ~ direction
cut.x            x   x   x   x    +   +     +     +     +   + + +  +   +    +     x     +     +     +     ~ origin
cut.y            x   x   x   x    +   +     +     +     +   + + +  +   +    +     x     +     +     +     ~ origin
cut.z            x   x   x   x    +   +     +     +     +   + + +  +   +    +     x     +     +     +     ~ origin
cut.ax           x   x   x   x    +   +     +     +     +   + + +  +   +    +     +     +     +     +     ~ direction
cut.ay           x   x   x   x    +   +     +     +     +   + + +  +   +    +     +     +     +     +     ~ direction
cut.az           x   x   x   x    +   +     +     +     +   + + +  +   +    +     +     +     +     +     ~ direction
cut.bx           x   x   x   x    +   +     +     +     +   + + +  +   +    +     +     +     +     +     ~ direction
cut.by           x   x   x   x    +   +     +     +     +   + + +  +   +    +     +     +     +     +     ~ direction
cut.bz           x   x   x   x    +   +     +     +     +   + + +  +   +    +     +     +     +     +     ~ direction
cut.first        x   x   x   x    x   x     x     x     x   + + x  x   x    x     x     x     x     x     ~ 0 or 1
wind.x           x   x   x   x    +   !     !     !     !   + + +  +   +    !     !     +     +     +     ~ velocity
wind.y           x   x   x   x    +   !     !     !     !   + + +  +   +    !     !     +     +     +     ~ velocity
wind.z           x   x   x   x    +   !     !     !     !   + + +  +   !    !     !     +     +     +     ~ velocity
wind.coefficient x   x   x   x    x   !     !     x     !   + + +  +   +    !     !     +     +     +     ~ coefficient`;

  // Of each export: what a call hands over that is right, in the order of its parameters; what it returns if it is
  // refused; and what comes of the call before there is a cloth.
  const DOWN = { x: 0.5, y: 0.5, z: 5, dx: 0, dy: 0, dz: -1 };
  const EXPORTS = {
    address: [{ block: 0 }, 0, "x"], length: [{ block: 0 }, 0, "x"], room: [{ length: 8 }, 0, "!"],
    take_file: [{}, 0, "x"], take_scene: [{}, 0, "x"], start: [{}, 0, "x"], replay: [{}, 0, "x"],
    advance: [{ dt: 0.02, steps: 3 }, -1, "x"], draw: [{}, 0, "x"],
    grab: [DOWN, -1, "x"], lead: [{ hand: 0, x: 0.5, y: 0.4, z: 0.1 }, 0, "x"], release: [{ hand: 0 }, 0, "x"], pin: [DOWN, -1, "x"],
    cut: [{ x: 0.5, y: 0.5, z: 2, ax: -0.3, ay: 0.1, az: -2, bx: 0.3, by: 0.1, bz: -2, first: 0 }, -1, "x"], heal: [{}, -1, "x"],
    wind: [{ x: 0, y: 0, z: 3, coefficient: 1.5 }, 0, "x"], wind_of_scene: [{}, 0, "x"],
    write_obj: [{}, 0, "x"], write_log: [{}, 0, "x"], digest: [{}, 0n, "x"],
  };

  const NOTHING_YET = /no cloth|no face|expected `cloth`|no log|EOF/;

  const SHEET = "cloth sheet 4\nscene rip\nup y\nmethod xpbd\nthreshold 1.5\n";
  const sheet = (key, value) => SHEET.replace(new RegExp(`^${key} .*$`, "m"), `${key} ${value}`);

  let rows = 0, wasm;
  const finds = [], taken = new TextEncoder();
  const block = (n, Type = Uint8Array) => new Type(wasm.memory.buffer, wasm.address(n), wasm.length(n) / Type.BYTES_PER_ELEMENT);
  const text = () => new TextDecoder().decode(block(8));
  const give = (content) => {
    const bytes = typeof content === "string" ? taken.encode(content) : Uint8Array.from(content);
    const at = wasm.room(bytes.length);
    new Uint8Array(wasm.memory.buffer, at, bytes.length).set(bytes);
  };
  const fresh = () => { wasm = new WebAssembly.Instance(compiled).exports; };
  const start = (settings = SHEET) => (give(settings), wasm.start());
  const replay = (log) => (give(log), wasm.replay());
  const log = () => (wasm.write_log(), text()), obj = () => (wasm.write_obj(), text());
  // A cloth on which nothing was done yet, and a hand that holds it.
  const hold = () => wasm.grab(0.5, 0.25, 5, 0, 0, -1), begin = () => (start(), hold());
  // Everything that a page can see of a cloth.
  const state = () => {
    wasm.draw();
    const blocks = [0, 1, 2, 3, 4, 5, 6, 7].map((n) => block(n).join());
    return [wasm.digest(), log(), obj(), ...blocks].join("\n");
  };
  // Whether the box round what is drawn is that of the vertices, for cloths of a metre.
  const isDrawnInPlace = () => {
    wasm.draw();
    const origin = block(5, Float64Array).slice(-3), drawn = block(0, Float32Array);
    const lines = obj().split("\n").filter((line) => line.startsWith("v "));
    return [0, 1, 2].every((axis) => [Math.min, Math.max].every((end) => {
      const is = end(...lines.map((line) => +line.split(" ")[axis + 1]));
      return Math.abs(end(...drawn.filter((_, i) => i % 3 === axis)) + origin[axis] - is) < 1e-6;
    }));
  };
  const areFinite = () => (wasm.draw(), block(0, Float32Array).every(Number.isFinite));

  // Makes a call, and compares what comes of it: the letter of the outcome, or what happened instead.
  const outcome = (act, refusal, words) => {
    const before = state();
    wasm.release(-1);
    block(8).fill("~".charCodeAt(0));
    const answer = act(), said = text();
    let found = "+";
    if (!/^~*$/.test(said) && answer === refusal) {
      if (state() !== before) return `refused, and something changed: ${said}`;
      found = said === "there is no cloth there" ? "o" : words?.test(said) ? "x" : `refused in other words: ${said}`;
    } else if (answer === refusal) {
      return `${answer} without a word`;
    }
    const steps = wasm.advance(0.05, 3), why = text();
    if (!areFinite()) return `${found}, and a place that is not finite`;
    const lived = [wasm.digest(), obj()].join("\n");
    const isRepeated = !wasm.write_log() || (replay(text()) && [wasm.digest(), obj()].join("\n") === lived);
    if (!isRepeated) return `${found}, and its log is not repeated: ${text()}`;
    if (steps === 3) return found;
    return steps >= 0 || !why ? `${found}, and time stands still` : found === "+" ? "!" : found;
  };
  const row = (name, expected, refusal, words, act) => {
    rows += 1;
    let found;
    try {
      found = outcome(act, refusal, words);
      if (!start() || wasm.advance(0.02, 3) < 0 || !areFinite()) found += ", and no other cloth starts";
    } catch (error) {
      found = `trap: ${error.message}`;
      fresh();
    }
    if (found !== expected) finds.push(`${name}: expected ${expected}, found ${found}`);
  };

  // What came to a verb late, twice, or for another: [verb, what, outcome, words, before, call]. `h` is the hand that
  // holds the cloth, at (½, ¼).
  const lost = (h) => (wasm.release(h), h), missed = () => wasm.grab(9, 9, 5, 0, 0, -1);
  // Another hand holds the cloth since, and has a number of its own.
  const earlier = (h) => (begin(), h), replayed = (h) => (replay(log()), hold(), h);
  const took = (obj) => (give(obj), wasm.take_file());
  const scaled = (by, x = 0, y = 0) => [[0, 0], [1, 0], [0, 1]].map((p) => `v ${x + p[0] * by} ${y + p[1] * by} 0\n`).join("") + "f 1 2 3\n";
  const FACE = scaled(1), FAR = scaled(1, 5e5, 4.5e6), FILE = sheet("cloth", "file f.obj");
  const HANDS = [["missed", missed], ["released", lost], ["of an earlier cloth", earlier], ["of before a replay", replayed]];
  const STALE = [
    ...HANDS.map(([what, before]) => ["lead", `a hand that was ${what}`, "x", /no such hand|does not hold/, before, (h) => wasm.lead(h, 0, 0, 0)]),
    ...HANDS.map(([what, before]) => ["release", `a hand that was ${what}`, "x", /no such hand|does not hold/, before, (h) => wasm.release(h)]),
    ["grab", "what is in a hand", "x", /in hand/, (h) => h, hold],
    ["grab", "what is pinned", "x", /held/, () => wasm.pin(0.25, 0.25, 5, 0, 0, -1), () => wasm.grab(0.25, 0.25, 5, 0, 0, -1)],
    ["grab", "what was held as a log was saved", "+", null, () => replay(log()), hold],
    ["pin", "what is in a hand", "x", /in hand/, (h) => h, () => wasm.pin(0.5, 0.25, 5, 0, 0, -1)],
    ["pin", "what is pinned", "+", null, () => wasm.pin(0.25, 0.25, 5, 0, 0, -1), () => wasm.pin(0.25, 0.25, 5, 0, 0, -1)],
    ["cut", "one ray twice", "x", /same line/, (h) => h, () => wasm.cut(0.5, 0.5, 2, 0, 0, -1, 0, 0, -2, 0)],
    ["advance", "no number, in a wind that sways", "x", /dt/, () => (start(sheet("scene", "flag")), wasm.advance(0.12, 900)), () => wasm.advance(NaN, 3)],
    ["heal", "what is whole", "+", null, (h) => h, () => wasm.heal()],
    ["wind", "of no force, at no speed", "x", /velocity/, (h) => h, () => wasm.wind(NaN, 0, 0, 0)],
    ["take_file", "an empty room", "x", /no face/, (h) => h, () => wasm.take_file()],
    ["start", "a file", "+", null, () => took(FACE), () => start(FILE)],
    ["start", "a file that was refused after another", "+", null, () => (took(FACE), took("f")), () => start(FILE)],
    ["start", "a file with the name of the inputs of a log", "+", null, () => took(FACE), () => start(sheet("cloth", "file tearmesh inputs.obj"))],
    ["start", "a file far away", "+", null, () => took(FAR), () => start(FILE) && isDrawnInPlace()],
    ["start", "a tiny file", "+", null, () => took(scaled(1e-12)), () => start(FILE)],
    ["start", "a file whose area is 0 in numbers", "x", /no face has an area/, () => took(scaled(1e-200)), () => start(FILE)],
    ["take_file", "a file beyond the numbers that are drawn", "x", /draws up to/, (h) => h, () => took(scaled(1e40))],
    ["grab", "a cloth far away", "+", null, () => (took(FAR), start(FILE)), () => wasm.grab(5e5 + 0.2, 4.5e6 + 0.2, 5, 0, 0, -1)],
    ["cut", "a cloth far away", "+", null, () => (took(FAR), start(FILE)), () => wasm.cut(5e5 + 0.2, 4.5e6 - 1, 1, 0, 2, -1, 0, 1, -1, 1)],
    ["take_scene", "a scene that was refused after another", "+", null, () => (give(plan({})), wasm.take_scene(), give("{"), wasm.take_scene()), () => start(sheet("scene", "file s"))],
    ["start", "a room that a file was taken from", "x", /cloth/, () => took(FACE), () => wasm.start()],
  ];

  // Texts that are handed over: [verb, outcome, words, text]. They are handed over while a hand holds a cloth.
  const starts = (key, outcome, words, ...values) => values.map((value) => ["start", outcome, words, sheet(key, value)]);
  const file = (outcome, words, ...files) => files.map((obj) => ["take_file", outcome, words, obj]);
  const plan = (text, more) => JSON.stringify({ text: JSON.stringify(text), bodies: {}, vertices: [], rest: [], ...more });
  fresh();
  start();
  const LOG = log(), NOT_UTF8 = [0xff, 0xfe, 0];
  const TEXTS = [
    ["start", "x", /expected `cloth`/, ""], ["start", "x", /UTF-8/, NOT_UTF8], ["start", "x", /expected `scene`/, "cloth sheet 4\n"],
    ["start", "x", /nothing more/, `${SHEET}threshold 2\n`], ["start", "x", /nothing more/, `${SHEET}tearmesh inputs 1\n`],
    ["start", "+", null, SHEET.trimEnd()], ["start", "x", /not here/, FILE],
    ...starts("cloth", "x", /no cloth/, "", "quilt", "sheet", "sheet 0", "sheet -1", "sheet NaN", "sheet 0.5", "sheet 129", "sheet 2147483648",
      "sheet 4294967297"),
    ...starts("scene", "x", /no scene/, "", "NaN", "-1"), ...starts("scene", "x", /file that is not here/, "file s.toml"),
    ...starts("up", "x", /no direction/, "", "w", "--y"), ...starts("method", "x", /no method/, "", "NaN"),
    ...starts("threshold", "x", /no threshold/, "", "nan", "inf", "-inf", "-1", "0", "5e-324", "1"),
    ...starts("threshold", "+", null, "1.000000000001", "5e5", "1e300", "never"),
    ["replay", "+", null, LOG], ["replay", "x", /no log/, ""], ["replay", "x", /UTF-8/, NOT_UTF8], ["replay", "x", /no log/, SHEET],
    ["replay", "x", /no log/, `tearmesh play 1\n${SHEET}`], ["replay", "x", /expected a verb/, LOG.trimEnd().slice(0, -3)],
    ["replay", "x", /no threshold/, LOG.replace("1.5", "NaN")], ["replay", "x", /another/, LOG.replace("sheet 4", "sheet 5")],
    ["replay", "x", /steps/, LOG.replace("0 end", "-1 end")], ["replay", "x", /steps/, LOG.replace("0 end", "NaN end")],
    ...["lead 7 0 0 0", "lead ffffffffffffffff 0 0 0", "release 1", "lead 0 7ff8000000000000 0 0", "lead 0 0", "wind 0 0 0 bff0000000000000",
      "grab ffffffff 0", "grab 3 bff0000000000000", "hold ffffffff", "cut 0", "heal 5", "unpick 0"].map((line) => ["replay", "x", /input/, LOG.replace("0 end", `0 ${line}\n0 end`)]),
        ["take_scene", "+", null, plan({})], ["take_scene", "x", /EOF/, ""], ["take_scene", "x", /expected value/, NOT_UTF8],
    ["take_scene", "x", /missing field/, "{}"], ["take_scene", "x", /EOF/, `{"more": ${"[".repeat(1e5)}`],
    ["take_scene", "x", /expected f64/, plan({}, { text: `{"fabric": ${"[".repeat(1e5)}` })],
    ["take_scene", "x", /expected f64/, plan({ seconds: "NaN" })], ["take_scene", "x", /out of range/, plan({ seconds: -1 })],
    ["take_scene", "x", /unknown field/, plan({ nothing: 1 })],
    ...[[0, 2 ** 32 - 1], [-1, 0], [0.5, 0]].map((ids) => ["take_scene", "x", /vertex|id|u32/, plan({}, { vertices: [ids] })]),
    ...file("x", /no face/, "", "# nothing\n"), ...file("x", /UTF-16/, NOT_UTF8), ...file("x", /not a finite/, "v NaN 0 0\n"),
    ...file("x", /too large/, "v 1e300 0 0\n"), ...file("x", /does not exist/, `${FACE}f 1 2 -9\n`, `${FACE}f 0 1 2\n`),
    ...file("x", /beyond/, `${FACE}f 1 2 4294967297\n`), ...file("+", null, FACE, FAR, scaled(1e-12), scaled(1e-200)),
  ];

  const [head, ...lines] = NUMBERS.trim().split("\n");
  const levels = head.trim().split(/\s+/).slice(0, -1);
  const numbered = new Set();
  for (const line of lines) {
    const [cells, words] = line.split(" ~ "), [name, ...expected] = cells.trim().split(/\s+/);
    const [verb, parameter] = name.split("."), [right, refusal] = EXPORTS[verb];
    numbered.add(name);
    for (const [i, level] of levels.entries()) {
      fresh();
      begin();
      const values = { ...right, [parameter]: LEVELS[level] };
      row(`${name} = ${level}`, expected[i], refusal, new RegExp(words), () => wasm[verb](...Object.values(values)));
    }
  }
  for (const [verb, [right, refusal, bare]] of Object.entries(EXPORTS)) {
    fresh();
    const parameters = Object.keys(right), has = wasm[verb]?.length;
    const isWhole = has === parameters.length && parameters.every((parameter) => numbered.has(`${verb}.${parameter}`));
    if (isWhole) row(`${verb}: before there is a cloth`, bare, refusal, NOTHING_YET, () => wasm[verb](...Object.values(right)));
    else finds.push(`${verb}: ${has} parameters, and rows for ${parameters}`);
  }
  for (const { name, kind } of WebAssembly.Module.exports(compiled)) {
    if (kind === "function" && !EXPORTS[name]) finds.push(`${name}: an export without rows`);
  }
  for (const [verb, what, expected, words, before, call] of STALE) {
    fresh();
    const made = before(begin());
    row(`${verb}: ${what}`, expected, EXPORTS[verb][1], words, () => call(made));
  }
  for (const [verb, expected, words, content] of TEXTS) {
    fresh();
    begin();
    row(`${verb}: ${JSON.stringify(content).slice(0, 150)}`, expected, 0, words, () => (give(content), wasm[verb]()));
  }
  return { rows, finds };
}
