// Numbers the pixels.

var numbers: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    textureStore(numbers, id.xy, vec4u(id.x, 0u, 0u, 0u));
}
