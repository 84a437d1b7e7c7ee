//! The file itself: JSON or binary container, and the bytes that it refers to.
//!
//! Nothing here trusts a length. A file is read whole, if it is a regular file of at most [`MOST_BYTES`]; a buffer must
//! have the bytes that it promises; only [`File::slice`] hands any out.

use super::budget::Budget;
use super::census::census;
use super::container::{parse, split};
use super::notes::{Fault, Notes, brief};
use super::uri::{Target, resolve};
use crate::problem::{Problem, Problems};
use gltf::json::{Index, Root, buffer};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Largest file that is read: 4 GiB, as much as a binary glTF can say.
const MOST_BYTES: u64 = 1 << 32;

pub struct File {
    pub root: Root,
    folder: PathBuf,
    /// `None` where the document says nothing about a buffer's content.
    buffers: Vec<Option<Vec<u8>>>,
    /// Everything that was read.
    pub read: Vec<PathBuf>,
    pub budget: Budget,
}

impl File {
    pub fn open(path: &Path, notes: &mut Notes) -> Result<Self, Problems> {
        let name = path.display();
        let content = read(path)?;
        let (json, binary) = split(&content).map_err(|fault| fault.at(&name.to_string(), "the start"))?;
        let no_document = |error: String| {
            let message = format!("`{name}` is not a glTF document: {}", brief(&error));
            Problem::input("gltf-json", message)
                .help("a .glb file begins with `glTF`, and a .gltf file is JSON; export it again")
        };
        let budget = Budget::default();
        budget.read(content.len() as u64);
        let taken = census(json)
            .map_err(|error| no_document(error.to_string()))?
            .saturating_add(content.len() as u64);
        budget.hold(taken).map_err(|fault| fault.at(&name.to_string(), "the whole document"))?;
        let (root, left_out) = parse(json).map_err(no_document)?;
        for _ in 0..left_out {
            notes.lack("animation of something that is no node", "not played");
        }
        if !root.asset.version.starts_with("2.") {
            let version = brief(&root.asset.version);
            let message = format!("`{name}` is glTF {version:?}; only 2.x is understood");
            return Err(Problem::input("gltf-version", message).into());
        }
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        let mut file = Self { root, folder, buffers: Vec::new(), read: vec![path.to_path_buf()], budget };
        for index in 0..file.root.buffers.len() {
            let data = file.buffer(index, binary);
            let data = notes.catch(format_args!("/buffers/{index}"), data);
            file.buffers.push(data.flatten());
        }
        // What is missing in a buffer is missing wherever it is used; once is enough.
        notes.check()?;
        Ok(file)
    }

    /// The content of buffer `index`, cut to the length that it promises.
    fn buffer(&mut self, index: usize, binary: Option<&[u8]>) -> Result<Option<Vec<u8>>, Fault> {
        let buffer = &self.root.buffers[index];
        let length = buffer.byte_length.0;
        let mut data = match (&buffer.uri, binary) {
            (Some(uri), _) => {
                let uri = uri.clone();
                self.fetch(&uri)?
            }
            (None, Some(binary)) if index == 0 => {
                self.budget.hold(binary.len() as u64)?;
                binary.to_vec()
            }
            // Some extensions have buffers without content, for readers that don't know them. Using one is a fault.
            (None, _) => return Ok(None),
        };
        match usize::try_from(length) {
            Ok(length) if length <= data.len() => data.truncate(length),
            _ => {
                let message = format!("byteLength is {length}, but there are only {} bytes", data.len());
                return Err(
                    Fault::new("gltf-length", message).help("was the file cut, or not fetched whole?")
                );
            }
        }
        Ok(Some(data))
    }

    /// The bytes that a URI stands for.
    pub fn fetch(&mut self, uri: &str) -> Result<Vec<u8>, Fault> {
        self.budget.hold(uri.len() as u64)?;
        let relative = match resolve(uri)? {
            Target::Data(data) => return Ok(data),
            Target::File(relative) => relative,
        };
        let path = self.folder.join(&relative);
        let fault = |error: &dyn std::fmt::Display| {
            Fault::new("gltf-file", format!("can't read {:?}: {error}", relative.display()))
        };
        // Links inside the folder could lead anywhere.
        let here = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
        let folder = here.canonicalize().map_err(|error| fault(&error))?;
        if !path.canonicalize().map_err(|error| fault(&error))?.starts_with(&folder) {
            return Err(fault(&"it is a link out of the scene's folder"));
        }
        let length = fs::metadata(&path).map_err(|error| fault(&error))?.len();
        // A file that is named many times is read as often, but is one file.
        if !self.read.contains(&path) {
            self.budget.read(length);
            self.read.push(path.clone());
        }
        self.budget.hold(length)?;
        read_bounded(&path).map_err(|error| fault(&error))
    }

    /// `length` bytes from `offset` of a buffer view.
    pub fn slice(&self, view: Index<buffer::View>, offset: u64, length: u64) -> Result<&[u8], Fault> {
        let views = &self.root.buffer_views;
        let index = view.value();
        let view = views.get(index).ok_or_else(|| Fault::beyond("buffer view", index, views.len()))?;
        if offset.checked_add(length).is_none_or(|end| end > view.byte_length.0) {
            let has = view.byte_length.0;
            let message =
                format!("needs {length} bytes from byte {offset} of buffer view {index}, which has {has}");
            return Err(Fault::new("gltf-length", message));
        }
        let number = view.buffer.value();
        let named = format!("(by buffer view {index}) buffer");
        let buffer =
            self.buffers.get(number).ok_or_else(|| Fault::beyond(&named, number, self.buffers.len()))?;
        let buffer = buffer.as_ref().ok_or_else(|| {
            let message = format!("buffer view {index} is in buffer {number}, which has no content");
            Fault::new("gltf-length", message).help("give the buffer a `uri`, or use a binary glTF")
        })?;
        let start = view.byte_offset.unwrap_or_default().0.checked_add(offset);
        let range = start.zip(start.and_then(|start| start.checked_add(length)));
        range
            .and_then(|(start, end)| buffer.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?))
            .ok_or_else(|| {
                let message = format!(
                    "buffer view {index} reaches beyond the {} bytes of buffer {number}",
                    buffer.len()
                );
                Fault::new("gltf-length", message)
            })
    }

    /// All bytes of a buffer view.
    pub fn whole(&self, view: Index<buffer::View>) -> Result<&[u8], Fault> {
        let length = self.root.buffer_views.get(view.value()).map_or(0, |view| view.byte_length.0);
        self.slice(view, 0, length)
    }
}

/// Reads a file that the user named.
pub fn read(path: &Path) -> Result<Vec<u8>, Problem> {
    read_bounded(path).map_err(|error| {
        let message = format!("can't read the scene `{}`: {error}", path.display());
        match error.kind() {
            ErrorKind::NotFound => Problem::input("scene-file", message)
                .help("check the path; `voxgi generate` writes the built-in scenes to `scenes/`"),
            ErrorKind::InvalidInput => Problem::input("scene-file", message),
            _ => Problem::failure("scene-file", message),
        }
    })
}

fn read_bounded(path: &Path) -> std::io::Result<Vec<u8>> {
    let metadata = fs::metadata(path)?;
    let refuse = |why| Err(std::io::Error::new(ErrorKind::InvalidInput, why));
    if !metadata.is_file() {
        return refuse("it is not a regular file");
    }
    if metadata.len() > MOST_BYTES {
        return refuse("it is larger than 4 GiB");
    }
    fs::read(path)
}
