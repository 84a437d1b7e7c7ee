// How large a triangle is: which ones are small, that is voxelized by a thread of their own, is up to the knob `cutoff`
// (R 4.1.3: of the sizes that it compares, this area worked best).

import lib/columns;

struct CutoffKnobs {
    separability: u32,
    /// Voxels².
    cutoff: f32,
}

var<uniform> knobs: CutoffKnobs;

/// Area across the axis that the normal is nearest to, in voxels²; of what lies outside the grid no more than its
/// bounds there.
fn projected_area(placed: Placed) -> f32 {
    let along = placed_along(placed, placed.facing.axis);
    let u = vec2f(along.corners[1].xy - along.corners[0].xy) / f32(UNITS);
    let v = vec2f(along.corners[2].xy - along.corners[0].xy) / f32(UNITS);
    let bounds = vec2f(along.size.xy + 1);
    return min(0.5 * abs(u.x * v.y - u.y * v.x), bounds.x * bounds.y);
}

fn is_large(placed: Placed) -> bool {
    return projected_area(placed) > knobs.cutoff;
}
