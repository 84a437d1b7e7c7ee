//! From a tree to the stages of a document.

use super::read::{Fields, Reader};
use super::tree::{Node, Tree};
use super::{Blend, Call, Compute, Depth, Draw, ExprText, Extent, Geometry, Over, Raster, Spanned, Stage};
use crate::problem::Problem;

const STAGES: [&str; 5] = ["Compute", "Raster", "Part", "Each", "Repeat"];
const BLENDS: [(&str, Blend); 3] = [("Add", Blend::Add), ("Alpha", Blend::Alpha), ("Max", Blend::Max)];
const GEOMETRIES: [(&str, Geometry); 3] =
    [("All", Geometry::All), ("Still", Geometry::Still), ("Moving", Geometry::Moving)];

impl Reader<'_> {
    pub fn stages(&mut self, tree: &Tree) -> Option<Vec<Spanned<Stage>>> {
        self.list(tree, |reader, tree| {
            let stage = reader.stage(tree)?;
            Some(reader.spanned(stage, tree))
        })
    }

    fn stage(&mut self, tree: &Tree) -> Option<Stage> {
        match self.variant(tree, "a stage", &STAGES)? {
            "Compute" => self.compute(tree),
            "Raster" => self.raster(tree),
            "Part" => self.part_call(tree),
            "Each" => self.each(tree),
            _ => self.repeat(tree),
        }
    }

    fn call(&mut self, fields: &Fields<'_>) -> Option<Call> {
        let name = self.optional(fields.get("name"), Self::name);
        let kernel = self.required(fields, "kernel").and_then(|tree| self.text(tree));
        let when = self.optional(fields.get("when"), Self::expression);
        let bind = self.entries(fields.get("bind"), Self::text);
        let geometry = self.optional(fields.get("geometry"), |reader, tree| {
            reader.choice(tree, "a part of the scene", &GEOMETRIES)
        });
        let order_dependent = self.optional(fields.get("order_dependent"), Self::text);
        Some(Call {
            name: name?,
            kernel: kernel?,
            when: when?,
            bind: bind?,
            geometry: geometry?.unwrap_or_default(),
            order_dependent: order_dependent?.map(|reason| reason.value),
        })
    }

    fn compute(&mut self, tree: &Tree) -> Option<Stage> {
        let known = ["kernel", "name", "over", "geometry", "when", "bind", "order_dependent"];
        let fields = self.fields(tree, "a compute stage", &known)?;
        let call = self.call(&fields);
        let over = self.required(&fields, "over").and_then(|tree| {
            let extent = self.extent(tree)?;
            Some(self.spanned(extent, tree))
        });
        Some(Stage::Compute(Compute { call: call?, over: over? }))
    }

    fn extent(&mut self, tree: &Tree) -> Option<Extent> {
        let known = ["Texels", "Count", "Triangles", "Indirect"];
        Some(match self.variant(tree, "what a compute stage goes over", &known)? {
            "Texels" => Extent::Texels(self.only(tree, "`Texels(\"resource\")`", Self::text)?),
            "Count" => match &tree.node {
                Node::Tuple(_, items) if (1..=3).contains(&items.len()) => {
                    let counts: Vec<_> = items.iter().map(|item| self.expression(item)).collect();
                    Extent::Count(counts.into_iter().collect::<Option<_>>()?)
                }
                _ => return self.wrong(tree, "`Count` of one to three expressions"),
            },
            "Triangles" if matches!(tree.node, Node::Name) => Extent::Triangles,
            "Triangles" => return self.wrong(tree, "`Triangles` alone"),
            _ => {
                let (buffer, offset) = self.indirect(tree)?;
                Extent::Indirect { buffer, offset }
            }
        })
    }

    fn indirect(&mut self, tree: &Tree) -> Option<(Spanned<String>, Option<ExprText>)> {
        let fields = self.fields(tree, "`Indirect`", &["buffer", "offset"])?;
        let buffer = self.required(&fields, "buffer").and_then(|tree| self.text(tree));
        let offset = self.optional(fields.get("offset"), Self::expression);
        Some((buffer?, offset?))
    }

    fn raster(&mut self, tree: &Tree) -> Option<Stage> {
        let known =
            ["kernel", "name", "draw", "geometry", "depth", "blend", "when", "bind", "order_dependent"];
        let fields = self.fields(tree, "a raster stage", &known)?;
        let call = self.call(&fields);
        let draw = self.required(&fields, "draw").and_then(|tree| {
            let draw = self.draw(tree)?;
            Some(self.spanned(draw, tree))
        });
        let depth = self.optional(fields.get("depth"), Self::depth);
        let blend =
            self.optional(fields.get("blend"), |reader, tree| reader.choice(tree, "a way to blend", &BLENDS));
        Some(Stage::Raster(Raster { call: call?, draw: draw?, depth: depth?, blend: blend? }))
    }

    fn draw(&mut self, tree: &Tree) -> Option<Draw> {
        let known = ["Scene", "Screen", "Points", "Vertices", "Indirect"];
        let variant = self.variant(tree, "what a raster stage draws", &known)?;
        let alone = matches!(tree.node, Node::Name);
        Some(match variant {
            "Scene" if alone => Draw::Scene,
            "Screen" if alone => Draw::Screen,
            "Scene" | "Screen" => return self.wrong(tree, &format!("`{variant}` alone")),
            "Points" => Draw::Points(self.only(tree, "`Points(count)`", Self::expression)?),
            "Vertices" => Draw::Vertices(self.only(tree, "`Vertices(count)`", Self::expression)?),
            _ => {
                let (buffer, offset) = self.indirect(tree)?;
                Draw::Indirect { buffer, offset }
            }
        })
    }

    fn depth(&mut self, tree: &Tree) -> Option<Depth> {
        let fields = self.fields(tree, "a depth test", &["target", "compare", "write"])?;
        let target = self.required(&fields, "target").and_then(|tree| self.text(tree));
        let compare = self.required(&fields, "compare").and_then(|tree| self.compare(tree));
        let write = self.optional(fields.get("write"), Self::flag);
        Some(Depth { target: target?, compare: compare?, write: write?.unwrap_or(true) })
    }

    fn part_call(&mut self, tree: &Tree) -> Option<Stage> {
        let fields = self.fields(tree, "a call of a part", &["role", "name", "when", "bind"])?;
        let role = self.required(&fields, "role").and_then(|tree| self.name(tree));
        let name = self.optional(fields.get("name"), Self::name);
        let when = self.optional(fields.get("when"), Self::expression);
        let bind = self.entries(fields.get("bind"), Self::text);
        Some(Stage::Part { role: role?, name: name?, when: when?, bind: bind? })
    }

    fn each(&mut self, tree: &Tree) -> Option<Stage> {
        let fields = self.fields(tree, "`Each`", &["name", "over", "when", "stages"])?;
        let name = self.required(&fields, "name").and_then(|tree| self.name(tree));
        let over = self.required(&fields, "over").and_then(|tree| {
            let over = self.over(tree)?;
            Some(self.spanned(over, tree))
        });
        let when = self.optional(fields.get("when"), Self::expression);
        let stages = self.required(&fields, "stages").and_then(|tree| self.stages(tree));
        Some(Stage::Each { name: name?, over: over?, when: when?, stages: stages? })
    }

    fn over(&mut self, tree: &Tree) -> Option<Over> {
        let known = ["Range", "Lights", "Views", "Mips"];
        Some(match self.variant(tree, "what `Each` goes over", &known)? {
            "Range" => match &tree.node {
                Node::Tuple(_, items) if items.len() == 2 => {
                    let (from, to) = (self.expression(&items[0]), self.expression(&items[1]));
                    Over::Range(from?, to?)
                }
                _ => return self.wrong(tree, "`Range(from, to)`"),
            },
            "Lights" => Over::Lights(self.only(tree, "`Lights(\"kind\")`", Self::light_kind)?),
            "Views" if matches!(tree.node, Node::Name) => Over::Views,
            "Views" => return self.wrong(tree, "`Views` alone"),
            _ => Over::Mips(self.only(tree, "`Mips(\"resource\")`", Self::text)?),
        })
    }

    fn light_kind(&mut self, tree: &Tree) -> Option<Spanned<String>> {
        const KINDS: [&str; 4] = ["point", "spot", "directional", "all"];
        let kind = self.text(tree)?;
        if KINDS.contains(&kind.value.as_str()) {
            return Some(kind);
        }
        self.unknown_variant(&kind.value, &kind.place.span, "a kind of light", &KINDS)
    }

    fn repeat(&mut self, tree: &Tree) -> Option<Stage> {
        let fields = self.fields(tree, "`Repeat`", &["times", "swap", "when", "stages"])?;
        let times = self.required(&fields, "times").and_then(|tree| self.expression(tree));
        let swap = self.optional(fields.get("swap"), |reader, tree| reader.list(tree, Self::pair));
        let when = self.optional(fields.get("when"), Self::expression);
        let stages = self.required(&fields, "stages").and_then(|tree| self.stages(tree));
        Some(Stage::Repeat { times: times?, swap: swap?.unwrap_or_default(), when: when?, stages: stages? })
    }

    fn pair(&mut self, tree: &Tree) -> Option<(Spanned<String>, Spanned<String>)> {
        let Node::Tuple(None, items) = &tree.node else {
            return self.wrong(tree, "a pair, `(\"a\", \"b\")`");
        };
        let [a, b] = items.as_slice() else { return self.wrong(tree, "a pair, `(\"a\", \"b\")`") };
        let (a, b) = (self.name(a), self.name(b));
        let (a, b) = (a?, b?);
        if a.value == b.value {
            let problem =
                Problem::input("swap-with-itself", format!("`{}` can't change names with itself", a.value));
            self.problems.push(problem.at(&b.place, "the same").at(&a.place, "as this"));
            return None;
        }
        Some((a, b))
    }

    /// The only item of `Name(item)`.
    fn only<T>(
        &mut self,
        tree: &Tree,
        wanted: &str,
        read: impl FnOnce(&mut Self, &Tree) -> Option<T>,
    ) -> Option<T> {
        match &tree.node {
            Node::Tuple(_, items) if items.len() == 1 => read(self, &items[0]),
            _ => self.wrong(tree, wanted),
        }
    }
}
