// Adds fragments to the sums of their voxels (lib/sum_words). The payload that imports this declares `sums`,
// array<atomic<u32>>.
//
// Writes per fragment 10 atomic words (13).

import lib/fixed;
import lib/sum_words;
import lib/surface;

/// Adds to the sums that begin at word `at` with the weight of an area in faces of a voxel, and says what weights they
/// had before: at MOST_WEIGHT they are full.
fn add_to_sums(at: u32, fragment: Fragment, area: f32) -> u32 {
    let full = atomicLoad(&sums[at]);
    if full >= MOST_WEIGHT {
        return full;
    }
    let weight = weight_of(area);
    let before = atomicAdd(&sums[at], u32(nearest_integer(weight)));
    for (var i = 0u; i < 3u; i++) {
        atomicAdd(&sums[at + SUM_ALBEDO + i], weighted_unsigned(fragment.albedo[i], weight));
        atomicAdd(&sums[at + SUM_NORMAL + i], weighted_signed(fragment.normal[i], weight));
        atomicAdd(&sums[at + SUM_WITHIN + i], weighted_unsigned(fragment.within[i], weight));
    }
    @if(scene.emissive) {
        for (var i = 0u; i < 3u; i++) {
            if fragment.emission[i] > 0.0 {
                atomicAdd(&sums[at + SUM_EMISSION + i], weighted_unsigned(fragment.emission[i], weight));
            }
        }
    }
    return before;
}
