// The mean of a texel's four neighbours on a torus.

var heat: texture_2d<f32>;
var next: texture_storage_2d<r32float, write>;

@compute @workgroup_size(4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(next);
    if any(id.xy >= size) {
        return;
    }
    var sum = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let step = select(vec2u(1u, 0u), vec2u(0u, 1u), i >= 2u);
        let at = id.xy + select(step, size - step, i % 2u == 1u);
        sum += textureLoad(heat, at % size, 0).r;
    }
    textureStore(next, id.xy, vec4f(0.25 * sum));
}
