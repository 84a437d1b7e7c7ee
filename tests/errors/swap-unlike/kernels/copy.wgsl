// Copies a picture.

var picture: texture_2d<f32>;
var color: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(color)) {
        textureStore(color, id.xy, textureLoad(picture, id.xy, 0));
    }
}
