// The list of the voxels that moving triangles came into. Its order depends on the threads; what is done with it does
// not.

struct Touched {
    /// How many are listed so far.
    listed: atomic<u32>,
    /// How many are to be cleared: those listed the time before.
    stale: u32,
    voxels: array<u32>,
}
