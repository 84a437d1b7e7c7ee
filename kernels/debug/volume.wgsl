// A volume as it is stored: the voxels of one mip level that a pixel's ray passes, unfiltered, front to back.
//
// Each voxel counts with its stored opacity, once, however long the ray's way through it. Walks from face to face
// (Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing").
// Reads one texel for each voxel on the way, at most 3 · resolution; writes a texel.

import lib/camera;
import lib/grid;
import role/storage;

struct Knobs {
    resolution: u32,
    level: u32,
}

var<uniform> knobs: Knobs;
var color: texture_storage_2d<rgba32float, write>;

/// Where a ray enters (x) and leaves (y) the cube [0, side]³.
fn cube_span(origin: vec3f, inverse: vec3f, side: f32) -> vec2f {
    let a = -origin * inverse;
    let b = (vec3f(side) - origin) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    return vec2f(max(max(near.x, near.y), max(near.z, 0.0)), min(far.x, min(far.y, far.z)));
}

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
    let level = min(knobs.level, firstLeadingBit(knobs.resolution));
    let side = i32(knobs.resolution >> level);
    let scale = 1.0 / f32(1u << level);
    let ray = pixel_ray(id.xy, size);
    // No component is zero, so that no division is by zero.
    let direction = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9));
    let inverse = 1.0 / direction;
    let origin = to_grid(ray.origin) * scale;
    let span = cube_span(origin, inverse, f32(side));
    var seen = vec4f(0.0);
    if span.x < span.y {
        let forward = vec3i(sign(direction));
        var voxel = clamp(vec3i(floor(origin + span.x * direction)), vec3i(0), vec3i(side - 1));
        let toward = vec3f(max(forward, vec3i(0)));
        for (var k = 0; k < 3 * side && seen.a < 0.999; k++) {
            seen += (1.0 - seen.a) * stored_voxel(voxel, i32(level), direction);
            let crossing = (vec3f(voxel) + toward - origin) * inverse;
            let nearest = min(crossing.x, min(crossing.y, crossing.z));
            if crossing.x == nearest {
                voxel.x += forward.x;
            } else if crossing.y == nearest {
                voxel.y += forward.y;
            } else {
                voxel.z += forward.z;
            }
            if any(voxel < vec3i(0)) || any(voxel >= vec3i(side)) {
                break;
            }
        }
    }
    textureStore(color, id.xy, vec4f(seen.rgb, 1.0));
}
