//! Kernels that are wrong on purpose.

use std::path::Path;
use tempfile::TempDir;
use voxgi::library::Library;

/// The shipped library with one kernel changed.
pub struct Flawed {
    _folder: TempDir,
    pub library: Library,
}

/// `from`, which occurs once in the kernel, becomes `to`.
pub fn flawed(kernel: &str, from: &str, to: &str) -> Flawed {
    let file = format!("kernels/{kernel}.wgsl");
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join(&file);
    let text = std::fs::read_to_string(shipped).expect("a shipped kernel");
    assert_eq!(text.matches(from).count(), 1, "`{from}` in {kernel}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(file);
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder for the kernel");
    std::fs::write(path, text.replace(from, to)).expect("the kernel can be written");
    let library = Library::new(vec![folder.path().to_owned()]).expect("a library");
    Flawed { _folder: folder, library }
}
