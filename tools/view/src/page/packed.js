// The bytes that lie in an element of the page, compressed and in base64.
async function unpacked(id, format) {
  const packed = Uint8Array.from(atob(document.getElementById(id).textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream(format));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}


// What every page carries: a text in JSON, and the bytes behind it.
async function unpackedData() {
  const bytes = await unpacked("data", "deflate"), length = new DataView(bytes.buffer).getUint32(0, true);
  return { data: JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length))), bytes: bytes.subarray(4 + length) };
}
