// Paints a picture white.

@group(0) @binding(0)
var color: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(color, id.xy, vec4f(1.0));
}
