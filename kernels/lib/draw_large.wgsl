// A list of triangles to be drawn, and the draw that goes through it: 3 vertices for each. Its order depends on the
// threads. Writes a word and adds to one.

/// Numbers of triangles; there is room for all.
var<storage, read_write> large: array<u32>;
/// Vertices, instances, and the first of each.
var<storage, read_write> large_draw: array<atomic<u32>>;

fn draw_large(triangle: u32) {
    let vertex = atomicAdd(&large_draw[0], 3u);
    large[vertex / 3u] = triangle;
    if vertex == 0u {
        atomicStore(&large_draw[1], 1u);
    }
}
