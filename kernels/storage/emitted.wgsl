// Emission of each voxel: premultiplied radiance and opacity 1 where there is a surface.
//
// (A voxel has no sides: emission leaves to the back too.)
// Reads 4 B, 16 B where filled; writes one texel.

import role/voxels;

@if(scene.emissive)
struct SceneFacts {
    max_emission: f32,
}

@if(scene.emissive)
var<uniform> scene: SceneFacts;

var voxels: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if any(id >= textureDimensions(voxels)) {
        return;
    }
    var value = vec4f(0.0);
    if is_filled(id) {
        value.a = 1.0;
        @if(scene.emissive) {
            value = vec4f(min(emission_of(id) * scene.max_emission, vec3f(65504.0)), 1.0);
        }
    }
    textureStore(voxels, id, value);
}
