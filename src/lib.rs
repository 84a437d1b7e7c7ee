//! voxgi: a workbench for voxel-based global illumination.

pub mod problem;
