// Module behind `role/voxels` of the payload `slices`.

import lib/filled_bits;
import lib/slices;

/// 1 where a fragment lies: they are not counted.
fn fragment_count(voxel: vec3u) -> u32 {
    return u32(is_filled(voxel));
}
