// Sums in fixed point: integers, so that the result does not depend on the order of the threads.
//
// 16 fraction bits for values in [0, 1], 15 for values in [-1, 1] (two's complement in a u32). Two sums of 2^15 - 1
// terms can be added without overflow: 65534 · 2^16 < 2^32 and 65534 · 2^15 < 2^31. Rounding: half a step, 2^-17 or
// 2^-16.

import lib/math;

const MOST_TERMS: u32 = 32767u;

fn fixed_unsigned(value: f32) -> u32 {
    return u32(nearest_integer(clamp(value, 0.0, 1.0) * 65536.0));
}

fn fixed_signed(value: f32) -> u32 {
    return u32(nearest_integer(clamp(value, -1.0, 1.0) * 32768.0));
}

/// Mean of `terms` values; `terms` at least 1.
fn mean_unsigned(sum: u32, terms: u32) -> f32 {
    return f32(sum) / (65536.0 * f32(terms));
}

fn mean_signed(sum: u32, terms: u32) -> f32 {
    return f32(bitcast<i32>(sum)) / (32768.0 * f32(terms));
}
