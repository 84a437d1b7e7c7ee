// Module of the role `payload`: sums of albedo, normal, position and emission over the fragments of each voxel, weighted by
// their areas, in fixed point, so that no order of the threads changes a bit (lib/sum_words).
//
// Reads as lib/surface; writes per fragment 10 atomic words (13).

import lib/fill;
import lib/grid;
import lib/sum_add;
import lib/voxel_by_voxel;

var<storage, read_write> filled: array<atomic<u32>>;
var<storage, read_write> sums: array<atomic<u32>>;

fn add_piece(surface: Surface, voxel: vec3u, piece: Piece) {
    let fragment = fragment_of(surface, voxel, piece);
    if fragment.hole {
        return;
    }
    let number = voxel_number(voxel);
    if add_to_sums(number * SUM_WORDS, fragment, piece.area) == 0u {
        mark_filled(number);
    }
}
