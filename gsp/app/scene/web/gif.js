// Animated GIF (GIF89a): one table of 256 colours for all frames, by median cut, and LZW.
const LEVELS = 5, MOST_COLOURS = 256, MOST_CODES = 4096;

// A colour with 5 bits per component.
const coarse = (d, i) => ((d[i] >> 3) << 10) | ((d[i + 1] >> 3) << 5) | (d[i + 2] >> 3);
const part = (colour, k) => (colour >> (5 * (2 - k))) & 31;

function counted(frames) {
  const count = new Uint32Array(1 << (3 * LEVELS));
  for (const data of frames) for (let i = 0; i < data.length; i += 4) count[coarse(data, i)]++;
  return count;
}

// Boxes of colours are halved along their longest side, at the median of their pixels.
function boxes(count) {
  const all = [];
  count.forEach((n, colour) => n && all.push(colour));
  const made = [all];
  const side = (box, k) => {
    let low = 31, high = 0;
    for (const colour of box) [low, high] = [Math.min(low, part(colour, k)), Math.max(high, part(colour, k))];
    return high - low;
  };
  const longest = (box) => Math.max(...[0, 1, 2].map((k) => side(box, k)));
  const spread = made.map(longest);
  while (made.length < MOST_COLOURS) {
    const i = spread.indexOf(Math.max(...spread)), box = made[i];
    if (!spread[i]) break;
    const k = [0, 1, 2].find((one) => side(box, one) === spread[i]);
    box.sort((a, b) => part(a, k) - part(b, k));
    const half = box.reduce((sum, colour) => sum + count[colour], 0) / 2;
    let cut = 0, sum = 0;
    while (cut < box.length - 1 && (sum += count[box[cut++]]) < half);
    made.splice(i, 1, box.slice(0, cut), box.slice(cut));
    spread.splice(i, 1, longest(box.slice(0, cut)), longest(box.slice(cut)));
  }
  return made;
}

// The table of colours, and the number in it of each coarse colour.
function palette(frames) {
  const count = counted(frames), table = new Uint8Array(3 * MOST_COLOURS);
  const number = new Uint8Array(count.length);
  boxes(count).forEach((box, i) => {
    const total = box.reduce((sum, colour) => sum + count[colour], 0) || 1;
    for (let k = 0; k < 3; k++) {
      const mean = box.reduce((sum, colour) => sum + count[colour] * part(colour, k), 0) / total;
      table[3 * i + k] = Math.round((mean * 255) / 31);
    }
    box.forEach((colour) => (number[colour] = i));
  });
  return { table, number };
}

// Codes of variable length, the lowest bit first, in blocks of at most 255 bytes.
function compressed(pixels) {
  const out = [];
  let bits = 0, held = 0, width = 9, next = 258, codes = new Map();
  const put = (code) => {
    bits |= code << held;
    for (held += width; held >= 8; held -= 8, bits >>>= 8) out.push(bits & 255);
  };
  put(256);
  let prefix = pixels[0];
  for (let i = 1; i < pixels.length; i++) {
    const key = (prefix << 8) | pixels[i], known = codes.get(key);
    if (known !== undefined) {
      prefix = known;
      continue;
    }
    put(prefix);
    if (next < MOST_CODES) {
      codes.set(key, next++);
      if (next > 1 << width && width < 12) width++;
    } else {
      put(256);
      [codes, next, width] = [new Map(), 258, 9];
    }
    prefix = pixels[i];
  }
  put(prefix);
  put(257);
  if (held) out.push(bits & 255);
  const blocks = [8];
  for (let i = 0; i < out.length; i += 255) {
    const block = out.slice(i, i + 255);
    blocks.push(block.length, ...block);
  }
  return new Uint8Array([...blocks, 0]);
}

const short = (n) => [n & 255, n >> 8];

// The file of frames (RGBA, all of one size), each shown for `delay` milliseconds, without an end.
export function gif(frames, width, height, delay) {
  const { table, number } = palette(frames);
  const letters = (text) => [...text].map((letter) => letter.charCodeAt(0));
  const parts = [
    new Uint8Array([...letters("GIF89a"), ...short(width), ...short(height), 0xf7, 0, 0]),
    table,
    new Uint8Array([0x21, 0xff, 11, ...letters("NETSCAPE2.0"), 3, 1, 0, 0, 0]),
  ];
  for (const data of frames) {
    const pixels = new Uint8Array(width * height);
    for (let i = 0; i < pixels.length; i++) pixels[i] = number[coarse(data, 4 * i)];
    parts.push(new Uint8Array([0x21, 0xf9, 4, 0, ...short(Math.max(2, Math.round(delay / 10))), 0, 0]));
    parts.push(new Uint8Array([0x2c, 0, 0, 0, 0, ...short(width), ...short(height), 0]), compressed(pixels));
  }
  return new Blob([...parts, new Uint8Array([0x3b])], { type: "image/gif" });
}
