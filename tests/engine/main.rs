//! What the engine promises of any pipeline, shown on the shipped ones and on those of `tests/library-engine`, which are
//! about no technique.

mod abilities;
mod bench;
mod cli;
mod computing;
mod drawing;
mod faults;
mod graphs;
#[path = "../support/job.rs"]
mod job;
mod looping;
mod moving;
mod omitting;
mod parts;
mod remembering;
mod same_bits;
