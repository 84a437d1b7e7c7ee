// Where the camera is, by a named value.

struct Values {
    eye: vec3f,
}

var<uniform> values: Values;
var<storage, read_write> found: array<f32>;

@compute @workgroup_size(1)
fn main() {
    for (var i = 0u; i < 3u; i++) {
        found[i] = values.eye[i];
    }
}
