// A ramp from left to right, without noise.

var color: texture_storage_2d<rgba32float, write>;
var color_variance: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(color);
    if all(id.xy < size) {
        textureStore(color, id.xy, vec4f(vec3f(1.0 + f32(id.x) / f32(size.x)), 1.0));
        textureStore(color_variance, id.xy, vec4f(0.0));
    }
}
