//! What naga says about composed text, said about the author's files and in WGSL's own words.

use super::compose::{Composed, Segment};
use crate::problem::{Place, Problem};
use naga::WithSpan;
use naga::front::wgsl::ParseError;
use naga::valid::{EntryPointError, FunctionError, GlobalUse, ValidationError};
use std::collections::BTreeSet;
use std::error::Error;

/// How naga begins to say that a name is not there; the name follows, quoted.
const UNDEFINED: &str = "no definition in scope for identifier: ";

/// The name and its place, if `problem` is that the text uses one which is declared nowhere.
pub fn undefined(problem: &Problem) -> Option<(&str, &Place)> {
    let name = problem.message.strip_prefix(UNDEFINED)?;
    Some((name.trim_matches('`'), &problem.labels.first()?.0))
}

/// A text that is not WGSL, or that uses names or types wrongly.
pub fn parse_error(composed: &Composed, error: &ParseError) -> Problem {
    let mut problem = Problem::input("wgsl", error.message().to_owned());
    for (span, text) in error.labels() {
        if let Some(range) = span.to_range() {
            problem = problem.at(&composed.place(range), text);
        }
    }
    if problem.labels.is_empty() {
        problem = problem.at(&composed.start(), "in this kernel");
    }
    let notes: Vec<&str> = error.notes().collect();
    match parts_that_could(composed, error.message()) {
        _ if !notes.is_empty() => problem.help(notes.join("\n")),
        Some(help) => problem.help(help),
        None => problem,
    }
}

/// A name that is not there may be one that another part's module has.
fn parts_that_could(composed: &Composed, message: &str) -> Option<String> {
    let missing = message.starts_with(UNDEFINED);
    let role = |segment: &Segment| Some(format!("`role/{}` is `{}`", segment.role.as_ref()?, segment.kernel));
    let roles: BTreeSet<String> = composed.segments.iter().filter_map(role).collect();
    let roles: Vec<String> = roles.into_iter().collect();
    (missing && !roles.is_empty())
        .then(|| format!("another part's module may have it (`--part ROLE=PART`): here {}", roles.join(", ")))
}

/// A module that parses, but that breaks a rule of WGSL or needs what the device lacks. It points at the smallest
/// piece that naga names, and at the declaration around it.
pub fn invalid(composed: &Composed, error: &WithSpan<ValidationError>) -> Problem {
    let (message, help) = message(error.as_inner());
    let mut problem = Problem::input("wgsl", message);
    let smallest =
        error.spans().filter_map(|(span, about)| Some((span.to_range()?, about))).min_by_key(|s| s.0.len());
    let declaration = around(error.as_inner()).map(|(what, name)| (what, name, composed.place_of(name)));
    if let Some((range, about)) = smallest {
        let place = composed.place(range);
        let whole = declaration.as_ref().is_some_and(|(.., name)| {
            name.source == place.source
                && place.span.start <= name.span.start
                && name.span.end <= place.span.end
        });
        if !whole {
            problem = problem.at(&place, if about.starts_with("naga::") { "here" } else { about });
        }
    }
    problem = match declaration {
        Some((what, name, place)) => problem.at(&place, format!("in the {what} `{name}`")),
        None if problem.labels.is_empty() => problem.at(&composed.start(), "in this kernel"),
        None => problem,
    };
    match help {
        Some(help) => problem.help(help),
        None => problem,
    }
}

/// The declaration that an error is in.
fn around(error: &ValidationError) -> Option<(&'static str, &str)> {
    match error {
        ValidationError::Type { name, .. } if !name.is_empty() => Some(("type", name)),
        ValidationError::Constant { name, .. } => Some(("constant", name)),
        ValidationError::Override { name, .. } => Some(("override", name)),
        ValidationError::GlobalVariable { name, .. } => Some(("variable", name)),
        ValidationError::Function { name, .. } => Some(("function", name)),
        ValidationError::EntryPoint { name, .. } => Some(("entry point", name)),
        _ => None,
    }
}

fn message(error: &ValidationError) -> (String, Option<String>) {
    let function = match error {
        ValidationError::Function { source, .. } => Some(source),
        ValidationError::EntryPoint { source: EntryPointError::Function(source), .. } => Some(source),
        _ => None,
    };
    if let Some(FunctionError::InvalidReturnType { expression, .. }) = function {
        let message = match expression {
            Some(_) => "what is returned is not of the type that the function declares",
            None => "the function can end without returning a value",
        };
        return (message.to_owned(), None);
    }
    match error {
        ValidationError::EntryPoint { source: EntryPointError::ForbiddenStageOperations, .. } => (
            "something is called that this stage does not have".to_owned(),
            Some(
                "`textureSample` and derivatives are for fragments only: use `textureSampleLevel` elsewhere"
                    .to_owned(),
            ),
        ),
        ValidationError::EntryPoint { source: EntryPointError::InvalidGlobalUsage(_, usage), .. }
            if usage.contains(GlobalUse::WRITE) =>
        {
            let help = "a storage buffer is read-only unless it says `var<storage, read_write>`; uniforms always are";
            ("something is written to that is declared read-only".to_owned(), Some(help.to_owned()))
        }
        error => {
            let mut innermost: &dyn Error = error;
            while let Some(source) = innermost.source() {
                innermost = source;
            }
            (in_wgsl(&innermost.to_string()), None)
        }
    }
}

/// naga's message with WGSL's names of types, and without the indices of its arenas.
fn in_wgsl(message: &str) -> String {
    let mut text = message.to_owned();
    for (kind, width, name) in [
        ("Float", 4, "f32"),
        ("Sint", 4, "i32"),
        ("Uint", 4, "u32"),
        ("Bool", 1, "bool"),
        ("Float", 2, "f16"),
        ("Float", 8, "f64"),
    ] {
        let scalar = format!("Scalar {{ kind: {kind}, width: {width} }}");
        text = text.replace(&format!("Scalar({scalar})"), name).replace(&scalar, name);
        for (rows, r) in [("Bi", 2), ("Tri", 3), ("Quad", 4)] {
            let vector = format!("Vector {{ size: {rows}, scalar: {name} }}");
            text = text.replace(&vector, &format!("vec{r}<{name}>"));
            for (columns, c) in [("Bi", 2), ("Tri", 3), ("Quad", 4)] {
                let matrix = format!("Matrix {{ columns: {columns}, rows: {rows}, scalar: {name} }}");
                text = text.replace(&matrix, &format!("mat{c}x{r}<{name}>"));
            }
        }
    }
    let mut text = without_indices(&text);
    while let Some(start) = text.find("(of type ")
        && let Some(length) = text[start..].find(')')
    {
        let named = text[start + "(of type ".len()..start + length].to_owned();
        text.replace_range(start..=start + length, &named);
    }
    text
}

/// ` [12]` and ` of [12]` taken out.
fn without_indices(text: &str) -> String {
    let mut result = String::new();
    let mut rest = text;
    while let Some(open) = rest.find(" [") {
        let inner = &rest[open + 2..];
        let digits = inner.find(|c: char| !c.is_ascii_digit()).unwrap_or(inner.len());
        let is_index = digits > 0 && inner[digits..].starts_with(']');
        let end = if is_index { open + 2 + digits + 1 } else { open + 2 };
        let before = &rest[..open];
        result.push_str(if is_index { before.strip_suffix(" of").unwrap_or(before) } else { &rest[..end] });
        rest = &rest[end..];
    }
    result.push_str(rest);
    result
}
