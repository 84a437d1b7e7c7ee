// Integers of 64 bits (two words, low first) and of 128 (four), in two's complement, for tests that must be exact.

/// Of words: low, high.
fn product(a: u32, b: u32) -> vec2u {
    let x = vec2u(a & 0xffffu, a >> 16u);
    let y = vec2u(b & 0xffffu, b >> 16u);
    let one = x.y * y.x + ((x.x * y.x) >> 16u);
    let other = x.x * y.y + (one & 0xffffu);
    return vec2u(a * b, x.y * y.y + (one >> 16u) + (other >> 16u));
}

/// Of numbers without sign.
fn less_64(a: vec2u, b: vec2u) -> bool {
    return a.y < b.y || (a.y == b.y && a.x < b.x);
}

fn sum_64(a: vec2u, b: vec2u) -> vec2u {
    let low = a.x + b.x;
    return vec2u(low, a.y + b.y + select(0u, 1u, low < a.x));
}

fn negative_64(a: vec2u) -> vec2u {
    return sum_64(~a, vec2u(1u, 0u));
}

fn is_negative_64(a: vec2u) -> bool {
    return (a.y >> 31u) != 0u;
}

fn absolute_64(a: vec2u) -> vec2u {
    return select(a, negative_64(a), is_negative_64(a));
}

/// -1, 0, 1.
fn sign_64(a: vec2u) -> i32 {
    return select(select(1, 0, all(a == vec2u(0u))), -1, is_negative_64(a));
}

fn product_64(a: i32, b: i32) -> vec2u {
    let size = product(u32(abs(a)), u32(abs(b)));
    return select(size, negative_64(size), (a < 0) != (b < 0));
}

/// To the nearest 2^-23 or so of it.
fn float_64(a: vec2u) -> f32 {
    let size = absolute_64(a);
    let value = f32(size.y) * 4294967296.0 + f32(size.x);
    return select(value, -value, is_negative_64(a));
}

fn sum_128(a: vec4u, b: vec4u) -> vec4u {
    let low = sum_64(a.xy, b.xy);
    return vec4u(low, sum_64(sum_64(a.zw, b.zw), vec2u(select(0u, 1u, less_64(low, a.xy)), 0u)));
}

fn product_128(a: vec2u, b: i32) -> vec4u {
    let size = absolute_64(a);
    let low = product(size.x, u32(abs(b)));
    let high = sum_64(product(size.y, u32(abs(b))), vec2u(low.y, 0u));
    let whole = vec4u(low.x, high, 0u);
    return select(whole, sum_128(~whole, vec4u(1u, 0u, 0u, 0u)), is_negative_64(a) != (b < 0));
}

/// -1, 0, 1.
fn sign_128(a: vec4u) -> i32 {
    return select(select(1, 0, all(a == vec4u(0u))), -1, (a.w >> 31u) != 0u);
}
