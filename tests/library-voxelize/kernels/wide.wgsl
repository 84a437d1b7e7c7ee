// Wide integers of chosen words: the sum of two products of 64 and 32 bits, its sign, and of the first factor its sign
// and value. Three texels for each choice, words as halves.

import lib/facing;
import lib/random;

var wide: texture_storage_2d<rgba32float, write>;

fn halves(low: u32, high: u32) -> vec4f {
    return vec4f(vec4u(low & 0xffffu, low >> 16u, high & 0xffffu, high >> 16u));
}

/// Up to 2^30 either way, of all sizes.
fn chosen(index: u32) -> i32 {
    let word = hash(index);
    return bitcast<i32>(word) >> (1u + (hash(word) % 31u));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(wide);
    if id.x * 3u + 2u >= size.x || id.y >= size.y {
        return;
    }
    let first = 8u * (id.y * size.x + id.x);
    let a = difference_of_products(chosen(first), chosen(first + 1u), chosen(first + 2u), chosen(first + 3u));
    let b = product_64(chosen(first + 4u), chosen(first + 5u));
    let sum = sum_128(product_128(a, chosen(first + 6u)), product_128(b, chosen(first + 7u)));
    let signs = vec4f(f32(sign_128(sum)), f32(sign_64(a)), float_64(a), f32(less_64(absolute_64(a), absolute_64(b))));
    textureStore(wide, vec2u(3u * id.x, id.y), halves(sum.x, sum.y));
    textureStore(wide, vec2u(3u * id.x + 1u, id.y), halves(sum.z, sum.w));
    textureStore(wide, vec2u(3u * id.x + 2u, id.y), signs);
}
