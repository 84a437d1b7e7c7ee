//! voxgi: a workbench for voxel-based global illumination.
//!
//! A pipeline file goes one way, one type for each step: [`document`] (as written) → [`plan`] (names chosen) → graph
//! (kernels reflected, checked) → [`schedule`] (order, memory) → frame (GPU objects) → record (times, pictures).

pub mod document;
pub mod expr;
pub mod kernel;
pub mod library;
pub mod picture;
pub mod plan;
pub mod problem;
pub mod scene;
pub mod schedule;
