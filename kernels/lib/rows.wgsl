// Order of the bits in lib/filled_words: by number of the voxels, rows along x.

import lib/grid;

/// The axis of the grid along which bits follow each other.
const BIT_AXIS: u32 = 0u;

fn bit_of(voxel: vec3u) -> u32 {
    return voxel_number(voxel);
}

/// Number of the voxel that has a bit.
fn number_of(bit: u32) -> u32 {
    return bit;
}
