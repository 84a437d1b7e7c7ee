//! Scenes: mutants of the generated ones, of a document with something of everything, and of what `VOXGI_SCENES` has.

use crate::campaign::{Answer, Target};
use crate::glb::{self, Document};
use crate::{promises, scene_mutants};
use fastrand::Rng;
use std::fs;
use std::path::{Path, PathBuf};
use voxgi::scene::{self, generate};

pub struct Scenes {
    corpus: Vec<Document>,
    /// As many are never dropped.
    seeds: usize,
    last: Option<Document>,
}

impl Scenes {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("seed.glb");
        let mut corpus = vec![glb::rich(); 4];
        for (_, make) in generate::ALL {
            fs::write(&path, make()).unwrap();
            corpus.extend(glb::read(&path));
        }
        assert!(scene::load(&path).is_ok());
        fs::write(&path, glb::binary(&serde_json::to_vec(&corpus[0].json).unwrap(), &corpus[0].bytes))
            .unwrap();
        scene::load(&path).unwrap_or_else(|problems| panic!("the rich document is right: {problems}"));
        let mut files = Vec::new();
        let mut folders: Vec<_> = std::env::var_os("VOXGI_SCENES").map(PathBuf::from).into_iter().collect();
        while let Some(folder) = folders.pop() {
            for path in fs::read_dir(&folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
                if path.is_dir() {
                    folders.push(path);
                } else if path.metadata().is_ok_and(|m| m.len() < 50_000) {
                    files.push(path);
                }
            }
        }
        files.sort_unstable();
        let is_gltf = |path: &&PathBuf| path.extension().is_some_and(|e| e == "gltf" || e == "glb");
        corpus.extend(files.iter().filter(is_gltf).filter_map(|path| glb::read(path)));
        Self { seeds: corpus.len(), corpus, last: None }
    }
}

impl Target for Scenes {
    fn input(&mut self, dice: &mut Rng, folder: &Path) {
        let start = &self.corpus[dice.usize(..self.corpus.len())];
        let document = scene_mutants::mutant(start, &self.corpus[..self.seeds], dice);
        let files = scene_mutants::files(&document, dice);
        fs::write(folder.join(files.name), files.content).unwrap();
        if files.name.ends_with(".gltf") {
            fs::write(folder.join("buffer.bin"), files.buffer).unwrap();
        }
        self.last = Some(document);
    }

    fn feed(&mut self, folder: &Path) -> Answer {
        let names = ["scene.gltf", "scene.glb"].map(|name| folder.join(name));
        let path = names.iter().find(|path| path.is_file()).unwrap();
        match scene::load(path) {
            Err(problems) => promises::problems(&problems),
            Ok(scene) => {
                promises::scene(&scene);
                let lacks: Vec<_> = scene.lacks.iter().map(|lack| &lack.what).collect();
                let some = |n: usize| n.min(3);
                let counts =
                    [scene.lights.len(), scene.cameras.len(), scene.images.len(), scene.instances.len()]
                        .map(some);
                Answer { accepted: true, words: format!("{counts:?} {lacks:?}") }
            }
        }
    }

    fn keep(&mut self) {
        let Some(document) = self.last.take() else { return };
        let size = document.bytes.len() + document.json.to_string().len();
        if size < 200_000 {
            if self.corpus.len() >= self.seeds + 1500 {
                self.corpus.remove(self.seeds);
            }
            self.corpus.push(document);
        }
    }
}
