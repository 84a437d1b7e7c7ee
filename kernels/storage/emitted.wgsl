// Emission of each voxel from the voxelizer's sums: premultiplied radiance and opacity 1 where there is a surface.
//
// Every fragment counts in the mean, so that a voxel that is half lamp, half wall emits half. (A voxel has no sides:
// emission leaves to the back too.)
// Reads 4 B, 16 B where filled; writes one texel.

import lib/voxel_sums;

@if(scene.emissive)
struct SceneFacts {
    max_emission: f32,
}

@if(scene.emissive)
var<uniform> scene: SceneFacts;

var voxels: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(voxels);
    if any(id >= size) {
        return;
    }
    let at = voxel_number(id, size.x) * SUM_WORDS;
    let count = fragments_at(at);
    var value = vec4f(0.0);
    if count > 0u {
        value.a = 1.0;
        @if(scene.emissive) {
            let mean = vec3f(
                mean_unsigned(sum_at(at + SUM_EMISSION), count),
                mean_unsigned(sum_at(at + SUM_EMISSION + 1u), count),
                mean_unsigned(sum_at(at + SUM_EMISSION + 2u), count),
            );
            value = vec4f(min(mean * scene.max_emission, vec3f(65504.0)), 1.0);
        }
    }
    textureStore(voxels, id, value);
}
