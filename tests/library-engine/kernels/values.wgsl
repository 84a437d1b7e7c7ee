// The named values as they are.

struct Values {
    middle: vec3f,
    height: f32,
}

var<uniform> values: Values;
var<storage, read_write> found: array<f32>;

@compute @workgroup_size(1)
fn main() {
    for (var i = 0u; i < 3u; i++) {
        found[i] = values.middle[i];
    }
    found[3] = values.height;
}
