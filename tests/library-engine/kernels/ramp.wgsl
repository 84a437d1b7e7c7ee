// What the role `shade` makes of each index.

import role/shade;

var<storage, read_write> line: array<f32>;

@compute @workgroup_size(8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&line) {
        line[id.x] = shade(f32(id.x));
    }
}
