// Each texel's own position.

var grid: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(grid)) {
        return;
    }
    textureStore(grid, id.xy, vec4f(vec2f(id.xy), 0.0, 1.0));
}
