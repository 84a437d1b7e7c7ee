// Copies a texel.

var stored: texture_2d<f32>;
var copy: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(copy, id.xy, textureLoad(stored, id.xy, 0));
}
