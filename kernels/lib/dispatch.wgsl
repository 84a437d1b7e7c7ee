// Thread numbering of dispatches that have more workgroups than one dimension takes.

/// The running number of a thread when the engine may have folded a row of workgroups into y.
/// `size_x` is the workgroup's size; workgroups are one-dimensional.
fn linear_index(global_id: vec3u, workgroups: vec3u, size_x: u32) -> u32 {
    return global_id.y * workgroups.x * size_x + global_id.x;
}
