//! Do all voxelizers fill the same voxels, and are they the right ones? Each method against exact tests of overlap in
//! integers, on random triangles, hard cases and scans, and against properties that need no oracle. Every oracle is
//! also made wrong on purpose, which must show.

mod atlas;
mod choices;
mod compact;
mod corners;
mod crowds;
#[path = "../support/glb.rs"]
mod glb;
mod grids;
mod hard;
mod lattice;
mod lists;
mod meshes;
mod model;
mod oracle;
mod payloads;
mod pieces;
mod properties;
mod random;
mod scans;
mod slices;
mod snapping;
mod solid;
mod sums;
#[path = "../support/scenes.rs"]
mod support;
mod textures;
mod turned;
mod turned_light;
mod turns;
mod voxelizer;
mod wide;
