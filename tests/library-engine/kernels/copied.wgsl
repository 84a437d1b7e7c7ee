// Copies what `uncovered` wrote.

var half_written: texture_2d<f32>;
var picture: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(picture)) {
        return;
    }
    textureStore(picture, id.xy, textureLoad(half_written, id.xy, 0));
}
