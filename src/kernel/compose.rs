//! From a kernel's name to one text: its imports put before it, roles put in, conditions decided.
//!
//! ```text
//! import lib/sampling;              the file kernels/lib/sampling.wgsl
//! import role/material;             the file that the pipeline names for the role `material`
//! @if(lights.total > 0) var …       kept if the condition holds or can't be decided yet
//! @elif(…) … @else …                the other cases, directly after it
//! ```
//!
//! Each file is put in once, whole, imports before importers, in the order in which they are named. What goes away is
//! overwritten with spaces, so that every byte that is left stands at a known place of its file, and names stay as
//! their authors wrote them. Two module-scope declarations of one name are an error, also across files.
//!
//! In a file that came as `role/NAME`, a name in a condition is looked up as `NAME.name` first, then as `name`; only
//! the file itself belongs to the role, not what it imports.

use super::condition::RoleNames;
use super::scan::{Declaration, Scan, header, scan};
use crate::expr::Names;
use crate::library::{Library, Shelf};
use crate::problem::{Place, Problem, Problems, Result, Source};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// How many imports deep a file may be.
const DEEPEST: usize = 64;
/// How many declarations a kernel may have with its imports: naga follows chains of them by recursion.
const MOST_DECLARATIONS: usize = 2000;

/// A kernel and its imports as one text of WGSL without binding numbers.
#[derive(Clone, Debug)]
pub struct Composed {
    /// The kernel's name.
    pub kernel: String,
    pub text: Arc<str>,
    /// Where the text comes from: all of it, in order.
    pub segments: Arc<[Segment]>,
    /// The header comment of the kernel's file.
    pub about: String,
    /// All module-scope declarations, by name.
    pub declarations: BTreeMap<String, Declared>,
    /// Conditions that can't be decided yet; what stands behind them was kept.
    pub undecided: Vec<Place>,
}

/// A piece of the composed text that stands, byte by byte, in one file.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Segment {
    /// Bytes of the composed text.
    pub span: Range<usize>,
    pub source: Source,
    /// The byte of `source` at which the piece begins.
    pub from: usize,
    /// The file's name in the library.
    pub kernel: String,
    /// The role as which it was imported.
    pub role: Option<String>,
}

/// A declaration, and the role whose module it is in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declared {
    pub declaration: Declaration,
    pub role: Option<String>,
}

impl Composed {
    /// Where bytes of the composed text stand in the author's file; cut to the file in which they begin.
    pub fn place(&self, span: Range<usize>) -> Place {
        let index = self.segments.partition_point(|segment| segment.span.end <= span.start);
        match self.segments.get(index).or(self.segments.last()) {
            Some(segment) => {
                let inside =
                    |byte: usize| byte.clamp(segment.span.start, segment.span.end) - segment.span.start;
                segment.source.at(segment.from + inside(span.start)..segment.from + inside(span.end))
            }
            None => Source::new(&self.kernel, "").at(0..0),
        }
    }

    /// Where the declaration of `name` says its name; the start of the kernel if there is none.
    pub fn place_of(&self, name: &str) -> Place {
        match self.declarations.get(name) {
            Some(declared) => declared.declaration.place.clone(),
            None => self.start(),
        }
    }

    /// The start of the kernel's own file, for problems that belong to no line.
    pub fn start(&self) -> Place {
        let own = self.segments.last().map(|segment| segment.source.at(0..0));
        own.unwrap_or_else(|| self.place(0..0))
    }
}

/// Composes the kernel `kernel`, which is named at `at`, with `roles` (role → kernel name of its module) and the
/// features and knobs `names` for conditions.
///
/// # Errors
/// All of: a file that does not exist, a role that nobody fills, a ring of imports, one file in two roles, names
/// declared twice, wrong conditions, binding numbers, brackets that do not match.
pub fn compose(
    library: &Library,
    kernel: &str,
    at: &Place,
    roles: &BTreeMap<String, String>,
    names: &dyn Names,
) -> Result<Composed> {
    let mut loader =
        Loader { library, roles, names, open: Vec::new(), files: Vec::new(), problems: Vec::new() };
    loader.load(kernel, None, at);
    let declarations = loader.declarations();
    Problems::check(std::mem::take(&mut loader.problems))?;
    let (text, segments) = join(&loader.files);
    let about = loader.files.last().map(|file| header(file.source.text())).unwrap_or_default();
    let undecided = loader.files.iter().flat_map(|file| file.scan.undecided.iter().cloned()).collect();
    Ok(Composed {
        kernel: kernel.to_owned(),
        text: text.into(),
        segments: segments.into(),
        about,
        declarations,
        undecided,
    })
}

struct File {
    kernel: String,
    role: Option<String>,
    source: Source,
    scan: Scan,
}

struct Loader<'a> {
    library: &'a Library,
    roles: &'a BTreeMap<String, String>,
    names: &'a dyn Names,
    /// The files that are being imported, outermost first.
    open: Vec<String>,
    /// The files that are there, imports before importers.
    files: Vec<File>,
    problems: Vec<Problem>,
}

