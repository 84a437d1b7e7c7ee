// Sums over the fragments of each voxel (a fragment: one triangle in one voxel), in fixed point (lib/fixed), read back as
// means; lib/sum_words says what they are. The module that imports this says where a voxel's sums are, `place_of(number)`
// of a type that is its own, and what they hold of still and moving fragments together: `sum_at(place, word)`.
//
// Reads 40 B of a voxel, 12 B more for its emission, besides what finding its place takes.

import lib/fixed;
import lib/grid;
import lib/is_filled;
import lib/sum_words;
import lib/surfel;

fn mean_of_unsigned(place: Place, word: u32, weights: u32) -> vec3f {
    return vec3f(
        mean_unsigned(sum_at(place, word), weights),
        mean_unsigned(sum_at(place, word + 1u), weights),
        mean_unsigned(sum_at(place, word + 2u), weights),
    );
}

fn surfel_of(voxel: vec3u) -> Surfel {
    if any(voxel >= values.grid_size) {
        return no_surfel();
    }
    let place = place_of(voxel_number(voxel));
    let weights = sum_at(place, 0u);
    if weights == 0u {
        return no_surfel();
    }
    let normal = vec3f(
        mean_signed(sum_at(place, SUM_NORMAL), weights),
        mean_signed(sum_at(place, SUM_NORMAL + 1u), weights),
        mean_signed(sum_at(place, SUM_NORMAL + 2u), weights),
    );
    let within = mean_of_unsigned(place, SUM_WITHIN, weights);
    return Surfel(true, mean_of_unsigned(place, SUM_ALBEDO, weights), normal, from_grid(vec3f(voxel) + within));
}

/// Mean over all pieces, so that a voxel that is half lamp, half wall emits half: radiance, in units of the scene's
/// greatest emission.
@if(scene.emissive)
fn emission_of(voxel: vec3u) -> vec3f {
    if any(voxel >= values.grid_size) {
        return vec3f(0.0);
    }
    let place = place_of(voxel_number(voxel));
    let weights = sum_at(place, 0u);
    if weights == 0u {
        return vec3f(0.0);
    }
    return mean_of_unsigned(place, SUM_EMISSION, weights);
}
