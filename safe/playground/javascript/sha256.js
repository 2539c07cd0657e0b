// SHA-256 (FIPS 180-4) of a text, at once: `crypto.subtle` answers later, and only over https.

const [ROUNDS, INITIAL] = constants();

/** The SHA-256 of a text in UTF-8, in hexadecimal. */
export function sha256(text) {
  const message = new TextEncoder().encode(text);
  const blocks = new DataView(new ArrayBuffer(64 * Math.ceil((message.length + 9) / 64)));
  message.forEach((byte, i) => blocks.setUint8(i, byte));
  blocks.setUint8(message.length, 0x80);
  blocks.setBigUint64(blocks.byteLength - 8, 8n * BigInt(message.length));
  let state = INITIAL;
  for (let at = 0; at < blocks.byteLength; at += 64) state = compressed(state, blocks, at);
  return Array.from(state, (word) => word.toString(16).padStart(8, "0")).join("");
}

function compressed(state, blocks, at) {
  const words = new Uint32Array(64);
  for (let i = 0; i < 16; i++) words[i] = blocks.getUint32(at + 4 * i);
  for (let i = 16; i < 64; i++) {
    const early = words[i - 15], late = words[i - 2];
    const mixed = rotated(early, 7) ^ rotated(early, 18) ^ (early >>> 3);
    words[i] = words[i - 16] + mixed + words[i - 7] + (rotated(late, 17) ^ rotated(late, 19) ^ (late >>> 10));
  }
  let [a, b, c, d, e, f, g, h] = state;
  for (let i = 0; i < 64; i++) {
    const choice = (e & f) ^ (~e & g), majority = (a & b) ^ (a & c) ^ (b & c);
    const first = (h + (rotated(e, 6) ^ rotated(e, 11) ^ rotated(e, 25)) + choice + ROUNDS[i] + words[i]) | 0;
    const second = ((rotated(a, 2) ^ rotated(a, 13) ^ rotated(a, 22)) + majority) | 0;
    [a, b, c, d, e, f, g, h] = [(first + second) | 0, a, b, c, (d + first) | 0, e, f, g];
  }
  return Uint32Array.of(a, b, c, d, e, f, g, h).map((word, i) => word + state[i]);
}

function rotated(word, bits) {
  return (word >>> bits) | (word << (32 - bits));
}

/** The first 32 bits behind the point of the cube roots of the first 64 primes, and of the square roots of eight. */
function constants() {
  const primes = [];
  for (let n = 2; primes.length < 64; n++) if (primes.every((prime) => n % prime)) primes.push(n);
  const bits = (root) => Math.floor((root % 1) * 2 ** 32);
  return [
    Uint32Array.from(primes, (p) => bits(Math.cbrt(p))),
    Uint32Array.from(primes.slice(0, 8), (p) => bits(Math.sqrt(p))),
  ];
}
