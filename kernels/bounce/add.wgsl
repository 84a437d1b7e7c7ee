// Radiance of the filled voxels = first scattering + what a bounce adds; opacity is that of the first.
// A thread for each voxel of the list; reads a word and 2 texels, writes 1.

import lib/dispatch;
import lib/listed;

var first: texture_3d<f32>;
var bounced: texture_3d<f32>;
var lit: texture_storage_3d<rgba16float, write>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let place = linear_index(id, workgroups, 64u);
    if place >= listed_voxels() {
        return;
    }
    let voxel = listed_voxel(place);
    let start = textureLoad(first, voxel, 0);
    // Radiances that half floats don't hold are cut.
    let radiance = min(start.rgb + textureLoad(bounced, voxel, 0).rgb, vec3f(65504.0));
    textureStore(lit, voxel, vec4f(radiance, start.a));
}
