// Voxelizes the triangles of a list with one fragment for each of their columns (R 4.1.2, figure 4.15).
//
// Reads per vertex a word and 3 corners; per fragment what the payload wants; writes per fragment what the payload does.

import lib/outline;

struct Knobs {
    separability: u32,
}

var<uniform> knobs: Knobs;
var<storage, read> large: array<u32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Outlined {
    return outline_vertex(large[index / 3u], index % 3u, knobs.separability);
}

@fragment
fn fragment(in: Outlined) {
    outline_fragment(in, knobs.separability);
}
