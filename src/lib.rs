//! voxgi: a workbench for voxel-based global illumination.
//!
//! A pipeline file goes one way, one type for each step: [`document`] (as written) → [`plan`] (names chosen) →
//! [`graph`] (kernels reflected, checked) → [`schedule`] (order, memory) → [`frame`] (GPU objects) → [`record`] (times,
//! pictures). Everything up to the schedule is pure. [`session`] goes the whole way.

mod cache;
pub mod cli;
pub mod compare;
pub mod comparison;
pub mod converge;
pub mod device;
pub mod document;
pub mod expr;
pub mod frame;
pub mod graph;
pub mod kernel;
pub mod library;
pub mod measure;
pub mod picture;
pub mod plan;
pub mod play;
pub mod problem;
pub mod profile;
pub mod record;
pub mod reference;
pub mod report;
pub mod scene;
pub mod schedule;
pub mod session;
pub mod tune;
pub mod tuned;
mod zone;
