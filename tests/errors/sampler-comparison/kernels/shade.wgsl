// Shows what lies in shadow.

var shadows: texture_depth_2d;
var shadow_sampler: sampler_comparison;
var color: texture_storage_2d<rgba16float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let lit = textureSampleCompareLevel(shadows, shadow_sampler, vec2f(0.5), 0.5);
    textureStore(color, id.xy, vec4f(lit));
}
