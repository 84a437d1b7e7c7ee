// For tests: the units that the corners of all triangles are snapped to. Corner c of triangle i is pixel
// (3 · (i mod 1024) + c, i / 1024).
// Reads a corner, writes a texel.

import lib/unit_corners;

var corners: texture_storage_2d<rgba32sint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let triangle = id.y * 1024u + id.x / 3u;
    if id.x < 3072u && triangle < arrayLength(&triangles) {
        textureStore(corners, id.xy, vec4i(unit_corners(triangle)[id.x % 3u], 0));
    }
}
