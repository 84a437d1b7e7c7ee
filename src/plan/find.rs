//! Resources by the names that users give on the command line.

use super::{Plan, Reference, ResourceKind};
use crate::problem::{Problem, Result, Source};

impl Plan {
    /// The subresource that `text` names: a path, then possibly `@mip2`, `@layer1`, `@previous`. Without a mip or layer, the
    /// first.
    pub fn resource(&self, text: &str) -> Result<Reference, Problem> {
        let source = Source::new("--dump", text);
        let mut pieces = text.split('@');
        let path = pieces.next().unwrap_or_default();
        let paths = || self.resources.iter().map(|r| r.path.as_str());
        let resource = self.resources.iter().position(|r| r.path == path).ok_or_else(|| {
            Problem::input("unknown-resource", format!("the pipeline has no resource `{path}`"))
                .at(&source.at(0..path.len()), "named here")
                .suggest(path, paths())
        })?;
        let mut reference = Reference { resource, mip: None, layer: None, previous: false };
        let mut at = path.len();
        for piece in pieces {
            at += 1;
            let place = source.at(at..at + piece.len());
            at += piece.len();
            let number = |prefix: &str| piece.strip_prefix(prefix).and_then(|n| n.parse::<u32>().ok());
            match (number("mip"), number("layer"), piece) {
                (Some(mip), _, _) => reference.mip = Some(mip),
                (_, Some(layer), _) => reference.layer = Some(layer),
                (_, _, "previous") => reference.previous = true,
                _ => {
                    return Err(Problem::input("bad-reference", format!("`@{piece}` means nothing"))
                        .at(&place, "here")
                        .help("say `name@mip2`, `name@layer1` or `name@previous`"));
                }
            }
        }
        let (mips, layers) = match &self.resources[resource].kind {
            ResourceKind::Texture { mips, layers, .. } => (mips.unwrap_or(1), layers.unwrap_or(1)),
            _ => (1, 1),
        };
        let beyond = |what: &str, count: u32| {
            Problem::input("out-of-range", format!("`{path}` has {count} {what}, counted from 0"))
                .at(&source.at(path.len()..text.len()), "there is no such one")
        };
        if reference.mip.is_some_and(|m| m >= mips) {
            return Err(beyond("mip levels", mips));
        }
        if reference.layer.is_some_and(|l| l >= layers) {
            return Err(beyond("layers", layers));
        }
        Ok(reference)
    }
}
