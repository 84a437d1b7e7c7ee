//! Kernels that are wrong on purpose.

use tempfile::TempDir;
use voxgi::library::{Library, Shelf};

/// The shipped library with one kernel changed.
pub struct Flawed {
    _folder: TempDir,
    pub library: Library,
}

/// `from`, which occurs once in the kernel, becomes `to`.
pub fn flawed(kernel: &str, from: &str, to: &str) -> Flawed {
    let shipped = Library::default().find(Shelf::Kernels, kernel).expect("a shipped kernel");
    let text = shipped.text();
    assert_eq!(text.matches(from).count(), 1, "`{from}` in {kernel}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(format!("kernels/{kernel}.wgsl"));
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder for the kernel");
    std::fs::write(path, text.replace(from, to)).expect("the kernel can be written");
    let library = Library::new(vec![folder.path().to_owned()]).expect("a library");
    Flawed { _folder: folder, library }
}
