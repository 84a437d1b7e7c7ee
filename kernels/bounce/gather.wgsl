// One more scattering in the voxels: what the surface in each voxel reflects of the light that voxels reflected so far.
//
// Source: R 6.4 (eq. 6.14: ρ/π Σ W L), for voxels instead of pixels. With T this operator and L₁ the first scattering,
// n rounds of L ← L₁ + T L give the first n + 1 scatterings. The weights sum to at most π and opacities to 1, so that
// T's gain is at most the albedo.
// Reads per filled voxel: 40 B and 12 cones; writes one texel.

import role/hemisphere;
import lib/filled;
import lib/math;
import lib/two_sided;
import lib/voxel_sums;
import role/cones;
import role/storage;

struct Knobs {
    cone_step: f32,
    cone_footprint: f32,
    cone_density: f32,
    exact_weights: u32,
}

var<uniform> knobs: Knobs;

/// Premultiplied radiance; opacity 1 where there is a surface.
var bounced: texture_storage_3d<rgba16float, write>;

/// Irradiance from the voxels on the side of `n`.
fn gather_reflected(position: vec3f, n: vec3f) -> vec3f {
    let cones = ConeKnobs(knobs.cone_step, knobs.cone_footprint, knobs.cone_density);
    let frame = frame_around(n);
    let resolution = f32(textureDimensions(bounced).x);
    var axis = vec4f(0.0);
    var sides = vec4f(0.0);
    for (var i = 0u; i < CONES; i++) {
        var cone = cone_begin(position, n, frame * cone_axis(i), resolution);
        var radiance = vec4f(0.0);
        for (var k = 0u; k < MOST_STEPS && cone_advance(&cone, cones); k++) {
            let found = reflected_at(cone_position(cone), cone.level, cone.direction);
            radiance += cone_absorb(&cone, found.a, cones) * found;
        }
        if i == 0u {
            axis = radiance;
        } else {
            sides += radiance;
        }
    }
    return PI * hemisphere_mean(axis, sides, knobs.exact_weights != 0u).rgb;
}

@compute @workgroup_size(4, 4, 4)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let size = textureDimensions(bounced);
    let inside = all(id < size);
    let filled = inside && is_filled(id, size.x);
    if inside && !filled {
        textureStore(bounced, id, vec4f(0.0));
    }
    if local >= list_filled(filled, local) {
        return;
    }
    let voxel = filled_voxel(local, group);
    let surfel = surfel_of(voxel, size.x);
    let n = unit_or(surfel.normal, vec3f(0.0, 1.0, 0.0));
    let sides = Sides(gather_reflected(surfel.position, n), gather_reflected(surfel.position, -n));
    textureStore(bounced, voxel, vec4f(surfel.albedo / PI * brighter(sides), 1.0));
}
