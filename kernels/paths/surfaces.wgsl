// Albedo, normal and distance so far: means over the samples that met a surface.
//
// Reads per pixel 32 B, writes 3 texels. Where no sample met a surface all is 0, as is the alpha of albedo.

import lib/math;

struct Surfaces {
    albedo: vec4f,
    normal: vec4f,
}

var<storage, read> surfaces: array<Surfaces>;
var albedo: texture_storage_2d<rgba32float, write>;
var normal: texture_storage_2d<rgba32float, write>;
var linear_depth: texture_storage_2d<r32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(albedo);
    if any(id.xy >= size) {
        return;
    }
    let seen = surfaces[id.y * size.x + id.x];
    let share = seen.albedo.a;
    let scale = select(0.0, 1.0 / share, share > 0.0);
    textureStore(albedo, id.xy, vec4f(seen.albedo.rgb * scale, share));
    textureStore(normal, id.xy, vec4f(unit_or(seen.normal.xyz, vec3f(0.0)), 0.0));
    textureStore(linear_depth, id.xy, vec4f(seen.normal.w * scale, 0.0, 0.0, 1.0));
}
