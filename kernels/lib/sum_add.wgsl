// Adds fragments to the sums of their voxels (lib/sum_words). The payload that imports this declares `sums`,
// array<atomic<u32>>.
//
// Writes per fragment 10 atomic words (13).

import lib/fixed;
import lib/sum_words;
import lib/surface;

/// Adds to the sums that begin at word `at`, and says how many fragments they had before. MOST_TERMS are the last.
fn add_to_sums(at: u32, fragment: Fragment) -> u32 {
    let before = atomicAdd(&sums[at], 1u);
    if before >= MOST_TERMS {
        return before;
    }
    for (var i = 0u; i < 3u; i++) {
        atomicAdd(&sums[at + SUM_ALBEDO + i], fixed_unsigned(fragment.albedo[i]));
        atomicAdd(&sums[at + SUM_NORMAL + i], fixed_signed(fragment.normal[i]));
        atomicAdd(&sums[at + SUM_WITHIN + i], fixed_unsigned(fragment.within[i]));
    }
    @if(scene.emissive) {
        for (var i = 0u; i < 3u; i++) {
            if fragment.emission[i] > 0.0 {
                atomicAdd(&sums[at + SUM_EMISSION + i], fixed_unsigned(fragment.emission[i]));
            }
        }
    }
    return before;
}
