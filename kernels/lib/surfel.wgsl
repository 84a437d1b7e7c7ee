// The surface in a voxel, as payloads give it.

struct Surfel {
    filled: bool,
    albedo: vec3f,
    /// Mean of the fragments' unit normals: shorter the less they agree, zero for two opposite faces.
    normal: vec3f,
    /// World space, metres; no further from the surface than half the voxel's diagonal.
    position: vec3f,
}

/// Where there is nothing.
fn no_surfel() -> Surfel {
    return Surfel(false, vec3f(0.0), vec3f(0.0), vec3f(0.0));
}
