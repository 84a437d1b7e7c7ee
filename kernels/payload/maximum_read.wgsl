// Module behind `role/voxels` of the payload `maximum`. Costs as lib/packed_read.

import lib/packed_read;

/// The brighter one, as among fragments.
@if(scene.moving)
fn combined(one: u32, other: u32) -> vec3f {
    return unpacked(max(one, other));
}
