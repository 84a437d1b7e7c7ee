//! Files that are wrong, odd or hostile, each loaded by `voxgi scenes FILE` in a process of its own: it must end in time
//! and in 1 GiB, with 0, or with 2 and problems that name the file and the place in it.
//!
//! [`folder`]: the files of `VOXGI_SCENES/bad`, against what the format's own validator says of them. [`hostile`]: files
//! made here.
#![cfg(target_os = "linux")]

mod folder;
mod hostile;
mod process;
#[path = "../support/scenes.rs"]
mod support;
