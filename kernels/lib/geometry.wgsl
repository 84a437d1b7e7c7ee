// The triangles that a stage goes over (`geometry` in its RON): all of the scene's, the still or the moving ones.

struct Geometry {
    /// The scene's number of the first one.
    first: u32,
    triangles: u32,
}

var<uniform> geometry: Geometry;
