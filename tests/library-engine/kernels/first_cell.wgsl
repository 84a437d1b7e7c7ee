// The first texel of a volume, everywhere.

var cells: texture_3d<f32>;
var color: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(color)) {
        textureStore(color, id.xy, textureLoad(cells, vec3u(0u), 0));
    }
}
