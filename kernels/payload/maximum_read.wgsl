// Module behind `role/voxels` of the payload `maximum`. A voxel's position is its centre: none is kept.
//
// Reads a word for an empty voxel, 3 for a filled one.

import lib/grid;
import lib/is_filled;
import lib/packed_words;
import lib/surfel;

var<storage, read> packed: array<u32>;
/// The same of what moves.
@if(scene.moving)
var<storage, read> moving_packed: array<u32>;
@if(scene.emissive)
var<storage, read> packed_emission: array<u32>;
@if(scene.emissive && scene.moving)
var<storage, read> moving_packed_emission: array<u32>;

fn brighter_of(one: u32, other: u32) -> vec3f {
    return unpacked(max(one, other));
}

/// Of all fragments, still and moving.
fn both(at: u32) -> vec3f {
    @if(scene.moving) {
        return brighter_of(packed[at], moving_packed[at]);
    } @else {
        return unpacked(packed[at]);
    }
}

/// 1 where a fragment lies: they are not counted.
fn fragment_count(voxel: vec3u) -> u32 {
    return u32(is_filled(voxel));
}

fn surfel_of(voxel: vec3u) -> Surfel {
    if !is_filled(voxel) {
        return Surfel(false, vec3f(0.0), vec3f(0.0), vec3f(0.0));
    }
    let at = voxel_number(voxel) * PACKED_WORDS;
    let normal = normal_of_unit(both(at + PACKED_NORMAL));
    return Surfel(true, both(at + PACKED_ALBEDO), normal, from_grid(vec3f(voxel) + 0.5));
}

/// Radiance, in units of the scene's greatest emission.
@if(scene.emissive)
fn emission_of(voxel: vec3u) -> vec3f {
    if !is_filled(voxel) {
        return vec3f(0.0);
    }
    let number = voxel_number(voxel);
    @if(scene.moving) {
        return brighter_of(packed_emission[number], moving_packed_emission[number]);
    } @else {
        return unpacked(packed_emission[number]);
    }
}
