// The corners of the scene's triangles in units of the grid (lib/units).

import lib/grid;
import lib/scene;
import lib/units;

/// A triangle's corners, snapped.
fn unit_corners(triangle: u32) -> array<vec3i, 3> {
    let p = corner_positions(triangle);
    return array(snapped(to_grid(p[0])), snapped(to_grid(p[1])), snapped(to_grid(p[2])));
}
