//! Follows the README's "Write your own stage" word by word, with the binary, in a folder outside of the repository.

use std::path::Path;
use std::process::{Command, Output};

const README: &str = include_str!("../README.md");

/// The code blocks of the section, in order: language and text.
fn blocks() -> Vec<(String, String)> {
    let section = README.split("### Write your own stage").nth(1).and_then(|rest| rest.split("\n## ").next());
    let mut blocks = Vec::new();
    for block in section.unwrap_or_default().split("```").skip(1).step_by(2) {
        let (language, text) = block.split_once('\n').unwrap_or_default();
        blocks.push((language.to_owned(), text.to_owned()));
    }
    blocks
}

/// The file names that the prose gives, in order: `mine/…` between backquotes.
fn files() -> Vec<&'static str> {
    let section = README.split("### Write your own stage").nth(1).unwrap_or_default();
    section
        .split('`')
        .filter(|piece| piece.starts_with("mine/") && !piece.contains(char::is_whitespace))
        .collect()
}

/// Runs a line of the README in `folder`; the scene's path is that of the repository.
fn run(line: &str, folder: &Path) -> Output {
    let mut words = line.split_whitespace().map(|word| match word.strip_prefix("scenes/") {
        Some(scene) => format!("{}/scenes/{scene}", env!("CARGO_MANIFEST_DIR")),
        None => word.to_owned(),
    });
    assert_eq!(words.next().as_deref(), Some("voxgi"), "{line}");
    Command::new(env!("CARGO_BIN_EXE_voxgi")).args(words).current_dir(folder).output().unwrap()
}

fn write_files(folder: &Path) {
    let (files, blocks) = (files(), blocks());
    assert_eq!(files, ["mine/kernels/bands.wgsl", "mine/pipelines/bands.ron"]);
    for (file, (_, text)) in files.iter().zip(&blocks) {
        let path = folder.join(file);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
}

#[test]
fn write_your_own_stage_works_as_written() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let blocks = blocks();
    let languages: Vec<&str> = blocks.iter().map(|(language, _)| language.as_str()).collect();
    assert_eq!(languages, ["wgsl", "ron", "sh"]);
    for line in blocks[2].1.lines() {
        let output = run(line, folder.path());
        assert!(output.status.success(), "{line}\n{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stderr.is_empty(), "{line}\n{}", String::from_utf8_lossy(&output.stderr));
    }
    let picture = voxgi::picture::read_png(&folder.path().join("bands.png")).unwrap();
    assert_eq!((picture.width(), picture.height()), (256, 256));
    // The red wall, and bands in it: its reds differ, its greens stay below them.
    let row: Vec<&[u8]> = (8..50).map(|x| &picture.data()[(128 * 256 + x) * 4..][..4]).collect();
    assert!(row.iter().all(|texel| texel[0] > texel[1]), "{row:?}");
    let (least, most) = (row.iter().map(|t| t[0]).min(), row.iter().map(|t| t[0]).max());
    assert!(most.unwrap() > least.unwrap() + 30, "{least:?} to {most:?}");
}

/// The control: with a slip in the kernel, the same commands fail and point at the line.
#[test]
fn a_slip_in_the_kernel_is_pointed_at() {
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path());
    let kernel = folder.path().join("mine/kernels/bands.wgsl");
    let text = std::fs::read_to_string(&kernel).unwrap().replace("knobs.width", "knobs.wide");
    std::fs::write(&kernel, &text).unwrap();
    let line = text.lines().position(|line| line.contains("knobs.wide")).unwrap() + 1;
    let output = run("voxgi check bands --library mine", folder.path());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    assert!(message.contains(&format!("mine/kernels/bands.wgsl:{line}:")), "{message}");
}
