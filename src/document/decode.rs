//! From a tree to a document: the file's root, knobs, samplers, resources.

use super::read::{Fields, Reader};
use super::tree::{Node, Tree};
use super::{
    Allowed, Cause, Compare, Document, Filter, Knob, Lack, Progress, Resource, Root, Sampler, Spanned, Start,
    Wrap,
};
use crate::problem::Problem;

const SHARED: [&str; 7] = ["about", "knobs", "values", "samplers", "resources", "stages", "lacks"];
const OF_PIPELINES: [&str; 3] = ["parts", "outputs", "progress"];
const OF_PARTS: [&str; 6] = ["role", "module", "modules", "moving", "order_dependent", "exports"];

pub(super) const COMPARES: [(&str, Compare); 6] = [
    ("Less", Compare::Less),
    ("LessEqual", Compare::LessEqual),
    ("Greater", Compare::Greater),
    ("GreaterEqual", Compare::GreaterEqual),
    ("Equal", Compare::Equal),
    ("Always", Compare::Always),
];

const CAUSES: [(&str, Cause); 6] = [
    ("Geometry", Cause::Geometry),
    ("Moving", Cause::Moving),
    ("Lights", Cause::Lights),
    ("Camera", Cause::Camera),
    ("Knobs", Cause::Knobs),
    ("Frame", Cause::Frame),
];

