// Random numbers that are a function of what they are for: pixel, sample, dimension and seed. No state, so any sample
// can be drawn at any time, in any order.
//
// Well spread: a batch of 2^k samples is, in each pair of dimensions, a piece of Sobol's sequence under Owen's scrambling
// (a (0, k, 2)-net), each pair and each batch scrambled anew (Burley 2020, "Practical Hash-based Owen Scrambling"), so that
// batches are independent.
// Cost of a pair: some 80 integer operations.

import lib/wide;

/// A permutation of 32-bit words: one step of PCG with its output function (Jarzynski and Olano 2020).
fn hash(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn hash_2(x: u32, y: u32) -> u32 {
    return hash(x ^ hash(y));
}

const BELOW_ONE: f32 = 0.99999994;

/// x · count, as multiples of 2^32 and the rest: one of `count` by a random word, and a random word again. The rest comes
/// in steps of `count`; it is the middle of its step.
fn scaled(x: u32, count: u32) -> vec2u {
    let words = product(x, count);
    return vec2u(words.y, words.x + min(count / 2u, ~words.x));
}

/// [0, 1).
fn unit_of(bits: u32) -> f32 {
    return f32(bits >> 8u) * (1.0 / 16777216.0);
}

/// Scrambles bits that are in reversed order: each bit by those below it (Laine and Karras 2011, constants of Vegdahl).
fn scramble_reversed(bits: u32, seed: u32) -> u32 {
    var x = bits ^ (bits * 0x3d20adeau);
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// A sample of a batch.
struct Sample {
    /// Of pixel, batch and the run's seed.
    seed: u32,
    /// In the batch, less than 2^bits; bits at most 16.
    index: u32,
    bits: u32,
}

/// The second coordinate of Sobol's sequence, its bits reversed, for an index of up to 16 bits. Its matrix is Pascal's
/// triangle mod 2, so bit j is the sum of the index's bits at all positions that have j's bits: a sum over supersets.
fn sobol_1_reversed(index: u32) -> u32 {
    var x = index;
    x ^= (x >> 1u) & 0x55555555u;
    x ^= (x >> 2u) & 0x33333333u;
    x ^= (x >> 4u) & 0x0f0f0f0fu;
    x ^= (x >> 8u) & 0x00ff00ffu;
    return x;
}

/// The sample's place in a batch that is shuffled for this dimension.
fn shuffled(sample: Sample, seed: u32) -> u32 {
    let scrambled = reverseBits(scramble_reversed(reverseBits(sample.index), seed));
    return scrambled & ((1u << sample.bits) - 1u);
}

/// A point of [0, 1)², for this pair of dimensions.
fn random_2(sample: Sample, dimension: u32) -> vec2f {
    let words = random_words(sample, dimension);
    return vec2f(unit_of(words.x), unit_of(words.y));
}

/// The same in units of 2^-32.
fn random_words(sample: Sample, dimension: u32) -> vec2u {
    let seed = hash_2(sample.seed, dimension);
    let index = shuffled(sample, seed);
    let x = scramble_reversed(index, hash(seed ^ 0x9e3779b9u));
    let y = scramble_reversed(sobol_1_reversed(index), hash(seed ^ 0x7f4a7c15u));
    return vec2u(reverseBits(x), reverseBits(y));
}

/// A number of [0, 1), for this dimension: well spread over the batch too.
fn random_1(sample: Sample, dimension: u32) -> f32 {
    let seed = hash_2(sample.seed, dimension);
    return unit_of(reverseBits(scramble_reversed(shuffled(sample, seed), hash(seed ^ 0x9e3779b9u))));
}
