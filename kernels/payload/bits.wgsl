// Module of the role `payload`: a bit for each voxel, 32 along x to a word (or over the ends of rows: by number).
//
// Reads a word per fragment, and adds to one where the bit was not set.

import lib/grid;
import lib/listing;

@if(geometry.moving) var<storage, read_write> moving_bits: array<atomic<u32>>;
@else var<storage, read_write> bits: array<atomic<u32>>;

/// Nothing more is known of a triangle.
struct Surface {
    triangle: u32,
}

fn surface_of(triangle: u32, corners: array<vec3f, 3>) -> Surface {
    return Surface(triangle);
}

/// What word `at` was before the bits of `mask` were set. Most are set already: looking first costs less than adding.
fn set_bits(at: u32, mask: u32) -> u32 {
    @if(geometry.moving) {
        if (atomicLoad(&moving_bits[at]) & mask) == mask {
            return mask;
        }
        return atomicOr(&moving_bits[at], mask);
    } @else {
        if (atomicLoad(&bits[at]) & mask) == mask {
            return mask;
        }
        return atomicOr(&bits[at], mask);
    }
}

fn add_fragment(surface: Surface, voxel: vec3u) {
    let number = voxel_number(voxel);
    if set_bits(number / 32u, 1u << (number % 32u)) == 0u {
        list_voxel(number / 32u);
    }
}