impl Reader<'_> {
    /// Reads on after a problem, so that all problems of the file are found.
    pub fn document(&mut self, tree: &Tree) -> Option<Document> {
        const WHAT: &str = "`Pipeline(…)` or `Part(…)`";
        let (Node::Named(Some(name), _) | Node::Tuple(Some(name), _)) = &tree.node else {
            return self.wrong(tree, WHAT);
        };
        let (what, own) = match name.text.as_str() {
            "Pipeline" => ("a pipeline", &OF_PIPELINES[..]),
            "Part" => ("a part", &OF_PARTS[..]),
            other => {
                let known = ["Pipeline", "Part"];
                return self.unknown_variant(
                    other,
                    &name.span,
                    &format!("a file's beginning, {WHAT}"),
                    &known,
                );
            }
        };
        let known: Vec<&str> = own.iter().chain(&SHARED).copied().collect();
        let fields = self.fields(tree, what, &known)?;
        let root = if what == "a part" { self.part(&fields) } else { self.pipeline(&fields) };
        let about = self.required(&fields, "about").and_then(|tree| self.text(tree));
        let knobs = self.entries(fields.get("knobs"), |reader, tree| {
            Some(Spanned { value: reader.knob(tree)?, place: reader.place(&tree.span) })
        });
        let values = self.entries(fields.get("values"), Self::expression);
        let samplers = self.entries(fields.get("samplers"), |reader, tree| {
            Some(Spanned { value: reader.sampler(tree)?, place: reader.place(&tree.span) })
        });
        let resources = self.entries(fields.get("resources"), |reader, tree| {
            Some(Spanned { value: reader.resource(tree)?, place: reader.place(&tree.span) })
        });
        let stages = self.optional(fields.get("stages"), Self::stages);
        let lacks = self.optional(fields.get("lacks"), |reader, tree| reader.list(tree, Self::lack));
        Some(Document {
            source: self.source.clone(),
            root: root?,
            about: about?,
            knobs: knobs?,
            values: values?,
            samplers: samplers?,
            resources: resources?,
            stages: stages?.unwrap_or_default(),
            lacks: lacks?.unwrap_or_default(),
        })
    }

    fn lack(&mut self, tree: &Tree) -> Option<Lack> {
        let fields = self.fields(tree, "what is lacking", &["when", "what"])?;
        let when = self.required(&fields, "when").and_then(|tree| self.expression(tree));
        let what = self.required(&fields, "what").and_then(|tree| self.text(tree));
        Some(Lack { when: when?, what: what? })
    }

    fn pipeline(&mut self, fields: &Fields<'_>) -> Option<Root> {
        let parts = self.entries(fields.get("parts"), Self::text);
        let outputs = self.entries(fields.get("outputs"), Self::text);
        let progress = self.optional(fields.get("progress"), Self::progress);
        Some(Root::Pipeline { parts: parts?, outputs: outputs?, progress: progress? })
    }

    fn progress(&mut self, tree: &Tree) -> Option<Progress> {
        let fields = self.fields(tree, "progress", &["batch", "frames", "first"])?;
        let batch = self.required(&fields, "batch").and_then(|tree| self.expression(tree));
        let frames = self.required(&fields, "frames").and_then(|tree| self.expression(tree));
        let first = self.required(&fields, "first").and_then(|tree| self.text(tree));
        Some(Progress { batch: batch?, frames: frames?, first: first? })
    }

    fn part(&mut self, fields: &Fields<'_>) -> Option<Root> {
        let role = self.required(fields, "role").and_then(|tree| self.name(tree));
        let module = self.optional(fields.get("module"), Self::text);
        let modules = self.entries(fields.get("modules"), Self::text);
        let moving = self.entries(fields.get("moving"), Self::name);
        let order_dependent = self.optional(fields.get("order_dependent"), Self::text);
        let exports = self.optional(fields.get("exports"), |reader, tree| reader.list(tree, Self::name));
        let exports = exports?.unwrap_or_default();
        let (module, modules, moving) = (module?, modules?, moving?);
        Some(Root::Part { role: role?, module, modules, moving, order_dependent: order_dependent?, exports })
    }

    fn knob(&mut self, tree: &Tree) -> Option<Knob> {
        let fields = self.fields(tree, "a knob", &["default", "range", "values", "unit", "about"])?;
        let default = self.required(&fields, "default").and_then(|tree| {
            let value = self.literal(tree)?;
            Some(self.spanned(value, tree))
        });
        let allowed = match (fields.get("range"), fields.get("values")) {
            (None, None) => Some(Allowed::Any),
            (Some(range), None) => self.range(range),
            (None, Some(values)) => self.list(values, Self::literal).map(Allowed::Values),
            (Some(range), Some(values)) => {
                let problem = Problem::input("bad-knob", "a knob has a range or a list of values, not both")
                    .at(&self.place(&values.span), "values")
                    .at(&self.place(&range.span), "and a range");
                self.problems.push(problem);
                None
            }
        };
        let unit = self.optional(fields.get("unit"), Self::text);
        let about = self.required(&fields, "about").and_then(|tree| self.text(tree));
        Some(Knob { default: default?, allowed: allowed?, unit: unit?.map(|unit| unit.value), about: about? })
    }

    fn range(&mut self, tree: &Tree) -> Option<Allowed> {
        let Node::Tuple(None, ends) = &tree.node else { return self.wrong(tree, "a range, `(least, most)`") };
        let [least, most] = ends.as_slice() else { return self.wrong(tree, "a range, `(least, most)`") };
        let (least, most) = (self.number(least), self.number(most));
        let (least, most) = (least?, most?);
        if least > most {
            let problem = Problem::input("bad-knob", format!("nothing is from {least} to {most}"));
            self.problems.push(
                problem.at(&self.place(&tree.span), "an empty range").help("the smaller end comes first"),
            );
            return None;
        }
        Some(Allowed::Range(least, most))
    }

    fn sampler(&mut self, tree: &Tree) -> Option<Sampler> {
        const FILTERS: [(&str, Filter); 2] = [("Nearest", Filter::Nearest), ("Linear", Filter::Linear)];
        const WRAPS: [(&str, Wrap); 3] =
            [("Clamp", Wrap::Clamp), ("Repeat", Wrap::Repeat), ("Mirror", Wrap::Mirror)];
        let fields = self.fields(tree, "a sampler", &["filter", "mip_filter", "wrap", "compare"])?;
        let filter =
            self.optional(fields.get("filter"), |reader, tree| reader.choice(tree, "a filter", &FILTERS));
        let mip_filter =
            self.optional(fields.get("mip_filter"), |reader, tree| reader.choice(tree, "a filter", &FILTERS));
        let wrap =
            self.optional(fields.get("wrap"), |reader, tree| reader.choice(tree, "a way to wrap", &WRAPS));
        let compare = self.optional(fields.get("compare"), Self::compare);
        Some(Sampler {
            filter: filter?.unwrap_or_default(),
            mip_filter: mip_filter?.unwrap_or_default(),
            wrap: wrap?.unwrap_or_default(),
            compare: compare?,
        })
    }

    pub fn compare(&mut self, tree: &Tree) -> Option<Compare> {
        self.choice(tree, "a comparison", &COMPARES)
    }

    fn resource(&mut self, tree: &Tree) -> Option<Resource> {
        match self.variant(tree, "a resource", &["Texture", "Buffer"])? {
            "Texture" => {
                let fields =
                    self.fields(tree, "a texture", &["format", "size", "mips", "layers", "start"])?;
                let format = self.required(&fields, "format").and_then(|tree| self.expression(tree));
                let size = self.optional(fields.get("size"), Self::size);
                let mips = self.optional(fields.get("mips"), |reader, tree| match tree.node {
                    Node::Name if &reader.source.text()[tree.span.clone()] == "All" => {
                        Some(reader.spanned("all".to_owned(), tree))
                    }
                    _ => reader.expression(tree),
                });
                let layers = self.optional(fields.get("layers"), Self::expression);
                let start = self.start(&fields);
                Some(Resource::Texture {
                    format: format?,
                    size: size?.unwrap_or_default(),
                    mips: mips?,
                    layers: layers?,
                    start: start?,
                })
            }
            _ => {
                let fields = self.fields(tree, "a buffer", &["count", "start"])?;
                let count = self.optional(fields.get("count"), Self::expression);
                let start = self.start(&fields);
                Some(Resource::Buffer { count: count?, start: start? })
            }
        }
    }

    fn size(&mut self, tree: &Tree) -> Option<Vec<Spanned<String>>> {
        let sizes = self.list(tree, Self::expression)?;
        if (1..=3).contains(&sizes.len()) { Some(sizes) } else { self.wrong(tree, "one to three sizes") }
    }

    fn start(&mut self, fields: &Fields<'_>) -> Option<Spanned<Start>> {
        let tree = self.required(fields, "start")?;
        let start = match self.variant(tree, "a start", &["Fill", "Covered", "Kept"])? {
            "Fill" => match &tree.node {
                Node::Tuple(_, items) if items.len() == 1 => Start::Fill(self.number(&items[0])?),
                _ => return self.wrong(tree, "`Fill(value)`"),
            },
            "Covered" if matches!(tree.node, Node::Name) => Start::Covered,
            "Covered" => return self.wrong(tree, "`Covered` alone"),
            _ if matches!(tree.node, Node::Name) => {
                Start::Kept { value: 0.0, reset: Vec::new(), steady: false }
            }
            _ => {
                let fields = self.fields(tree, "`Kept`", &["value", "reset", "steady"])?;
                let value = self.optional(fields.get("value"), Self::number);
                let reset = self.optional(fields.get("reset"), |reader, tree| {
                    reader.list(tree, |reader, tree| reader.choice(tree, "a cause of change", &CAUSES))
                });
                let steady = self.optional(fields.get("steady"), Self::flag);
                Start::Kept {
                    value: value?.unwrap_or(0.0),
                    reset: reset?.unwrap_or_default(),
                    steady: steady?.unwrap_or(false),
                }
            }
        };
        Some(self.spanned(start, tree))
    }

    /// Which of `known` the tree's name is.
    pub fn variant(&mut self, tree: &Tree, what: &str, known: &[&'static str]) -> Option<&'static str> {
        let (name, span) = match &tree.node {
            Node::Named(Some(name), _) | Node::Tuple(Some(name), _) => (name.text.as_str(), &name.span),
            Node::Name => (&self.source.text()[tree.span.clone()], &tree.span),
            _ => return self.wrong(tree, &format!("{what}: {}", known.join(", "))),
        };
        match known.iter().find(|variant| **variant == name) {
            Some(variant) => Some(variant),
            None => self.unknown_variant(name, span, what, known),
        }
    }
}
