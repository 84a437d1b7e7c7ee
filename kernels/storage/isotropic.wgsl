// Module of the role `storage`: one colour and opacity for each voxel, the same in all directions.
//
// Source: R 5.1.1, 5.2.1. Colours are radiances (W/(sr·m²)), premultiplied by the opacity; reflected light and the
// light that surfaces emit are kept apart. Positions are in world space; levels are mip levels, fractions blend two.
// Cost: a quadrilinear sample for each call.

import lib/grid;

/// Light that surfaces scatter.
var reflected: texture_3d<f32>;
/// Light that surfaces emit; there for its opacities too, where light comes from outside.
@if(scene.emissive || scene.environment)
var emitted: texture_3d<f32>;
var volume_sampler: sampler;

/// Position in texture coordinates, and whether it lies in the grid.
fn volume_coordinates(position: vec3f, size: vec3u) -> vec4f {
    let at = to_grid(position) / vec3f(size);
    return vec4f(at, select(0.0, 1.0, all(at >= vec3f(0.0)) && all(at <= vec3f(1.0))));
}

/// Light that comes towards one who looks along `direction`; nothing outside the grid.
fn reflected_at(position: vec3f, level: f32, direction: vec3f) -> vec4f {
    let at = volume_coordinates(position, textureDimensions(reflected));
    return at.w * textureSampleLevel(reflected, volume_sampler, at.xyz, level);
}

/// A single voxel.
fn reflected_voxel(voxel: vec3i, level: i32, direction: vec3f) -> vec4f {
    return textureLoad(reflected, voxel, level);
}

@if(scene.emissive || scene.environment)
fn emitted_at(position: vec3f, level: f32, direction: vec3f) -> vec4f {
    let at = volume_coordinates(position, textureDimensions(emitted));
    return at.w * textureSampleLevel(emitted, volume_sampler, at.xyz, level);
}

@if(scene.emissive || scene.environment)
fn emitted_voxel(voxel: vec3i, level: i32, direction: vec3f) -> vec4f {
    return textureLoad(emitted, voxel, level);
}

/// Mip levels that are stored.
fn volume_levels() -> u32 {
    return textureNumLevels(reflected);
}
