// Module of the role `payload`: sums of albedo, normal, position and emission over the fragments of each voxel, in fixed
// point, so that no order of the threads changes a bit (lib/sum_words).
//
// Reads as lib/surface; writes per fragment 10 atomic words (13).

import lib/fill;
import lib/fixed;
import lib/grid;
import lib/sum_words;
import lib/surface;
import lib/voxel_by_voxel;

var<storage, read_write> filled: array<atomic<u32>>;
var<storage, read_write> sums: array<atomic<u32>>;

fn add_fragment(surface: Surface, voxel: vec3u) {
    let fragment = fragment_of(surface, voxel);
    if fragment.hole {
        return;
    }
    let number = voxel_number(voxel);
    let at = number * SUM_WORDS;
    let before = atomicAdd(&sums[at], 1u);
    if before >= MOST_TERMS {
        return;
    }
    if before == 0u {
        mark_filled(number);
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
}
