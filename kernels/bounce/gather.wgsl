// One more scattering in the voxels: what the surface in each voxel reflects of the light that voxels reflected so far.
//
// Source: R 6.4 (eq. 6.14: ρ/π Σ W L), for voxels instead of pixels. With T this operator and L₁ the first scattering,
// n rounds of L ← L₁ + T L give the first n + 1 scatterings. The weights sum to at most π and opacities to 1, so that
// T's gain is at most the albedo.
// A thread for each voxel of the list. Reads 40 B and 12 cones; writes one texel.

import lib/dispatch;
import lib/listed;
import lib/gather;
import lib/math;
import lib/two_sided;
import role/storage;
import role/voxels;

/// Premultiplied radiance, and opacity 1, where there is a surface; nobody reads it elsewhere.
var bounced: texture_storage_3d<rgba16float, write>;

fn seen_at(position: vec3f, level: f32, direction: vec3f) -> vec4f {
    return reflected_at(position, level, direction);
}

/// All that comes from outside is in the first scattering.
fn seen_beyond(direction: vec3f, width: f32) -> vec3f {
    return vec3f(0.0);
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
    let sides = Sides(gather(surfel.position, n), gather(surfel.position, -n));
    textureStore(bounced, voxel, vec4f(min(surfel.albedo / PI * brighter(sides), vec3f(65504.0)), 1.0));
}
