// Paints a picture white.

var<storage, read_write> color: array<vec4f>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    color[id.x] = vec4f(1.0);
}
