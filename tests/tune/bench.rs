//! A place of its own for each test: what others keep is not seen.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

pub struct Bench {
    folder: TempDir,
}

pub fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

impl Bench {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn command(&self, arguments: &str) -> Command {
        let scene = |name: &str| root(name).display().to_string();
        let words = arguments.split_whitespace().map(|word| match word {
            "POINT" => scene("scenes/cornell-point.glb"),
            "BOX" => scene("scenes/cornell-box.glb"),
            word => word.to_owned(),
        });
        let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
        command.args(words).args(["--size", "16x16", "--json", "--library"]);
        command.arg(root("tests/tune/library"));
        command.env("VOXGI_CACHE", self.path("cache")).current_dir(self.folder.path());
        command
    }

    pub fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().expect("the program")
    }

    /// What a command prints, and tells.
    pub fn ok(&self, arguments: &str) -> (Value, String) {
        let output = self.run(arguments);
        let told = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(0), "{arguments}: {told}");
        (serde_json::from_slice(&output.stdout).expect("one JSON object"), told)
    }

    /// The first problem of a command that refuses its input.
    pub fn refused(&self, arguments: &str) -> Value {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        let value: Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
        value["problems"][0].clone()
    }

    /// The files that are kept.
    pub fn kept(&self) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(self.path("cache/tuned")).into_iter().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.sort();
        paths
    }
}
