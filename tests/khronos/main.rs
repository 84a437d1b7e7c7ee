//! The Khronos test models, against the answers that they have built in: what must be seen where, which two things must
//! look alike. Each check is also made on a file that is wrong on purpose, where it must fail.

mod lists;
mod lookups;
mod models;
mod normals;
mod pictures;
mod shot;
#[path = "../support/scenes.rs"]
mod support;