impl Loader<'_> {
    fn load(&mut self, kernel: &str, role: Option<&str>, at: &Place) {
        if let Some(start) = self.open.iter().position(|open| open == kernel) {
            let ring =
                self.open[start..].iter().map(String::as_str).chain([kernel]).collect::<Vec<_>>().join(" → ");
            self.problems.push(
                Problem::input("import-ring", format!("kernels import each other in a ring: {ring}"))
                    .at(at, "this import closes the ring")
                    .help("move what both need into a file that both import"),
            );
            return;
        }
        if let Some(file) = self.files.iter().find(|file| file.kernel == kernel) {
            if file.role.as_deref() != role {
                let way = |role: Option<&str>| {
                    role.map_or("by its own name".to_owned(), |role| format!("as `role/{role}`"))
                };
                let ways = format!("{} and {}", way(file.role.as_deref()), way(role));
                self.problems.push(
                    Problem::input("import-twice", format!("`{kernel}` is imported {ways}"))
                        .at(at, "the second import")
                        .help("a file is put in once, and its bindings are looked up in one place: import it one way"),
                );
            }
            return;
        }
        if self.open.len() >= DEEPEST {
            self.problems.push(
                Problem::input("deep-imports", format!("imports go more than {DEEPEST} files deep"))
                    .at(at, "this one"),
            );
            return;
        }
        let source = match self.library.find(Shelf::Kernels, kernel) {
            Ok(source) => source,
            Err(problem) => {
                let label = match role {
                    Some(role) => format!("the part in the role `{role}` names it as its `module`"),
                    None if self.open.is_empty() => "named here".to_owned(),
                    None => "imported here".to_owned(),
                };
                self.problems.push(problem.at(at, label));
                return;
            }
        };
        let mut scan = match role {
            Some(role) => scan(&source, &RoleNames { role, names: self.names }),
            None => scan(&source, self.names),
        };
        self.problems.append(&mut scan.problems);
        self.open.push(kernel.to_owned());
        for (path, place) in std::mem::take(&mut scan.imports) {
            self.import(&path, &place);
        }
        self.open.pop();
        self.files.push(File { kernel: kernel.to_owned(), role: role.map(str::to_owned), source, scan });
    }

    fn import(&mut self, path: &str, place: &Place) {
        let Some(role) = path.strip_prefix("role/") else {
            return self.load(path, None, place);
        };
        let roles = self.roles;
        match roles.get(role) {
            Some(module) => self.load(module, Some(role), place),
            None => self.problems.push(
                Problem::input(
                    "unknown-role",
                    format!("no part of the pipeline fills the role `{role}` with a module"),
                )
                .at(place, "this role is needed here")
                .help("give the pipeline a part in this role that has a `module`")
                .suggest(role, roles.keys().map(String::as_str)),
            ),
        }
    }

    fn declarations(&mut self) -> BTreeMap<String, Declared> {
        let mut all: BTreeMap<String, Declared> = BTreeMap::new();
        let mut each = self.files.iter().flat_map(|file| &file.scan.declarations);
        if let Some(declaration) = each.nth(MOST_DECLARATIONS) {
            let message = format!("a kernel with more than {MOST_DECLARATIONS} declarations");
            self.problems.push(Problem::input("too-long", message).at(&declaration.place, "one too many"));
        }
        for file in &self.files {
            for declaration in &file.scan.declarations {
                let name = &declaration.name;
                if let Some(first) = all.get(name) {
                    self.problems.push(
                        Problem::input("declared-twice", format!("`{name}` is declared twice"))
                            .at(&declaration.place, "declared here")
                            .at(&first.declaration.place, "and here")
                            .help("imports keep their names, so each name can have one meaning: rename one of them"),
                    );
                } else {
                    let declared = Declared { declaration: declaration.clone(), role: file.role.clone() };
                    all.insert(name.clone(), declared);
                }
            }
        }
        all
    }
}

/// All directives, then all files.
fn join(files: &[File]) -> (String, Vec<Segment>) {
    let mut text = String::new();
    let mut segments = Vec::new();
    let mut add = |file: &File, from: usize, piece: &str| {
        let start = text.len();
        text.push_str(piece);
        text.push('\n');
        segments.push(Segment {
            span: start..text.len(),
            source: file.source.clone(),
            from,
            kernel: file.kernel.clone(),
            role: file.role.clone(),
        });
    };
    for file in files {
        for directive in &file.scan.directives {
            add(file, directive.start, &file.source.text()[directive.clone()]);
        }
    }
    for file in files {
        add(file, 0, &blanked(file.source.text(), &file.scan.blank));
    }
    (text, segments)
}

/// `text` with a space for each byte of `blank`, but for the ends of lines.
fn blanked(text: &str, blank: &[Range<usize>]) -> String {
    let mut blank = blank.to_vec();
    blank.sort_unstable_by_key(|range| range.start);
    let mut result = String::with_capacity(text.len());
    let mut at = 0;
    for range in blank {
        let start = range.start.max(at);
        if range.end <= start {
            continue;
        }
        result.push_str(&text[at..start]);
        result.extend(text[start..range.end].bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }));
        at = range.end;
    }
    result.push_str(&text[at..]);
    result
}
