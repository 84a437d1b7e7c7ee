// The product of a texel's coordinates.

var heat: texture_storage_2d<r32float, write>;

@compute @workgroup_size(4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < textureDimensions(heat)) {
        textureStore(heat, id.xy, vec4f(f32(id.x * id.y)));
    }
}
