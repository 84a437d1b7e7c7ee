// How a large triangle is cut for many threads: rows of columns into segments, a thread for each; 64 of them are a chunk,
// for a workgroup.

import lib/columns;

/// Columns of a segment.
const SEGMENT: i32 = 16;
const SEGMENTS_OF_A_CHUNK: u32 = 64u;
/// In place of a triangle's number: nothing is to be done.
const NO_TRIANGLE: u32 = 0xffffffffu;

fn segments_across(placed: Placed) -> u32 {
    return u32((placed.size.x + SEGMENT) / SEGMENT);
}

fn chunks_of(placed: Placed) -> u32 {
    let segments = segments_across(placed) * u32(placed.size.y + 1);
    return (segments + SEGMENTS_OF_A_CHUNK - 1u) / SEGMENTS_OF_A_CHUNK;
}
