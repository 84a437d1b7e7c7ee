//! The graph as a picture: stages as boxes, resources as ovals, what is dropped in dashes.

use crate::graph::Graph;
use crate::problem::{Problem, Result};
use crate::schedule::{Fate, Schedule};
use std::fmt::Write;

/// The graph in Graphviz's language.
pub fn dot(graph: &Graph, schedule: &Schedule) -> String {
    let mut dot = String::from("digraph pipeline {\n  rankdir = TB;\n");
    let mut used = vec![false; graph.resources.len()];
    let mut edges = String::new();
    for (index, stage) in graph.stages.iter().enumerate() {
        let style = if matches!(schedule.fates[index], Fate::Run { .. }) { "solid" } else { "dashed" };
        let _infallible =
            writeln!(dot, "  s{index} [shape=box, style={style}, label=\"{}\"];", escape(&stage.path));
        for touch in stage.linked.iter().flat_map(|l| &l.touches) {
            let id = touch.reference.resource;
            used[id] = true;
            let part = graph.name(&touch.reference);
            let part = part.strip_prefix(&graph.plan.resources[id].path).unwrap_or_default();
            if touch.read {
                let _infallible = writeln!(edges, "  r{id} -> s{index} [label=\"{}\"];", escape(part));
            }
            if touch.write {
                let _infallible = writeln!(edges, "  s{index} -> r{id} [label=\"{}\"];", escape(part));
            }
        }
    }
    for (id, planned) in graph.plan.resources.iter().enumerate().filter(|(id, _)| used[*id]) {
        let _infallible = writeln!(dot, "  r{id} [shape=ellipse, label=\"{}\"];", escape(&planned.path));
    }
    for (index, (name, reference, _)) in graph.plan.outputs.iter().enumerate() {
        let _infallible =
            writeln!(dot, "  o{index} [shape=box, style=bold, label=\"output {}\"];", escape(name));
        let _infallible = writeln!(dot, "  r{} -> o{index} [label=\"\"];", reference.resource);
    }
    dot + &edges + "}\n"
}

fn escape(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"")
}

/// The same, drawn.
pub fn svg(dot: &str) -> Result<String> {
    let failed = |why: String| Problem::failure("svg", format!("the graph can't be drawn: {why}"));
    let graph = layout::gv::DotParser::new(dot).process().map_err(failed)?;
    let mut builder = layout::gv::GraphBuilder::new();
    builder.visit_graph(&graph);
    let mut visual = builder.get();
    let mut writer = layout::backends::svg::SVGWriter::new();
    visual.do_it(false, false, false, &mut writer);
    Ok(writer.finalize())
}
