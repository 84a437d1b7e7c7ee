// Module of the role `hemisphere`: any number of cones, spread so that each has the same share of the irradiance.
//
// The axes lie on a Fibonacci spiral over the unit disc, projected up to the hemisphere: cosine-distributed, so that the
// irradiance over π is the plain mean of the radiances. A number that is a power of two makes the mean of a constant field
// exact in f32. Every cone has the solid angle 2π/n: 2π (1 - cos a) for half of its aperture a.

override cone_count: u32 = 32u;

/// Number of cones.
override CONES: u32 = cone_count;
/// Diameter of a cone's samples over their distance: 2 sin a, from cos a = 1 - 1/n.
override CONE_DIAMETER: f32 = 2.0 * sqrt(1.0 - (1.0 - 1.0 / f32(cone_count)) * (1.0 - 1.0 / f32(cone_count)));

const GOLDEN_ANGLE: f32 = 2.3999632;

/// Axis of a cone; y is the normal.
fn cone_axis(i: u32) -> vec3f {
    let share = (f32(i) + 0.5) / f32(CONES);
    let angle = GOLDEN_ANGLE * f32(i);
    let radius = sqrt(share);
    return vec3f(radius * cos(angle), sqrt(1.0 - share), radius * sin(angle));
}

/// Irradiance over π from the radiance of the first cone and the sum of the others. All weigh the same; `exact` is of
/// no consequence.
fn hemisphere_mean(axis: vec4f, sides: vec4f, exact: bool) -> vec4f {
    return (axis + sides) / f32(CONES);
}
