//! What `voxgi profile` says, against what it should say: statistics, bytes, copy speed, clocks, traces, camera paths.

mod cli;
mod clocks;
mod moving;
mod paths;
mod statistics;
mod traces;
mod traffic;
mod world;
