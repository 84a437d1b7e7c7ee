// Weighted sums in fixed point: integers, so that the result does not depend on the order of the threads.
//
// A weight is an area in 2^-16 of a voxel's face, a term for values in [0, 1] the value times the weight, for values in
// [-1, 1] half of that (two's complement in a u32), each rounded. While the weights of a sum were below MOST_WEIGHT it
// takes another; two sums can be added without overflow. Rounding: half a unit in each term, so that the mean is off by
// at most 1/2 (1) over LEAST_WEIGHT where all weights are that small, else by less.

import lib/math;

/// No fragment weighs less: one that only touches the voxel, and one of few units, whose terms would be rounded away.
const LEAST_WEIGHT: f32 = 256.0;
/// No piece of a plane in a voxel is larger: the square root of 2.
const GREATEST_WEIGHT: f32 = 92682.0;
/// Room for more than ten thousand threads that add at the same time is left above.
const MOST_WEIGHT: u32 = 1073741824u;

/// Of an area in faces of a voxel; a whole number.
fn weight_of(area: f32) -> f32 {
    return clamp(round(area * 65536.0), LEAST_WEIGHT, GREATEST_WEIGHT);
}

fn weighted_unsigned(value: f32, weight: f32) -> u32 {
    return u32(nearest_integer(clamp(value, 0.0, 1.0) * weight));
}

fn weighted_signed(value: f32, weight: f32) -> u32 {
    return u32(nearest_integer(clamp(value, -1.0, 1.0) * 0.5 * weight));
}

/// Mean of values with these weights together, which are not 0.
fn mean_unsigned(sum: u32, weights: u32) -> f32 {
    return f32(sum) / f32(weights);
}

fn mean_signed(sum: u32, weights: u32) -> f32 {
    return 2.0 * f32(bitcast<i32>(sum)) / f32(weights);
}
