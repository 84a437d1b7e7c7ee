// Module behind `role/voxels` of the payload `average`. Costs as lib/packed_read.

import lib/packed_read;

/// The mean of two averages, by their counts.
@if(scene.moving)
fn combined(one: u32, other: u32) -> vec3f {
    let counts = vec2f(vec2u(one >> 24u, other >> 24u));
    return (unpacked(one) * counts.x + unpacked(other) * counts.y) / max(counts.x + counts.y, 1.0);
}

/// Fragments in the voxel; more than 255 of still triangles, or of moving ones, count as that many.
fn fragment_count(voxel: vec3u) -> u32 {
    if !is_filled(voxel) {
        return 0u;
    }
    let at = voxel_number(voxel) * PACKED_WORDS;
    @if(scene.moving) {
        return (packed[at] >> 24u) + (moving_packed[at] >> 24u);
    } @else {
        return packed[at] >> 24u;
    }
}
