// Puts the point of the surface that each texel of the atlas stands for into its voxel: second pass of the atlas
// voxelizer (T, chapter 3, where the points are drawn).
//
// A point is where the texel's centre lies in the triangle whose corners are snapped (lib/units), so it lies in a
// voxel that the triangle meets. Where rounding could have moved it over a face, integers decide whether the triangle
// meets that voxel; if not, the point is left out. On a face exactly it is in the voxel above.
// Reads per texel its number; of those with a triangle 3 corners (ca. 250 B) and what the payload wants.

import lib/atlas;
import lib/grid;
import lib/math;
import lib/overlap_exact;
import lib/unit_corners;
import role/payload;

/// Bounds what single floats lose in a point's place, in parts of the largest coordinate: 16 roundings.
const PLACE_DOUBT: f32 = 1.9073486e-6;

/// Numbers of triangles and 1; 0 where there is none.
var triangle_map: texture_2d<u32>;

/// The point of a triangle that is at `place`, or next to it; and the triangle's area per area of the atlas.
/// `corners`: in voxels.
fn atlas_piece(triangle: u32, corners: array<vec3f, 3>, place: vec2f) -> Piece {
    let a = atlas_corner(triangle, 0u);
    let u = atlas_corner(triangle, 1u) - a;
    let v = atlas_corner(triangle, 2u) - a;
    let p = place - a;
    let area = max(cross_2(u, v), 1e-30);
    let b = clamp(cross_2(p, v) / area, 0.0, 1.0);
    let c = clamp(cross_2(u, p) / area, 0.0, 1.0 - b);
    let point = (1.0 - b - c) * corners[0] + b * corners[1] + c * corners[2];
    let whole = length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    return Piece(whole / area, point, vec3f(1.0 - b - c, b, c));
}

/// Whether a triangle, its corners in units, meets the voxel; exact.
fn triangle_meets(corners: array<vec3i, 3>, voxel: vec3i) -> bool {
    var p: array<vec3i, 3>;
    for (var i = 0u; i < 3u; i++) {
        p[i] = corners[i] - voxel * UNITS;
    }
    let low = voxel_of(min(p[0], min(p[1], p[2])));
    let high = voxel_of(max(p[0], max(p[1], p[2])));
    if any(low > vec3i(0)) || any(high < vec3i(0)) {
        return false;
    }
    return exactly_fills(asked_of(p, facing_of(p), false), vec3i(0), true, true);
}

/// Adds the point of `triangle` at a place of the atlas, if it lies in the grid, for a texel of this area of the atlas.
fn add_point(triangle: u32, place: vec2f, texel: f32) {
    let corners = unit_corners(triangle);
    // From the first corner's voxel on, so that little is lost.
    let first = voxel_of(corners[0]);
    var placed: array<vec3f, 3>;
    var near: array<vec3f, 3>;
    for (var i = 0u; i < 3u; i++) {
        placed[i] = vec3f(corners[i]) / f32(UNITS);
        near[i] = vec3f(corners[i] - first * UNITS) / f32(UNITS);
    }
    var piece = atlas_piece(triangle, near, place);
    piece.area *= texel;
    let point = piece.middle;
    piece.middle += vec3f(first);
    let voxel = first + vec3i(floor(point));
    if any(voxel < vec3i(0)) || any(voxel >= vec3i(values.grid_size)) {
        return;
    }
    let largest = max(abs(near[0]), max(abs(near[1]), abs(near[2])));
    let doubt = PLACE_DOUBT * (1.0 + max(largest.x, max(largest.y, largest.z)));
    let doubtful = any(abs(fract(point) - 0.5) > vec3f(0.5 - doubt));
    if !doubtful || triangle_meets(corners, voxel) {
        add_piece(surface_of(triangle, placed), vec3u(voxel), piece);
    }
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(triangle_map);
    if any(id.xy >= size) {
        return;
    }
    let number = textureLoad(triangle_map, id.xy, 0).x;
    if number > 0u {
        let texel = 1.0 / vec2f(size);
        add_point(number - 1u, (vec2f(id.xy) + 0.5) * texel, texel.x * texel.y);
    }
}
