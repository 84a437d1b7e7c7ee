// A volume as it is stored: the voxels of one mip level that a pixel's ray passes, unfiltered, front to back.
//
// Each voxel counts with its stored opacity, once, however long the ray's way through it.
// Reads one texel for each voxel on the way, at most the sum of the grid's sides; writes a texel.

import lib/camera;
import lib/grid;
import lib/walk;
import role/storage;

struct Knobs {
    level: u32,
}

var<uniform> knobs: Knobs;
var color: texture_storage_2d<rgba32float, write>;

fn stored_voxel(voxel: vec3i, level: i32, direction: vec3f) -> vec4f {
    @if(shown == "emitted" && scene.emissive) {
        return emitted_voxel(voxel, level, direction);
    }
    @elif(shown == "emitted") {
        return vec4f(0.0);
    }
    @else {
        return reflected_voxel(voxel, level, direction);
    }
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let size = textureDimensions(color);
    if any(id.xy >= size) {
        return;
    }
    let level = min(knobs.level, volume_levels() - 1u);
    let side = vec3i((values.grid_size + (1u << level) - 1u) >> vec3u(level));
    let scale = 1.0 / f32(1u << level);
    let ray = pixel_ray(id.xy, size);
    var walk = walk_begin(to_grid(ray.origin) * scale, direction_to_grid(ray.direction), side);
    var seen = vec4f(0.0);
    for (var k = 0; k < side.x + side.y + side.z && walk.inside && seen.a < 0.999; k++) {
        seen += (1.0 - seen.a) * stored_voxel(walk.cube, i32(level), ray.direction);
        walk_on(&walk);
    }
    textureStore(color, id.xy, vec4f(seen.rgb, 1.0));
}
