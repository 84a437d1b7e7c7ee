// Module behind `role/voxels` of the payload `maximum`. Costs as lib/packed_read.

import lib/packed_read;

/// The brighter one, as among fragments.
@if(scene.moving)
fn combined(one: u32, other: u32) -> vec3f {
    return unpacked(max(one, other));
}

/// 1 where a fragment lies: they are not counted.
fn fragment_count(voxel: vec3u) -> u32 {
    return u32(is_filled(voxel));
}
