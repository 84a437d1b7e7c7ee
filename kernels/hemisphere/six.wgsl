// Module of the role `hemisphere`: six cones of 60°, and the weights of their radiances in the irradiance.
//
// Source: R eq. 6.8, 6.9. The hemisphere is cut into the cap within 30° of the normal and five sectors around it;
// ∫ cosθ dω over them is π/4 and 3π/20, together π. After the division by π (Lambert: ρ/π) the weights are 1/4 and
// 3/20 = 5/20 and 3/20: small integers over 20, so that a constant field gives exactly its value in f32.
// Variant (`exact`): weights 1/3 and 2/15 integrate 1, cosθ and cos²θ exactly when the cones return axis values.

const CONES: u32 = 6u;
/// Diameter of a cone's samples over their distance: 2 sin 30°.
const CONE_DIAMETER: f32 = 1.0;

/// Axis of a cone; y is the normal.
fn cone_axis(i: u32) -> vec3f {
    var axes = array<vec3f, 6>(
        vec3f(0.0, 1.0, 0.0),
        vec3f(0.0, 0.5, 0.866025),
        vec3f(0.823639, 0.5, 0.267617),
        vec3f(0.509037, 0.5, -0.700629),
        vec3f(-0.509037, 0.5, -0.700629),
        vec3f(-0.823639, 0.5, 0.267617),
    );
    return axes[i];
}

/// Irradiance over π from the radiance of the cone along the normal and the sum of the other five.
fn hemisphere_mean(axis: vec4f, sides: vec4f, exact: bool) -> vec4f {
    let weight = select(3.0, 2.0, exact);
    return (5.0 * axis + weight * sides) / (5.0 + 5.0 * weight);
}
