// Module of the role `payload`: a binary slice map (lib/slices). Costs as lib/mark.

import lib/mark;
import lib/no_attributes;
import lib/slices;

var<storage, read_write> filled: array<atomic<u32>>;

/// Voxel `first` and those behind it along x, by the bits from the lowest: they are in a texel each.
fn mark_along(first: vec3u, bits: u32) {
    var left = bits;
    for (var k = 0u; k < 32u && left != 0u; k++) {
        mark_bit(bit_of(first + vec3u(take_bit(&left), 0u, 0u)));
    }
}
