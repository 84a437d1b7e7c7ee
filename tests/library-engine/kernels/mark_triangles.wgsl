// Adds to the mark of each triangle how many triangles the stage goes over. A workgroup is one thread, so that a thread
// too many shows.

struct Geometry {
    first: u32,
    triangles: u32,
}

var<uniform> geometry: Geometry;
var<storage, read_write> marks: array<u32>;

@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    marks[geometry.first + id.x] += geometry.triangles;
}
