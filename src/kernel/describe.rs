//! What a file of `kernels/` is, for people who look for one.

use super::compose::{Composed, compose};
use super::reflect::{declared_bindings, reflect_with};
use super::scan::{header, scan};
use super::{Binding, Entry, Override};
use crate::expr::{Names, Value};
use crate::library::{Library, Shelf};
use crate::problem::{Result, Source};
use std::collections::{BTreeMap, BTreeSet};

/// A kernel or a module, with all that any variant of it may have.
#[derive(Clone, Debug)]
pub struct Description {
    pub name: String,
    /// The header comment.
    pub about: String,
    /// What it imports itself, as written.
    pub imports: Vec<String>,
    /// Roles, its own or of its imports, that were not given: nothing more can then be said.
    pub needs: Vec<String>,
    pub bindings: Vec<Binding>,
    /// None for a module.
    pub entries: Vec<Entry>,
    pub overrides: Vec<Override>,
}

/// Names of which nothing is known, so that every condition keeps what it stands before.
struct Anything;

impl Names for Anything {
    fn get(&self, _: &str) -> Option<Value> {
        Some(Value::Unknown)
    }

    fn known(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Describes the file `name` with all conditions open and with `roles` as far as they are given. Overrides without a
/// default count as 1.
///
/// # Errors
/// As [`compose`](super::compose()) and [`reflect`](super::reflect()), but for roles that are not given.
pub fn describe(library: &Library, name: &str, roles: &BTreeMap<String, String>) -> Result<Description> {
    let source = library.find(Shelf::Kernels, name)?;
    let imports = scan(&source, &Anything).imports.into_iter().map(|(path, _)| path).collect();
    let mut description = Description {
        name: name.to_owned(),
        about: header(source.text()),
        imports,
        needs: missing_roles(library, &source, roles),
        bindings: Vec::new(),
        entries: Vec::new(),
        overrides: Vec::new(),
    };
    if description.needs.is_empty() {
        let composed: Composed = compose(library, name, &source.at(0..0), roles, &Anything)?;
        let module = !["@compute", "@vertex", "@fragment"].iter().any(|stage| composed.text.contains(stage));
        let reflected = match reflect_with(&composed, &BTreeMap::new(), Some(1.0)) {
            // A module may leave something for its importers to define; what is wrong in it, they tell.
            Err(_) if module => return Ok(description),
            reflected => reflected?,
        };
        description.bindings =
            if reflected.entries.is_empty() { declared_bindings(&composed)? } else { reflected.bindings };
        description.entries = reflected.entries;
        description.overrides = reflected.overrides;
    }
    Ok(description)
}

/// Whether the file `kernel`, or one that it imports by its own name, declares `name` under some condition.
pub fn declares(library: &Library, kernel: &str, name: &str) -> bool {
    let mut seen = BTreeSet::from([kernel.to_owned()]);
    let mut open = vec![kernel.to_owned()];
    while let Some(kernel) = open.pop() {
        let Ok(source) = library.find(Shelf::Kernels, &kernel) else { continue };
        let scan = scan(&source, &Anything);
        if scan.declarations.iter().any(|declaration| declaration.name == name) {
            return true;
        }
        let imports =
            scan.imports.into_iter().map(|(path, _)| path).filter(|path| !path.starts_with("role/"));
        open.extend(imports.filter(|path| seen.insert(path.clone())));
    }
    false
}

/// The roles that a file and its imports name, and that are not given. What is wrong otherwise, composing tells.
fn missing_roles(library: &Library, source: &Source, roles: &BTreeMap<String, String>) -> Vec<String> {
    let (mut missing, mut seen) = (Vec::new(), Vec::new());
    let mut open = vec![source.clone()];
    while let Some(source) = open.pop() {
        if seen.contains(&source) {
            continue;
        }
        for (path, _) in scan(&source, &Anything).imports {
            let path = match path.strip_prefix("role/") {
                None => path,
                Some(role) => match roles.get(role) {
                    Some(module) => module.clone(),
                    None => {
                        missing.push(role.to_owned());
                        continue;
                    }
                },
            };
            open.extend(library.find(Shelf::Kernels, &path));
        }
        seen.push(source);
    }
    missing.sort();
    missing.dedup();
    missing
}
