// Sums over the fragments of each voxel (a fragment: one triangle in one voxel), in fixed point (lib/fixed), read back as
// means; lib/sum_words says what they are. The module that imports this says where a voxel's sums are, `place_of(number)`
// of a type that is its own, and what they hold of still and moving fragments together: `sum_at(place, word)`, and
// `fragments_at(place)`, 0 where there are none.
//
// Reads 40 B of a voxel, 12 B more for its emission, besides what finding its place takes.

import lib/fixed;
import lib/grid;
import lib/is_filled;
import lib/sum_words;
import lib/surfel;

/// Fragments in the voxel; more than MOST_TERMS of still triangles, or of moving ones, count as that many.
fn fragment_count(voxel: vec3u) -> u32 {
    if any(voxel >= values.grid_size) {
        return 0u;
    }
    return fragments_at(place_of(voxel_number(voxel)));
}

fn mean_of_unsigned(place: Place, word: u32, count: u32) -> vec3f {
    return vec3f(
        mean_unsigned(sum_at(place, word), count),
        mean_unsigned(sum_at(place, word + 1u), count),
        mean_unsigned(sum_at(place, word + 2u), count),
    );
}

fn surfel_of(voxel: vec3u) -> Surfel {
    if any(voxel >= values.grid_size) {
        return no_surfel();
    }
    let place = place_of(voxel_number(voxel));
    let count = fragments_at(place);
    if count == 0u {
        return no_surfel();
    }
    let normal = vec3f(
        mean_signed(sum_at(place, SUM_NORMAL), count),
        mean_signed(sum_at(place, SUM_NORMAL + 1u), count),
        mean_signed(sum_at(place, SUM_NORMAL + 2u), count),
    );
    let within = mean_of_unsigned(place, SUM_WITHIN, count);
    return Surfel(true, mean_of_unsigned(place, SUM_ALBEDO, count), normal, from_grid(vec3f(voxel) + within));
}

/// Mean over all fragments, so that a voxel that is half lamp, half wall emits half: radiance, in units of the scene's
/// greatest emission.
@if(scene.emissive)
fn emission_of(voxel: vec3u) -> vec3f {
    if any(voxel >= values.grid_size) {
        return vec3f(0.0);
    }
    let place = place_of(voxel_number(voxel));
    let count = fragments_at(place);
    if count == 0u {
        return vec3f(0.0);
    }
    return mean_of_unsigned(place, SUM_EMISSION, count);
}
