// Module behind `role/voxels` of the payload `sums`: sums over the fragments of each voxel (a fragment: one triangle in
// one voxel), in fixed point (lib/fixed), read back as means. lib/sum_words says what they are.
//
// Reads 4 B for an empty voxel, 40 B for a filled one.

import lib/fixed;
import lib/grid;
import lib/is_filled;
import lib/sum_words;
import lib/surfel;

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

/// Fragments in the voxel; more than MOST_TERMS of still triangles, or of moving ones, count as that many.
fn fragment_count(voxel: vec3u) -> u32 {
    if any(voxel >= values.grid_size) {
        return 0u;
    }
    return fragments_at(voxel_number(voxel) * SUM_WORDS);
}

fn mean_of_unsigned(at: u32, count: u32) -> vec3f {
    return vec3f(
        mean_unsigned(sum_at(at), count),
        mean_unsigned(sum_at(at + 1u), count),
        mean_unsigned(sum_at(at + 2u), count),
    );
}

fn surfel_of(voxel: vec3u) -> Surfel {
    let count = fragment_count(voxel);
    if count == 0u {
        return Surfel(false, vec3f(0.0), vec3f(0.0), vec3f(0.0));
    }
    let at = voxel_number(voxel) * SUM_WORDS;
    let normal = vec3f(
        mean_signed(sum_at(at + SUM_NORMAL), count),
        mean_signed(sum_at(at + SUM_NORMAL + 1u), count),
        mean_signed(sum_at(at + SUM_NORMAL + 2u), count),
    );
    let within = mean_of_unsigned(at + SUM_WITHIN, count);
    return Surfel(true, mean_of_unsigned(at + SUM_ALBEDO, count), normal, from_grid(vec3f(voxel) + within));
}

/// Mean over all fragments, so that a voxel that is half lamp, half wall emits half: radiance, in units of the scene's
/// greatest emission.
@if(scene.emissive)
fn emission_of(voxel: vec3u) -> vec3f {
    let count = fragment_count(voxel);
    if count == 0u {
        return vec3f(0.0);
    }
    return mean_of_unsigned(voxel_number(voxel) * SUM_WORDS + SUM_EMISSION, count);
}
