// Order of the bits in lib/filled_words: a binary slice map. A column of voxels along the grid's z axis is a texel of
// whole words, its bits from the lowest z; texels follow each other along x. Words are filled up with bits that stay
// zero.
//
// Source: T (the paper on voxel-based global illumination of 2011), 3.1 and figure 5: 32 voxels of depth are tested by
// one word. T blends bits into the channels of a texture, 128 at most; here words are added to from any kernel, and
// deeper columns have more of them. They are in a buffer, since WebGPU has atomics for buffers and none for textures.

import lib/grid;

/// The axis of the grid along which bits follow each other.
const BIT_AXIS: u32 = 2u;

/// Of a texel.
fn slice_words() -> u32 {
    return (values.grid_size.z + 31u) / 32u;
}

fn bit_of(voxel: vec3u) -> u32 {
    return 32u * slice_words() * (voxel.y * values.grid_size.x + voxel.x) + voxel.z;
}

/// Number of the voxel that has a bit.
fn number_of(bit: u32) -> u32 {
    let depth = 32u * slice_words();
    let texel = bit / depth;
    return voxel_number(vec3u(texel % values.grid_size.x, texel / values.grid_size.x, bit % depth));
}
