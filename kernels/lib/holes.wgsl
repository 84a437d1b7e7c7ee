// Holes of masked materials, at a point of a triangle.
//
// Cost: 3 vertices, 4 texels.

import lib/material;
import lib/scene;

/// Whether there is a hole; `ids`: the corners' vertices, `w`: their weights.
@if(scene.masked)
fn hole_at(material: u32, ids: vec3u, w: vec3f) -> bool {
    let uv = w.x * corner_uv(ids.x) + w.y * corner_uv(ids.y) + w.z * corner_uv(ids.z);
    var alpha = base_color_at(material, uv, vec2f(0.0)).a;
    @if(scene.vertex_colors) {
        alpha *= w.x * corner_color(ids.x).a + w.y * corner_color(ids.y).a + w.z * corner_color(ids.z).a;
    }
    return is_hole(material, alpha);
}
