// The scene's surfaces laid out flat and without overlap in the square [0, 1]²: the buffer `atlas`.
//
// Cost of a corner: a triangle's record (16 B) and 24 B.

import lib/scene;

/// Pairs of words. Two of each instance: where its rectangle begins (2 f32); its scale (f32) and what leads to the
/// first of its corners. Then the corners of the meshes' triangles (2 f32), in their rectangles.
var<storage, read> atlas: array<vec2u>;

/// Where a corner (0, 1, 2) of a triangle lies in the square. A triangle without area is a point there.
fn atlas_corner(triangle: u32, corner: u32) -> vec2f {
    let instance = triangles[triangle].instance;
    let offset = bitcast<vec2f>(atlas[2u * instance]);
    let scale_first = atlas[2u * instance + 1u];
    return offset + bitcast<f32>(scale_first.x) * bitcast<vec2f>(atlas[scale_first.y + 3u * triangle + corner]);
}
