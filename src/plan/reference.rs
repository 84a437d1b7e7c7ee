//! References to resources and to pieces of them: `name`, `name@mip2`, `name@layer(light)@previous`.

use super::world::{Live, World};
use super::{Named, Reference, ResourceId, ResourceKind, ScopeId, Start, resources};
use crate::document::Spanned;
use crate::problem::{Place, Problem};
use std::ops::Range;

const FORMS: &str = "references are `name`, then possibly `@mip2` or `@mip(expression)`, `@layer2` or \
                     `@layer(expression)`, and `@previous`";

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axis {
    Mip,
    Layer,
}

impl World<'_> {
    /// What `text` refers to in `scope`, before swaps. An index that is unknown counts as 0; one that is out of range
    /// in what is not live, as the last.
    pub fn reference(&self, text: &Spanned<String>, scope: ScopeId, live: Live) -> Option<Reference> {
        if text.place.text() != text.value {
            return self.bad(&text.place, "a reference is written without escapes");
        }
        let at = |span: Range<usize>| {
            let start = text.place.span.start;
            trim(&text.place.source.at(start + span.start..start + span.end))
        };
        let mut pieces = pieces(&text.value).into_iter().map(at);
        let mut reference = self.resource_named(&pieces.next()?, scope)?;
        for piece in pieces {
            let whole = piece.text();
            if whole == "previous" {
                self.check_kept(reference.resource, &piece)?;
                reference.previous = true;
            } else if let Some(index) = whole.strip_prefix("mip") {
                let index = self.index(&reference, Axis::Mip, index, &piece, scope, live)?;
                self.set_once(&mut reference.mip, index, &piece)?;
            } else if let Some(index) = whole.strip_prefix("layer") {
                let index = self.index(&reference, Axis::Layer, index, &piece, scope, live)?;
                self.set_once(&mut reference.layer, index, &piece)?;
            } else {
                return self.bad(&piece, &format!("`@{whole}` means nothing"));
            }
        }
        Some(reference)
    }

    fn bad<T>(&self, place: &Place, message: &str) -> Option<T> {
        self.report(Problem::input("bad-reference", message).at(place, "here").help(FORMS));
        None
    }

    fn resource_named(&self, place: &Place, scope: ScopeId) -> Option<Reference> {
        let name = place.text();
        match self.lookup(scope, name) {
            Some(Named::Resource(reference)) => return Some(*reference),
            Some(_) => {
                let problem = Problem::input("not-a-resource", format!("`{name}` is not a resource"));
                self.report(problem.at(place, "a resource should be here"));
            }
            None => {
                let known = super::visible(&self.scopes, scope);
                let known = known.iter().filter(|(_, named)| matches!(named, Named::Resource(_)));
                let problem =
                    Problem::input("unknown-resource", format!("there is no resource `{name}` here"));
                self.report(problem.at(place, "used here").suggest(name, known.map(|(name, _)| *name)));
            }
        }
        None
    }

    fn check_kept(&self, id: ResourceId, place: &Place) -> Option<()> {
        let resource = &self.resources[id];
        if matches!(resources::start(resource.declared), Start::Kept { .. }) {
            return Some(());
        }
        let message =
            format!("`{}` is not kept from frame to frame, so it has no `@previous`", resource.path);
        self.report(
            Problem::input("not-kept", message)
                .at(place, "the frame before is asked for")
                .at(&resource.place, "does not begin with what the frame before left")
                .help("declare it with `start: Kept(value: 0, reset: [Camera])`"),
        );
        None
    }

    fn set_once(&self, slot: &mut Option<u32>, index: u32, place: &Place) -> Option<()> {
        if slot.is_some() {
            return self.bad(place, "one piece of this has been chosen already");
        }
        *slot = Some(index);
        Some(())
    }

    /// The number in `@mip…` or `@layer…`, of which `text` is what comes after the word and `place` all after the `@`.
    fn index(
        &self,
        of: &Reference,
        axis: Axis,
        text: &str,
        place: &Place,
        scope: ScopeId,
        live: Live,
    ) -> Option<u32> {
        let start = place.span.end - text.len();
        let digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        let place = match text.strip_prefix('(').and_then(|text| text.strip_suffix(')')) {
            Some(inner) => place.source.at(start + 1..start + 1 + inner.len()),
            None if digits => place.source.at(start..place.span.end),
            None => return self.bad(place, &format!("`@{}` means nothing", place.text())),
        };
        let resource = &self.resources[of.resource];
        let (what, count) = match (axis, self.resource(of.resource).0) {
            (Axis::Mip, ResourceKind::Texture { mips, .. }) => ("mip", mips),
            (Axis::Layer, ResourceKind::Texture { layers, array: true, .. }) => ("layer", layers),
            (Axis::Mip, _) => return self.bad(&place, &format!("`{}` has no mips", resource.path)),
            (Axis::Layer, _) => return self.bad(&place, &format!("`{}` has no layers", resource.path)),
        };
        let written = Spanned { value: place.text().to_owned(), place };
        let index = self.whole(&written, scope, 0, live).unwrap_or(0);
        let last = count.map_or(u32::MAX, |count| count - 1);
        if index > u64::from(last) && live == Live::Yes {
            let message = format!("there is no {what} {index} of `{}`: the last is {last}", resource.path);
            self.report(
                Problem::input("out-of-range", message)
                    .at(&written.place, format!("this is {index}"))
                    .at(&resource.place, format!("declared here, with {what}s 0 to {last}")),
            );
        }
        Some(u32::try_from(index).map_or(last, |index| index.min(last)))
    }
}

/// `text` cut at each `@` that is outside of parentheses.
fn pieces(text: &str) -> Vec<Range<usize>> {
    let mut depth = 0i64;
    let mut start = 0;
    let mut found = Vec::new();
    for (i, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            b'@' if depth == 0 => {
                found.push(start..i);
                start = i + 1;
            }
            _ => {}
        }
    }
    found.push(start..text.len());
    found
}

fn trim(place: &Place) -> Place {
    let text = place.text();
    let start = place.span.start + (text.len() - text.trim_start().len());
    place.source.at(start..start + text.trim().len())
}
