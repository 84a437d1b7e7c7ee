//! Is the pipeline `cones` right? Its pictures and voxels against oracles that share no code with it: an integrator
//! without voxels, closed forms, exact tests of overlap. Each oracle is also made wrong on purpose, which must show.

#[path = "technique/atlas.rs"]
mod atlas;
#[path = "technique/cornell.rs"]
mod cornell;
#[path = "technique/environment.rs"]
mod environment;
#[path = "technique/fields.rs"]
mod fields;
#[path = "technique/integrator.rs"]
mod integrator;
#[path = "technique/lights.rs"]
mod lights;
#[path = "technique/program.rs"]
mod program;
#[path = "technique/scenes.rs"]
mod scenes;
#[path = "support/scenes.rs"]
mod support;
#[path = "technique/voxels.rs"]
mod voxels;
#[path = "technique/world.rs"]
mod world;
