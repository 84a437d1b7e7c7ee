// Copies a picture.

var picture: texture_2d<f32>;
var smoth_edges: sampler;
var color: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(color)) {
        textureStore(color, id.xy, textureSampleLevel(picture, smoth_edges, vec2f(0.5), 0.0));
    }
}
