//! Where pipelines, parts and kernels come from: folders on disk first, in the order given, then the library that
//! is embedded in the binary. One code path for both.
//!
//! A name is made of pieces of `a-z A-Z 0-9 _ -`, joined by `/`: `raster/surfaces`. Nothing else is looked up, so
//! no name leads out of its folder. (A symbolic link inside a library folder is its owner's business.)

use crate::problem::{Problem, Result, Source};
use include_dir::{Dir, include_dir};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

static KERNELS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/kernels");
static PIPELINES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/pipelines");

/// The sorts of files a library holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shelf {
    Kernels,
    Pipelines,
    Parts,
}

impl Shelf {
    fn folder(self) -> &'static str {
        match self {
            Shelf::Kernels => "kernels",
            Shelf::Pipelines => "pipelines",
            Shelf::Parts => "pipelines/parts",
        }
    }

    fn extension(self) -> &'static str {
        match self {
            Shelf::Kernels => "wgsl",
            Shelf::Pipelines | Shelf::Parts => "ron",
        }
    }

    /// A shelf's files embedded in the binary: name and text.
    fn embedded(self, name: &str) -> Option<&'static str> {
        let file = match self {
            Shelf::Kernels => KERNELS.get_file(format!("{name}.wgsl")),
            Shelf::Pipelines => PIPELINES.get_file(format!("{name}.ron")),
            Shelf::Parts => PIPELINES.get_file(format!("parts/{name}.ron")),
        };
        file.and_then(|f| f.contents_utf8())
    }

    fn embedded_folder(self) -> Option<&'static Dir<'static>> {
        match self {
            Shelf::Kernels => Some(&KERNELS),
            Shelf::Pipelines => Some(&PIPELINES),
            Shelf::Parts => PIPELINES.get_dir("parts"),
        }
    }
}

/// Folders that are searched, before what is embedded.
#[derive(Clone, Debug, Default)]
pub struct Library {
    folders: Vec<PathBuf>,
}

impl Library {
    /// A library that looks in `folders` first. A folder that does not exist is an error of the user's.
    pub fn new(folders: Vec<PathBuf>) -> Result<Self> {
        for folder in &folders {
            if !folder.is_dir() {
                return Err(Problem::input("library", format!("there is no folder `{}`", folder.display()))
                    .help("`--library` takes a folder with `kernels/` and `pipelines/` in it")
                    .into());
            }
        }
        Ok(Self { folders })
    }

    /// The text of `name`, or what is wrong with the name; the caller adds where the name was said.
    pub fn find(&self, shelf: Shelf, name: &str) -> Result<Source, Problem> {
        let what = match shelf {
            Shelf::Kernels => "kernel",
            Shelf::Pipelines => "pipeline",
            Shelf::Parts => "part",
        };
        if !is_name(name) {
            return Err(Problem::input("bad-name", format!("`{name}` can't be the name of a {what}"))
                .help("names are made of letters, digits, `_` and `-`, with `/` between folders"));
        }
        let file = format!("{}/{name}.{}", shelf.folder(), shelf.extension());
        for folder in &self.folders {
            let path = folder.join(&file);
            if path.is_file() {
                return read(&path);
            }
        }
        match shelf.embedded(name) {
            Some(text) => Ok(Source::new(file, text)),
            None => {
                let code = match shelf {
                    Shelf::Kernels => "unknown-kernel",
                    Shelf::Pipelines => "unknown-pipeline",
                    Shelf::Parts => "unknown-part",
                };
                let known = self.list(shelf);
                Err(Problem::input(code, format!("there is no {what} `{name}`"))
                    .suggest(name, known.iter().map(String::as_str)))
            }
        }
    }

    /// All names on a shelf, sorted.
    pub fn list(&self, shelf: Shelf) -> Vec<String> {
        let mut names = BTreeSet::new();
        let mut embedded: Vec<&Dir<'_>> = shelf.embedded_folder().into_iter().collect();
        let prefix = if shelf == Shelf::Parts { "parts/" } else { "" };
        while let Some(folder) = embedded.pop() {
            embedded.extend(folder.dirs());
            names.extend(
                folder.files().filter_map(|f| shelf.name_of(f.path().to_str()?.strip_prefix(prefix)?)),
            );
        }
        for root in &self.folders {
            let root = root.join(shelf.folder());
            let mut folders = vec![root.clone()];
            while let Some(folder) = folders.pop() {
                for path in std::fs::read_dir(&folder).into_iter().flatten().flatten().map(|e| e.path()) {
                    if path.is_dir() {
                        folders.push(path);
                    } else if let Ok(relative) = path.strip_prefix(&root) {
                        names.extend(relative.to_str().and_then(|r| shelf.name_of(r)));
                    }
                }
            }
        }
        names.into_iter().collect()
    }

    /// A pipeline by its name, or by the path of a `.ron` file.
    pub fn pipeline(&self, name_or_path: &str) -> Result<Source, Problem> {
        if name_or_path.ends_with(".ron") {
            return read(Path::new(name_or_path));
        }
        self.find(Shelf::Pipelines, name_or_path)
    }
}

impl Shelf {
    fn name_of(self, relative: &str) -> Option<String> {
        let name = relative.strip_suffix(self.extension())?.strip_suffix('.')?.replace('\\', "/");
        (is_name(&name) && !(self == Shelf::Pipelines && name.starts_with("parts/"))).then_some(name)
    }
}

/// Whether `name` is one that a library looks up at all.
pub fn is_name(name: &str) -> bool {
    name.split('/').all(|piece| {
        !piece.is_empty() && piece.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
    })
}

fn read(path: &Path) -> Result<Source, Problem> {
    let name = path.display().to_string();
    match std::fs::read_to_string(path) {
        Ok(text) => Ok(Source::new(name, text)),
        Err(error) => Err(Problem::input("unreadable", format!("can't read `{name}`: {error}"))),
    }
}
