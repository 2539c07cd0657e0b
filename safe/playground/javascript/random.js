// numpy's random numbers: Generator(SFC64(SeedSequence(seed))).random(), bit for bit.
//
// The 64-bit words of the generator are kept as halves of 32 bits, with which JavaScript computes fast.
// Sources: the generator is C. Doty-Humphrey's SFC64 (PractRand); the seeding is M. E. O'Neill's seed_seq_fe,
// with the constants that numpy documents for SeedSequence.

import { InputError, shown } from "./checks.js";

const POOL = 4; // words of 32 bits

/** A stream of uniform numbers.
 *
 * seed: a non-negative integer (number or BigInt), an array of them, or { entropy: one of these, spawnKey: integers },
 * as numpy.random.SeedSequence takes them. */
export class Sfc64 {
  constructor(seed) {
    const [aLow, aHigh, bLow, bHigh, cLow, cHigh] = seedWords(seed, 6);
    this.words = new Uint32Array([aLow, aHigh, bLow, bHigh, cLow, cHigh, 1, 0]); // the last pair counts
    for (let i = 0; i < 12; i++) this.random();
  }

  /** A uniform number in [0, 1). */
  random() {
    const words = this.words;
    const aLow = words[0], bLow = words[2], cLow = words[4], counter = words[6];
    const bHigh = words[3], cHigh = words[5];
    // output = a + b + counter
    const sum = (aLow + bLow) | 0, low = (sum + counter) | 0;
    const high = (words[1] + bHigh + words[7] + carry(aLow, bLow, sum) + carry(sum, counter, low)) | 0;
    words[6]++;
    if (words[6] === 0) words[7]++;
    // a = b ^ (b >> 11)
    words[0] = bLow ^ ((bLow >>> 11) | (bHigh << 21));
    words[1] = bHigh ^ (bHigh >>> 11);
    // b = c + (c << 3)
    const shifted = cLow << 3, b = (cLow + shifted) | 0;
    words[2] = b;
    words[3] = cHigh + ((cHigh << 3) | (cLow >>> 29)) + carry(cLow, shifted, b);
    // c = (c rotated by 24) + output
    const rotated = (cLow << 24) | (cHigh >>> 8), c = (rotated + low) | 0;
    words[4] = c;
    words[5] = ((cHigh << 24) | (cLow >>> 8)) + high + carry(rotated, low, c);
    return ((high >>> 0) * 2097152 + (low >>> 11)) / 9007199254740992; // the upper 53 bits, over 2 ** 53
  }
}

/** 1 if the sum of two words of 32 bits, of which the lower 32 bits are given, has a 33rd bit, or else 0. */
function carry(x, y, sum) {
  return ((x & y) | ((x | y) & ~sum)) >>> 31;
}

/** The first words of 32 bits that numpy's SeedSequence gives for a seed. */
function seedWords(seed, count) {
  const { entropy, spawnKey } = checkedSeed(seed);
  const words = wordsOf(entropy);
  const keyWords = wordsOf(spawnKey);
  while (keyWords.length > 0 && words.length < POOL) words.push(0);
  words.push(...keyWords);

  let constant = 0x43b0d7e5;
  function hash(word) {
    const mixed = word ^ constant;
    constant = Math.imul(constant, 0x931e8875);
    const product = Math.imul(mixed, constant);
    return product ^ (product >>> 16);
  }
  function mix(x, y) {
    const difference = Math.imul(0xca01f9dd, x) - Math.imul(0x4973f715, y);
    return difference ^ ((difference >>> 0) >>> 16);
  }
  const pool = [];
  for (let i = 0; i < POOL; i++) pool.push(hash(words[i] ?? 0));
  for (let source = 0; source < POOL; source++) {
    for (let i = 0; i < POOL; i++) if (i !== source) pool[i] = mix(pool[i], hash(pool[source]));
  }
  for (const word of words.slice(POOL)) {
    for (let i = 0; i < POOL; i++) pool[i] = mix(pool[i], hash(word));
  }

  constant = 0x8b51f9dd;
  const state = new Uint32Array(count);
  for (let i = 0; i < count; i++) {
    const mixed = pool[i % POOL] ^ constant;
    constant = Math.imul(constant, 0x58f38ded);
    const product = Math.imul(mixed, constant);
    state[i] = product ^ (product >>> 16);
  }
  return state;
}

/** A seed as { entropy, spawnKey }, both arrays of BigInt. */
export function checkedSeed(seed) {
  const isSequence = typeof seed === "object" && seed !== null && !Array.isArray(seed);
  const { entropy, spawnKey = [] } = isSequence ? seed : { entropy: seed };
  const isWhole = (n) => (typeof n === "bigint" || Number.isSafeInteger(n)) && n >= 0;
  const [entropyList, keyList] = [entropy, spawnKey].map((part) => (Array.isArray(part) ? part : [part]));
  if (entropyList.length === 0 || ![...entropyList, ...keyList].every(isWhole)) {
    throw new InputError(
      `seed must be a non-negative integer, a sequence of them, or a SeedSequence; got ${shown(entropy)}`,
    );
  }
  return { entropy: entropyList.map(BigInt), spawnKey: keyList.map(BigInt) };
}

/** Non-negative integers as words of 32 bits, the lowest first. */
function wordsOf(numbers) {
  const words = [];
  for (const number of numbers) {
    let rest = number;
    do {
      words.push(Number(rest & 0xffffffffn));
      rest >>= 32n;
    } while (rest > 0n);
  }
  return words;
}
