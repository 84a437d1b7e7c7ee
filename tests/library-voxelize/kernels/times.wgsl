// For tests: the numbers of a buffer. Number i is pixel (i mod width, i / width).
// Reads a word, writes a texel.

var<storage, read> times: array<u32>;
var listed: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(listed);
    if all(id.xy < size) {
        textureStore(listed, id.xy, vec4u(times[id.y * size.x + id.x], 0u, 0u, 0u));
    }
}
