// What was worked out, as brightness.

var<storage, read> result: array<u32>;
var color: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(color);
    if all(id.xy < size) {
        let word = result[id.y * size.x + id.x];
        textureStore(color, id.xy, vec4f(vec3f(f32(word >> 24u) / 255.0), 1.0));
    }
}
