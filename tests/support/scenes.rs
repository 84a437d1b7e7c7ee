//! Scenes that are kept elsewhere.

use std::path::PathBuf;

/// The folder of `VOXGI_SCENES`; without it the test is skipped, or fails if `VOXGI_REQUIRE_SCENES` is 1.
pub fn scenes() -> Option<PathBuf> {
    let folder = std::env::var_os("VOXGI_SCENES").map(PathBuf::from).filter(|folder| folder.is_dir());
    if folder.is_none() {
        let required = std::env::var("VOXGI_REQUIRE_SCENES").is_ok_and(|value| value == "1");
        assert!(!required, "VOXGI_SCENES names no folder, and VOXGI_REQUIRE_SCENES=1 wants one");
        eprintln!("skipped: VOXGI_SCENES names no folder of scenes");
    }
    folder
}
