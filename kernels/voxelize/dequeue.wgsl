// Voxelizes the chunks of a queue, each by a workgroup: a thread for each segment of a row (lib/chunks).
//
// Reads per thread 2 words, 3 corners and what the payload wants; writes per fragment what the payload does.

import lib/chunks;

struct Knobs {
    separability: u32,
}

var<uniform> knobs: Knobs;
/// A triangle and the number of its chunk.
var<storage, read> queue: array<vec2u>;
var<storage, read> queue_count: array<u32, 1>;

@compute @workgroup_size(SEGMENTS_OF_A_CHUNK)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) workgroups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let place = group.y * workgroups.x + group.x;
    if place >= min(queue_count[0], arrayLength(&queue)) {
        return;
    }
    if queue[place].x == NO_TRIANGLE {
        return;
    }
    let placed = placed_along(placed_of(queue[place].x), ROWS);
    let segment = queue[place].y * SEGMENTS_OF_A_CHUNK + local;
    let across = segments_across(placed);
    let low = vec2i(vec2u(segment % across * u32(SEGMENT), segment / across));
    if low.y <= placed.size.y {
        fill_columns(placed, knobs.separability, low, vec2i(min(low.x + SEGMENT - 1, placed.size.x), low.y));
    }
}
