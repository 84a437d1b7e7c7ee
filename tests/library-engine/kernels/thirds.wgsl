// Numbers that formats hold differently.

var stored: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(stored, id.xy, vec4f(1.0 / 3.0, 0.71, 1.5, -2.0));
}
