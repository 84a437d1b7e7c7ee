// The walk of a ray through a grid of cubes, from face to face (Amanatides and Woo 1987, "A Fast Voxel Traversal
// Algorithm for Ray Tracing"). Lengths are cubes.

struct Walk {
    origin: vec3f,
    inverse: vec3f,
    forward: vec3i,
    side: vec3i,
    /// Where it is.
    cube: vec3i,
    /// The axis across whose face it came in: 0, 1, 2.
    axis: u32,
    /// Whether it is in the grid.
    inside: bool,
}

/// Of a ray through the box [0, side].
fn walk_begin(origin: vec3f, along: vec3f, side: vec3i) -> Walk {
    // No component is zero, so that no division is by zero.
    let direction = select(along, vec3f(1e-9), abs(along) < vec3f(1e-9));
    let inverse = 1.0 / direction;
    let a = -origin * inverse;
    let b = (vec3f(side) - origin) * inverse;
    let enters = min(a, b);
    let leaves = max(a, b);
    let near = max(max(enters.x, enters.y), max(enters.z, 0.0));
    let far = min(leaves.x, min(leaves.y, leaves.z));
    let cube = clamp(vec3i(floor(origin + near * direction)), vec3i(0), side - 1);
    let axis = select(select(2u, 1u, enters.y == near), 0u, enters.x == near);
    return Walk(origin, inverse, vec3i(sign(direction)), side, cube, axis, near < far);
}

fn walk_on(walk: ptr<function, Walk>) {
    let toward = vec3f(max((*walk).forward, vec3i(0)));
    let crossing = (vec3f((*walk).cube) + toward - (*walk).origin) * (*walk).inverse;
    let nearest = min(crossing.x, min(crossing.y, crossing.z));
    let axis = select(select(2u, 1u, crossing.y == nearest), 0u, crossing.x == nearest);
    (*walk).axis = axis;
    (*walk).cube += (*walk).forward * vec3i(vec3u(0u, 1u, 2u) == vec3u(axis));
    (*walk).inside = all((*walk).cube >= vec3i(0)) && all((*walk).cube < (*walk).side);
}
