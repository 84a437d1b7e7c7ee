// Emission of each filled voxel: premultiplied radiance and opacity 1. Elsewhere there is nothing yet.
//
// (A voxel has no sides: emission leaves to the back too.)
// A thread for each voxel of the list. Reads 12 B of it; writes one texel.

import lib/dispatch;
import lib/listed;
@if(scene.emissive) import role/voxels;

@if(scene.emissive)
struct SceneFacts {
    max_emission: f32,
}

@if(scene.emissive)
var<uniform> scene: SceneFacts;

var voxels: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let place = linear_index(id, workgroups, 64u);
    if place >= listed_voxels() {
        return;
    }
    let voxel = listed_voxel(place);
    var value = vec4f(0.0, 0.0, 0.0, 1.0);
    @if(scene.emissive) {
        value = vec4f(min(emission_of(voxel) * scene.max_emission, vec3f(65504.0)), 1.0);
    }
    textureStore(voxels, voxel, value);
}
