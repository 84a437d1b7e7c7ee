//! Is the pipeline `cones` right? Its pictures against oracles that share no code with it: an integrator
//! without voxels, closed forms. Each oracle is also made wrong on purpose, which must show.

#[path = "technique/cornell.rs"]
mod cornell;
#[path = "technique/environment.rs"]
mod environment;
#[path = "technique/fields.rs"]
mod fields;
#[path = "support/glb.rs"]
mod glb;
#[path = "technique/integrator.rs"]
mod integrator;
#[path = "technique/lights.rs"]
mod lights;
#[path = "technique/program.rs"]
mod program;
#[path = "technique/scenes.rs"]
mod scenes;
#[path = "technique/world.rs"]
mod world;
