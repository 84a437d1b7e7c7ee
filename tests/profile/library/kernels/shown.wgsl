// A list of words as a picture, row by row: outputs are pictures.

var<storage, read> list: array<u32>;
var shown: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(shown);
    if all(id.xy < size) {
        textureStore(shown, id.xy, vec4u(list[size.x * id.y + id.x]));
    }
}
