// First scattering in the voxels: the light of all lights, and of emitting voxels, that the surface in each voxel
// reflects. Writes premultiplied radiance ρ/π · E and opacity 1 where there is a surface; elsewhere there is nothing yet.
//
// Source: R 7.1 (eq. 7.1 with ρ/π · E in place of the products of colours), light maps looked up from the voxels. Light
// is evaluated at the mean position of the surface, not at the voxel's centre: on the surface where that is flat, and
// never further from it than half the voxel's diagonal (a mean of points in a cube is that close to one of them). By
// this much the point is moved towards the light before it is looked up.
// Emission, and light from outside, is gathered by the cones of the role `hemisphere` over each side of the mean normal,
// from the mean position.
// A thread for each voxel of the list. Reads 40 B of it, per light 64 + 112 B and 4 depths, and 12 cones where there is
// emission or an environment; writes 1 or 2 texels.

import lib/dispatch;
import lib/listed;
import lib/math;
import lib/two_sided;
import role/voxels;
@if(lights.total > 0) import lib/lights;
@if(scene.emissive || scene.environment) import lib/gather;
@if(scene.emissive || scene.environment) import role/storage;
@if(scene.environment) import lib/environment;

var lit: texture_storage_3d<rgba16float, write>;
/// The same again: what bounces are added to.
@if(bounces > 1)
var first: texture_storage_3d<rgba16float, write>;

@if(lights.total > 0)
fn add_lights(sides: ptr<function, Sides>, surfel: Surfel, n: vec3f) {
    let slack = 0.87 * values.voxel_size;
    for (var i = 0u; i < lighting.total; i++) {
        let light = lights[i];
        let arriving = arrival(light, surfel.position);
        if all(arriving.irradiance == vec3f(0.0)) {
            continue;
        }
        let cosine = mean_cosine(n, min(length(surfel.normal), 1.0), arriving.to_light);
        let share = visibility(light, arriving, surfel.position, n, slack);
        let irradiance = arriving.irradiance * (cosine * share);
        if dot(n, arriving.to_light) >= 0.0 {
            (*sides).front += irradiance;
        } else {
            (*sides).back += irradiance;
        }
    }
}

@if(scene.emissive || scene.environment)
fn seen_at(position: vec3f, level: f32, direction: vec3f) -> vec4f {
    return emitted_at(position, level, direction);
}

@if(scene.emissive || scene.environment)
fn seen_beyond(direction: vec3f, width: f32) -> vec3f {
    @if(scene.environment) {
        return environment_at(direction, width);
    } @else {
        return vec3f(0.0);
    }
}

/// Radiances that half floats don't hold are cut: infinities would spread.
fn store(voxel: vec3u, radiance: vec4f) {
    let value = min(radiance, vec4f(65504.0));
    textureStore(lit, voxel, value);
    @if(bounces > 1) {
        textureStore(first, voxel, value);
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let place = linear_index(id, workgroups, 64u);
    if place >= listed_voxels() {
        return;
    }
    let voxel = listed_voxel(place);
    let surfel = surfel_of(voxel);
    let n = unit_or(surfel.normal, vec3f(0.0, 1.0, 0.0));
    var sides = Sides(vec3f(0.0), vec3f(0.0));
    @if(lights.total > 0) {
        add_lights(&sides, surfel, n);
    }
    @if(scene.emissive || scene.environment) {
        sides.front += gather(surfel.position, n);
        sides.back += gather(surfel.position, -n);
    }
    store(voxel, vec4f(surfel.albedo / PI * brighter(sides), 1.0));
}
