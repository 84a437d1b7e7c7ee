// Module of the role `payload`: the brightest fragment of each voxel, by an atomic maximum of packed words.
//
// Source: R 5.1.1, with the order that it wants: words are compared by their highest byte, which is the luminance of the
// albedo here (of the emission, for that), and the rest says which of equal ones wins, so that no order of the threads
// changes a bit. lib/packed_words says where what lies.
// Reads as lib/surface; writes per fragment 2 words (3).

import lib/color;
import lib/fill;
import lib/grid;
import lib/packed_words;
import lib/voxel_by_voxel;

var<storage, read_write> filled: array<atomic<u32>>;
var<storage, read_write> packed: array<atomic<u32>>;
@if(scene.emissive)
var<storage, read_write> packed_emission: array<atomic<u32>>;

fn byte_of_luminance(color: vec3f) -> u32 {
    return bytes_of(vec3f(luminance(color))).x;
}

fn add_piece(surface: Surface, voxel: vec3u, piece: Piece) {
    let fragment = fragment_of(surface, voxel, piece);
    if fragment.hole {
        return;
    }
    let number = voxel_number(voxel);
    mark_filled(number);
    let key = byte_of_luminance(fragment.albedo);
    let at = number * PACKED_WORDS;
    atomicMax(&packed[at + PACKED_ALBEDO], packed_bytes(bytes_of(fragment.albedo), key));
    atomicMax(&packed[at + PACKED_NORMAL], packed_bytes(bytes_of(normal_to_unit(fragment.normal)), key));
    @if(scene.emissive) {
        let brightness = byte_of_luminance(fragment.emission);
        atomicMax(&packed_emission[number], packed_bytes(bytes_of(fragment.emission), brightness));
    }
}
