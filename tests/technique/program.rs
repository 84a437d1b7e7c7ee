//! The program, run as a user runs it, and its pictures.

use glam::DVec3;
use std::path::{Path, PathBuf};
use std::process::Command;
use voxgi::picture::{Picture, read_exr};

/// Pixels along each side of the pictures.
pub const SIZE: u32 = 64;

/// A file of the repository.
pub fn shipped(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Renders one frame, and reads the named outputs. `options`: more arguments, separated by spaces.
pub fn render<const N: usize>(
    scene: &Path,
    pipeline: &str,
    options: &str,
    outputs: [&str; N],
) -> [Picture; N] {
    let folder = tempfile::tempdir().expect("a folder for the pictures");
    let file = |output: &str| folder.path().join(format!("{output}.exr"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
    command.env("VOXGI_CACHE", env!("CARGO_TARGET_TMPDIR"));
    command.arg("render").arg(scene).args(["-p", pipeline, "--size", &format!("{SIZE}x{SIZE}")]);
    command.arg("--library").arg(shipped("tests/library-technique")).args(options.split_whitespace());
    for output in outputs {
        command.arg("--output").arg(format!("{output}={}", file(output).display()));
    }
    let run = command.output().expect("the program starts");
    assert!(run.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&run.stderr));
    outputs.map(|output| {
        let mut layers = read_exr(&file(output)).expect("the picture can be read");
        layers.pop().expect("a picture has a layer").1
    })
}

/// The pixel's colour.
pub fn color(picture: &Picture, [x, y]: [u32; 2]) -> DVec3 {
    let texel = picture.texel(x, y).expect("the pixel lies in the picture");
    DVec3::new(texel[0].into(), texel[1].into(), texel[2].into())
}

/// All pixels of a picture.
pub fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE * SIZE).map(|i| [i % SIZE, i / SIZE])
}
