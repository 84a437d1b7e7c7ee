// The filled voxel that a pixel's ray meets first, shaded by the side on which it is met; black where there is none.
//
// Reads one voxel for each on the way, at most the sum of the grid's sides; writes a texel.

import lib/camera;
import lib/grid;
import lib/walk;
import role/voxels;

var color: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(color);
    if any(id.xy >= size) {
        return;
    }
    let ray = pixel_ray(id.xy, size);
    var walk = walk_begin(to_grid(ray.origin), direction_to_grid(ray.direction), vec3i(values.grid_size));
    let most = values.grid_size.x + values.grid_size.y + values.grid_size.z;
    var seen = 0.0;
    for (var k = 0u; k < most && walk.inside; k++) {
        if is_filled(vec3u(walk.cube)) {
            seen = vec3f(0.5, 0.9, 0.65)[walk.axis];
            break;
        }
        walk_on(&walk);
    }
    textureStore(color, id.xy, vec4f(vec3f(seen), 1.0));
}
