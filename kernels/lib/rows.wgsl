// Order of the bits in lib/filled_words: by number of the voxels, rows along x.

import lib/grid;

fn bit_of(voxel: vec3u) -> u32 {
    return voxel_number(voxel);
}

/// Number of the voxel that has a bit.
fn number_of(bit: u32) -> u32 {
    return bit;
}
