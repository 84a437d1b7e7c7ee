//! `voxgi tune` and `--tuned` as a user's program sees them, with pipelines whose best values are known.

mod bench;
mod finding;
mod refusing;
mod using;
