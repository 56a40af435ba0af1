// The module in a browser: memory goes in and out by address and length. `draw` brings the arrays up to date;
// they are views that the next verb makes void.
class Cloth {
  static async load(bytes) {
    return new Cloth((await WebAssembly.instantiate(bytes)).instance.exports);
  }
  constructor(wasm) { this.wasm = wasm; }
  block(number, Type = Uint8Array) {
    const { address, length, memory } = this.wasm;
    return new Type(memory.buffer, address(number), length(number) / Type.BYTES_PER_ELEMENT);
  }
  give(bytes) {
    const at = this.ask(this.wasm.room(bytes.length));
    new Uint8Array(this.wasm.memory.buffer, at, bytes.length).set(bytes);
  }
  text() { return new TextDecoder().decode(this.block(8)); }
  ask(answer) {
    if (answer === 0 || answer === -1) throw new Error(this.text());
    return answer;
  }
  file(bytes) { this.give(bytes); this.ask(this.wasm.take_file()); }
  scene(plan) { this.give(new TextEncoder().encode(plan)); this.ask(this.wasm.take_scene()); }
  start(settings) { this.give(new TextEncoder().encode(settings)); this.ask(this.wasm.start()); }
  replay(log) { this.give(new TextEncoder().encode(log)); this.ask(this.wasm.replay()); }
  // Positions of cloth and solids are relative to the origin among the facts, all others are where they are.
  get positions() { return this.block(0, Float32Array); }
  get indices() { return this.block(1, Uint32Array); }
  get pieces() { return this.block(2, Uint32Array); }
  get edges() { return this.block(3); }
  get held() { return this.block(4); }
  // What the cloth lies on, where it is now.
  get solidPositions() { return this.block(6, Float32Array); }
  get solidIndices() { return this.block(7, Uint32Array); }
  get facts() {
    const [vertices, faces, pieces, heldFirst, tears, heals, sewn, left, open, time, step, ...rest] = this.block(5, Float64Array);
    return { vertices, faces, pieces, heldFirst, tears, heals, sewn, left, open, time, step, at: rest.slice(0, 3), origin: rest.slice(3) };
  }
  obj() { this.ask(this.wasm.write_obj()); return this.block(8).slice(); }
  log() { this.ask(this.wasm.write_log()); return this.block(8).slice(); }
  digest() { return BigInt.asUintN(64, this.wasm.digest()).toString(16).padStart(16, "0"); }
}

