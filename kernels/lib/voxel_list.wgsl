// A list of filled voxels (or of words of voxels), each once, that grows while triangles are voxelized (R 4.1.4). Its
// order depends on the threads; what is done with it must not.
//
// Beside it goes a buffer with the workgroups that go through the list, LISTED_TOGETHER of it each, along x, y, z: what
// an indirect dispatch takes. It grows with the list, so that no stage has to close the list. A full list takes no more:
// it has room for all there can be.

/// Threads of a workgroup that goes through a list; 65535 workgroups reach 16.7 million.
const LISTED_TOGETHER: u32 = 256u;

struct VoxelList {
    count: atomic<u32>,
    voxels: array<u32>,
}
