// Voxelizes with one fragment for each column of each triangle (R 4.1.2).
//
// Reads per vertex 3 corners; per fragment what the payload wants; writes per fragment what the payload does.

import lib/outline;

struct Knobs {
    separability: u32,
}

var<uniform> knobs: Knobs;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Outlined {
    return outline_vertex(index / 3u, index % 3u, knobs.separability);
}

@fragment
fn fragment(in: Outlined) {
    outline_fragment(in, knobs.separability);
}
