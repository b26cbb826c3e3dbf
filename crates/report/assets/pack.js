// Packed arrays, as src/pack.rs lays them down.
const Pack = {
  /** The text of an array. */
  text: (index) => $(`blob-${index}`).textContent,

  async bytes(index) {
    const text = atob(Pack.text(index));
    const packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  },

  /** The codes of frames with so many values each. */
  async codes(packed, counts) {
    const total = counts.reduce((sum, count) => sum + count, 0);
    const codes = new Int32Array(total);
    if (packed.blob === null) return codes;
    const bytes = await Pack.bytes(packed.blob);
    for (let plane = 0; plane < packed.planes; plane++) {
      const at = plane * total, shift = 8 * plane;
      for (let i = 0; i < total; i++) codes[i] |= bytes[at + i] << shift;
    }
    let first = 0;
    counts.forEach((count, frame) => {
      const end = first + count, both = packed.predictor === 2;
      if (frame === 0 || packed.predictor === 0) {
        let left = 0;
        for (let i = first; i < end; i++) { const z = codes[i]; left += (z >>> 1) ^ -(z & 1); codes[i] = left; }
      } else if (!both) {
        for (let i = first; i < end; i++) { const z = codes[i]; codes[i] = codes[i - count] + ((z >>> 1) ^ -(z & 1)); }
      } else {
        let change = 0;
        for (let i = first; i < end; i++) { const z = codes[i]; change += (z >>> 1) ^ -(z & 1); codes[i] = codes[i - count] + change; }
      }
      first = end;
    });
    return codes;
  },

  /** Real values of all frames; what is no number is NaN. */
  async real(packed, counts) {
    const codes = await Pack.codes(packed, counts);
    const step = packed.steps > 0 ? (packed.high - packed.low) / packed.steps : 0;
    const out = new Float32Array(codes.length);
    for (let i = 0; i < codes.length; i++) out[i] = codes[i] > packed.steps ? NaN : packed.low + step * codes[i];
    return out;
  },

  /** Whole numbers. */
  whole: (packed, count) => Pack.codes(packed, [count]),

  /** Several arrays as one of interleaved values. */
  async together(list, counts) {
    const parts = await Promise.all(list.map((packed) => Pack.real(packed, counts)));
    const out = new Float32Array(parts[0].length * parts.length);
    parts.forEach((part, c) => { for (let i = 0; i < part.length; i++) out[parts.length * i + c] = part[i]; });
    return out;
  },
};
