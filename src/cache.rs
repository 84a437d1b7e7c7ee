//! Where what takes long to make is kept from run to run.

use std::path::PathBuf;

/// The folder for things of one kind: below the folder that `VOXGI_CACHE` names, or else `voxgi` in the user's cache
/// folder. `None` where there is neither.
pub fn folder(kind: &str) -> Option<PathBuf> {
    let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = variable("VOXGI_CACHE")
        .or_else(|| Some(variable("XDG_CACHE_HOME")?.join("voxgi")))
        .or_else(|| Some(variable("HOME")?.join(".cache/voxgi")));
    Some(folder?.join(kind))
}
