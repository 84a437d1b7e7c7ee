// Reads what payloads keep in packed words (lib/packed_words). The module that imports this says in
// `combined(one, other)` what a word of still triangles and one of moving ones are together; positions are not kept, so
// that a surface lies in its voxel's centre.
//
// Reads a word for an empty voxel, 3 for a filled one; where something moves, twice as many.

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

/// Word `at` of all fragments, still and moving.
fn attributes_at(at: u32) -> vec3f {
    @if(scene.moving) {
        return combined(packed[at], moving_packed[at]);
    } @else {
        return unpacked(packed[at]);
    }
}

fn surfel_of(voxel: vec3u) -> Surfel {
    if !is_filled(voxel) {
        return no_surfel();
    }
    let at = voxel_number(voxel) * PACKED_WORDS;
    let normal = normal_of_unit(attributes_at(at + PACKED_NORMAL));
    return Surfel(true, attributes_at(at + PACKED_ALBEDO), normal, from_grid(vec3f(voxel) + 0.5));
}

/// Radiance, in units of the scene's greatest emission.
@if(scene.emissive)
fn emission_of(voxel: vec3u) -> vec3f {
    if !is_filled(voxel) {
        return vec3f(0.0);
    }
    let number = voxel_number(voxel);
    @if(scene.moving) {
        return combined(packed_emission[number], moving_packed_emission[number]);
    } @else {
        return unpacked(packed_emission[number]);
    }
}
