// What the voxelizer leaves in each voxel: sums over its fragments (a fragment: one triangle in one voxel), in fixed
// point (lib/fixed), read back as means. lib/sum_words says what they are.
//
// Reads 4 B for an empty voxel, 40 B for a filled one.

import lib/fixed;
import lib/grid;
import lib/sum_words;

var<storage, read> sums: array<u32>;
/// The same of what moves.
@if(scene.moving)
var<storage, read> moving_sums: array<u32>;

/// Word `at` of the sums over all fragments, still and moving.
fn sum_at(at: u32) -> u32 {
    @if(scene.moving) {
        return sums[at] + moving_sums[at];
    } @else {
        return sums[at];
    }
}

/// The number of fragments whose sums begin at word `at`.
fn fragments_at(at: u32) -> u32 {
    @if(scene.moving) {
        return min(sums[at], MOST_TERMS) + min(moving_sums[at], MOST_TERMS);
    } @else {
        return min(sums[at], MOST_TERMS);
    }
}

/// The surface in a voxel.
struct Surfel {
    filled: bool,
    albedo: vec3f,
    /// Mean of the fragments' unit normals: shorter the less they agree, zero for two opposite faces.
    normal: vec3f,
    /// World space, metres; on the surface where that is flat.
    position: vec3f,
}

/// Whether any fragment lies in the voxel.
fn is_filled(voxel: vec3u, resolution: u32) -> bool {
    return fragments_at(voxel_number(voxel, resolution) * SUM_WORDS) > 0u;
}

fn surfel_of(voxel: vec3u, resolution: u32) -> Surfel {
    let at = voxel_number(voxel, resolution) * SUM_WORDS;
    let count = fragments_at(at);
    if count == 0u {
        return Surfel(false, vec3f(0.0), vec3f(0.0), vec3f(0.0));
    }
    let albedo = vec3f(
        mean_unsigned(sum_at(at + SUM_ALBEDO), count),
        mean_unsigned(sum_at(at + SUM_ALBEDO + 1u), count),
        mean_unsigned(sum_at(at + SUM_ALBEDO + 2u), count),
    );
    let normal = vec3f(
        mean_signed(sum_at(at + SUM_NORMAL), count),
        mean_signed(sum_at(at + SUM_NORMAL + 1u), count),
        mean_signed(sum_at(at + SUM_NORMAL + 2u), count),
    );
    let within = vec3f(
        mean_unsigned(sum_at(at + SUM_WITHIN), count),
        mean_unsigned(sum_at(at + SUM_WITHIN + 1u), count),
        mean_unsigned(sum_at(at + SUM_WITHIN + 2u), count),
    );
    return Surfel(true, albedo, normal, from_grid(vec3f(voxel) + within));
}
