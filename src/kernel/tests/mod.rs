//! Tests of the kernel modules. Kernels are files in a temporary library.

mod composing;
mod conditions;
mod finishing;
mod mistakes;
mod reflecting;
mod variants;

use super::{Composed, Reflected, compose, reflect};
use crate::expr::{Names, Value};
use crate::library::Library;
use crate::problem::{Problem, Problems, Result, Source};
use std::collections::BTreeMap;

#[derive(Default)]
struct Known(BTreeMap<String, Value>);

impl Names for Known {
    fn get(&self, name: &str) -> Option<Value> {
        self.0.get(name).cloned()
    }

    fn known(&self) -> Vec<String> {
        self.0.keys().cloned().collect()
    }
}

fn known(values: &[(&str, Value)]) -> Known {
    Known(values.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect())
}

/// A library of the `(name, text)` given, as long as it lives.
struct Files {
    library: Library,
    _folder: tempfile::TempDir,
}

impl Files {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(format!("kernels/{name}.wgsl"));
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        Self { library: Library::new(vec![folder.path().to_owned()]).unwrap(), _folder: folder }
    }

    /// Composes `main` with `roles` (role, module) and `names`.
    fn compose(&self, roles: &[(&str, &str)], names: &dyn Names) -> Result<Composed> {
        let roles = roles.iter().map(|(role, module)| ((*role).to_owned(), (*module).to_owned())).collect();
        let stage = Source::new("pipeline.ron", "kernel: \"main\"");
        compose(&self.library, "main", &stage.at(8..14), &roles, names)
    }
}

/// One file, composed without names.
fn composed(text: &str) -> Composed {
    Files::new(&[("main", text)]).compose(&[], &known(&[])).unwrap()
}

fn reflected(text: &str) -> Reflected {
    reflect(&composed(text), &BTreeMap::new()).unwrap()
}

/// The only problem.
fn only<T>(result: Result<T>) -> Problem {
    let Err(problems) = result else { panic!("no problem") };
    let all: Vec<&Problem> = problems.iter().collect();
    assert_eq!(all.len(), 1, "{problems:#?}");
    all[0].clone()
}

/// Where a problem's label is: file without folders, line, column, and the text it marks.
fn label(problem: &Problem, index: usize) -> (String, usize, usize, String) {
    let place = &problem.labels[index].0;
    let (line, column) = place.line_column();
    let file = place.source.name().rsplit('/').next().unwrap().to_owned();
    (file, line, column, place.text().to_owned())
}

fn at(file: &str, line: usize, column: usize, text: &str) -> (String, usize, usize, String) {
    (file.to_owned(), line, column, text.to_owned())
}

fn codes(problems: &Problems) -> Vec<&'static str> {
    problems.iter().map(|problem| problem.code).collect()
}
