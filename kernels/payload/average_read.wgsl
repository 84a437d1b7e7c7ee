// Module behind `role/voxels` of the payload `average`. Costs as lib/packed_read.

import lib/packed_read;

/// The mean of two averages, by their counts.
@if(scene.moving)
fn combined(one: u32, other: u32) -> vec3f {
    let counts = vec2f(vec2u(one >> 24u, other >> 24u));
    return (unpacked(one) * counts.x + unpacked(other) * counts.y) / max(counts.x + counts.y, 1.0);
}
