//! Where what takes long to make is kept from run to run.

use crate::problem::{Problem, Result};
use std::path::PathBuf;

/// The folder that `VOXGI_CACHE` names, or else `voxgi` in the user's cache folder. Error `no-cache` where there is
/// neither.
pub fn folder_of_user() -> Result<PathBuf> {
    let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = variable("VOXGI_CACHE")
        .or_else(|| Some(variable("XDG_CACHE_HOME")?.join("voxgi")))
        .or_else(|| Some(variable("HOME")?.join(".cache/voxgi")));
    Ok(folder.ok_or_else(|| {
        Problem::input("no-cache", "there is no folder to keep anything in")
            .help("set VOXGI_CACHE to a folder")
    })?)
}
