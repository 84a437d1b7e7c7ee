//! Pipelines and settings: shipped files and those of tests, with one of them mutated.

use crate::campaign::{Answer, Target};
use crate::promises;
use crate::ron_text::Corpus;
use fastrand::Rng;
use std::fs;
use std::path::{Path, PathBuf};
use voxgi::library::Library;
use voxgi::scene::{self, Scene, generate};
use voxgi::session::{Request, prepare};

fn own(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The names, relative to `root`, and texts of all RON files below it.
fn files(root: &Path) -> Vec<(PathBuf, String)> {
    let (mut folders, mut list) = (vec![root.to_path_buf()], Vec::new());
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "ron") {
                let text = fs::read_to_string(&path).unwrap();
                list.push((path.strip_prefix(root).unwrap().to_path_buf(), text));
            }
        }
    }
    list.sort_unstable();
    assert!(!list.is_empty(), "{} has no files to start from", root.display());
    list
}

/// A library in which one file is mutated, and a pipeline that reaches it, from text to schedule.
pub struct Pipelines {
    corpus: Corpus,
    /// For each text of the corpus its name in a library, and the pipeline to prepare.
    names: Vec<(PathBuf, String)>,
    last: (PathBuf, String, String),
    scenes: [Option<Scene>; 2],
}

impl Pipelines {
    pub fn new() -> Self {
        let (mut texts, mut names) = (Vec::new(), Vec::new());
        for library in ["", "tests/library-engine"] {
            for (name, text) in files(&own(library).join("pipelines")) {
                let is_part = name.starts_with("parts");
                let pipeline = match (is_part, library) {
                    (false, _) => name.with_extension("").to_string_lossy().into_owned(),
                    (true, "") => "cones".to_owned(),
                    (true, _) => "parts".to_owned(),
                };
                texts.push(text);
                names.push((Path::new("pipelines").join(name), pipeline));
            }
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("box.glb");
        fs::write(&path, generate::ALL[1].1()).unwrap();
        let scene = scene::load(&path).unwrap();
        Self { corpus: Corpus::new(texts), names, last: Default::default(), scenes: [None, Some(scene)] }
    }
}

impl Target for Pipelines {
    fn input(&mut self, dice: &mut Rng, folder: &Path) {
        let chosen = dice.usize(..self.names.len());
        let (name, pipeline) = self.names[chosen].clone();
        let text = self.corpus.mutant(&self.corpus.texts[chosen], dice);
        let path = folder.join(&name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, &text).unwrap();
        let camera = dice.usize(..2).to_string();
        fs::write(folder.join("request"), format!("{pipeline}\n{camera}")).unwrap();
        self.last = (name, pipeline, text);
    }

    fn feed(&mut self, folder: &Path) -> Answer {
        let request = fs::read_to_string(folder.join("request")).unwrap();
        let (pipeline, scene) = request.split_once('\n').unwrap();
        let scene = self.scenes[scene.parse::<usize>().unwrap()].as_ref();
        let library = Library::new(vec![folder.to_path_buf(), own("tests/library-engine")]).unwrap();
        let request = Request { pipeline: pipeline.to_owned(), ..Request::default() };
        match prepare(&request, &library, scene) {
            Err(problems) => promises::problems(&problems),
            Ok(prepared) => {
                assert_eq!(prepared.schedule.fates.len(), prepared.graph.stages.len());
                let limits = wgpu_types::Limits::default();
                let over = voxgi::graph::check::limits(&prepared.graph, &limits, "WebGPU");
                let warnings: Vec<_> = prepared.warnings.iter().map(|w| w.code).collect();
                let counts = (prepared.graph.stages.len(), prepared.graph.plan.resources.len());
                Answer { accepted: true, words: format!("{pipeline} {counts:?} {warnings:?} {}", over.len()) }
            }
        }
    }

    fn keep(&mut self) {
        let (name, pipeline, text) = self.last.clone();
        // The first texts are the files themselves; among the others the newest stay.
        if self.names.len() >= 2000 {
            let oldest = self.names.len() / 2;
            self.names.remove(oldest);
            self.corpus.texts.remove(oldest);
        }
        self.names.push((name, pipeline));
        self.corpus.texts.push(text);
    }
}

/// A setting beside the model it names.
pub struct Settings {
    corpus: Corpus,
    last: String,
    model: Vec<u8>,
}

impl Settings {
    pub fn new() -> Self {
        let shipped = files(&own("scenes")).into_iter().map(|(_, text)| text);
        // Whatever model they name, the one that is there has the box's name.
        let texts = shipped.map(|text| {
            let end = text.find(".glb\"").expect("a setting names a .glb file");
            let start = text[..end].rfind('"').unwrap();
            format!("{}\"box{}", &text[..start], &text[end..])
        });
        Self { corpus: Corpus::new(texts.collect()), last: String::new(), model: generate::ALL[0].1() }
    }
}

impl Target for Settings {
    fn input(&mut self, dice: &mut Rng, folder: &Path) {
        let start = &self.corpus.texts[dice.usize(..self.corpus.texts.len())];
        self.last = self.corpus.mutant(start, dice);
        fs::write(folder.join("box.glb"), &self.model).unwrap();
        fs::write(folder.join("scene.ron"), &self.last).unwrap();
    }

    fn feed(&mut self, folder: &Path) -> Answer {
        match scene::load(&folder.join("scene.ron")) {
            Err(problems) => promises::problems(&problems),
            Ok(scene) => {
                promises::scene(&scene);
                let counts = (scene.lights.len(), scene.cameras.len(), &scene.lacks);
                Answer { accepted: true, words: format!("{counts:?}") }
            }
        }
    }

    fn keep(&mut self) {
        if self.corpus.texts.len() < 2000 {
            self.corpus.texts.push(self.last.clone());
        }
    }
}
