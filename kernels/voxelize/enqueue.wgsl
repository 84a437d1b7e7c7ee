// Voxelizes small triangles, with a thread for each, and cuts large ones into chunks for workgroups (lib/chunks): what
// R 4.1.1 says that Schwarz and Pantaleoni do by sorting, with a queue.
//
// A triangle whose chunks find no room is voxelized by the thread itself; what room there was stays empty.
// Reads per triangle 3 corners and what the payload wants; writes per fragment what the payload does, and per chunk 2
// words.

import lib/chunks;
import lib/cutoff;
import lib/dispatch;
import lib/geometry;
import lib/groups;

/// A triangle and the number of its chunk.
var<storage, read_write> queue: array<vec2u>;
var<storage, read_write> queue_count: array<atomic<u32>, 1>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) workgroups: vec3u) {
    let triangle = linear_index(id, workgroups, 64u);
    if triangle >= geometry.triangles {
        return;
    }
    let placed = placed_of(geometry.first + triangle);
    if !placed.meets {
        return;
    }
    // A full queue is left alone: however many triangles there are, the count never begins anew.
    if is_large(placed) && atomicLoad(&queue_count[0]) < arrayLength(&queue) {
        let chunks = chunks_of(placed_along(placed, ROWS));
        let place = atomicAdd(&queue_count[0], chunks);
        let room = arrayLength(&queue) - min(place, arrayLength(&queue));
        let chunk_of = select(NO_TRIANGLE, placed.triangle, chunks <= room);
        for (var i = 0u; i < min(chunks, room); i++) {
            queue[place + i] = vec2u(chunk_of, i);
            grow_groups(place + i);
        }
        if chunks <= room {
            return;
        }
    }
    fill_all(placed, knobs.separability);
}
