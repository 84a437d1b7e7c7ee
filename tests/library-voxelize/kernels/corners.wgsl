// For tests: the units that the corners of all triangles are snapped to. Corner c of triangle i is pixel
// (3 · (i mod 1024) + c, i / 1024).
// Reads a corner, writes a texel.

import lib/grid;
import lib/overlap;
import lib/scene;

var corners: texture_storage_2d<rgba32sint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let triangle = id.y * 1024u + id.x / 3u;
    if id.x < 3072u && triangle < arrayLength(&triangles) {
        let t = triangles[triangle];
        let vertex = array(t.a, t.b, t.c)[id.x % 3u];
        let unit = snapped(to_grid(corner_position(vertex, t.instance)));
        textureStore(corners, id.xy, vec4i(unit, 0));
    }
}
