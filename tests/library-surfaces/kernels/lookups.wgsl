// For tests: every function of lib/material at points drawn by lot.

import lib/material;

var base: texture_storage_2d<rgba32float, write>;
var emitted: texture_storage_2d<rgba32float, write>;
/// Metalness, roughness.
var surface: texture_storage_2d<rgba32float, write>;
/// The normal that the map makes of a slanted frame.
var bent: texture_storage_2d<rgba32float, write>;

/// In [0, 1), a multiple of 2^-16. (PCG hash, Jarzynski and Olano 2020.)
fn lot(n: u32) -> f32 {
    let state = n * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) & 0xffffu) / 65536.0;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(base);
    if any(id.xy >= size) {
        return;
    }
    let n = 8u * (id.y * size.x + id.x);
    let uv = 4.0 * vec4f(lot(n), lot(n + 1u), lot(n + 2u), lot(n + 3u)) - 1.5;
    let footprint = vec2f(exp2(-8.0 * lot(n + 4u)), exp2(-8.0 * lot(n + 5u)));
    let material = id.y % arrayLength(&materials);
    textureStore(base, id.xy, base_color_at(material, uv, footprint));
    textureStore(emitted, id.xy, vec4f(emission_at(material, uv, footprint), 1.0));
    textureStore(surface, id.xy, vec4f(metallic_roughness_at(material, uv, footprint), 0.0, 1.0));
    let map = normal_map_at(material, uv, footprint);
    let normal = vec3f(0.25, 1.0, 0.5);
    let tangent = vec4f(1.0, -0.125, 0.25, select(-1.0, 1.0, (id.x & 1u) == 0u)) * select(1.0, 0.0, id.x == 5u);
    textureStore(bent, id.xy, vec4f(mapped_normal(map, normal, tangent), 1.0));
}
