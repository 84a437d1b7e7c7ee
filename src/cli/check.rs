//! `voxgi check`: everything that can be known without rendering.

use super::picture_graph::{dot, svg};
use super::{PipelineArgs, print, print_json, tell};
use crate::device;
use crate::graph;
use crate::picture;
use crate::plan::PlannedResource;
use crate::problem::{Problem, Problems, Result};
use crate::record;
use crate::scene::Scene;
use crate::schedule::{Fate, Placement, Step};
use crate::session::{Prepared, bytes, prepare};
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Args)]
pub struct CheckArgs {
    /// Pipelines: names, or paths of .ron files. Default: all of the library.
    pipelines: Vec<String>,
    /// Decide what depends on a scene for this one.
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    pipeline_args: PipelineArgs,
    /// Hold sizes and numbers of bindings against limits: `webgpu` (guaranteed everywhere), `adapter`, or a JSON file.
    #[arg(long, value_name = "LIMITS")]
    limits: Option<String>,
    /// Write the graph in Graphviz's language.
    #[arg(long, value_name = "FILE")]
    dot: Option<PathBuf>,
    /// Write the graph as a picture.
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &CheckArgs) -> Result<()> {
    let library = args.pipeline_args.library()?;
    let scene = args.scene.as_ref().map(|path| args.pipeline_args.scene(path)).transpose()?;
    let names = match args.pipelines.is_empty() {
        true => library.list(crate::library::Shelf::Pipelines),
        false => args.pipelines.clone(),
    };
    if names.len() != 1 && (args.dot.is_some() || args.svg.is_some()) {
        return Err(Problem::input("one-pipeline", "`--dot` and `--svg` draw one pipeline; name it").into());
    }
    let limits = args.limits.as_deref().map(read_limits).transpose()?;
    let (mut problems, mut reports) = (Vec::new(), Vec::new());
    for name in &names {
        let request = match &scene {
            Some(scene) => args.pipeline_args.request_for(name, scene),
            None => args.pipeline_args.request(name),
        };
        match prepare(&request, &library, scene.as_ref()) {
            Err(found) => problems.extend(found.iter().cloned()),
            Ok(prepared) => {
                prepared.warnings.iter().for_each(tell);
                if let Some((limits, whose)) = &limits {
                    problems.extend(graph::check::limits(&prepared.graph, limits, whose));
                }
                if let Some(path) = &args.dot {
                    picture::write_bytes(path, dot(&prepared.graph, &prepared.schedule).as_bytes())?;
                }
                if let Some(path) = &args.svg {
                    let drawn = svg(&dot(&prepared.graph, &prepared.schedule))?;
                    picture::write_bytes(path, drawn.as_bytes())?;
                }
                reports.push((name, prepared));
            }
        }
    }
    Problems::check(problems)?;
    if args.json {
        let list: Vec<_> =
            reports.iter().map(|(name, prepared)| json(name, prepared, scene.as_ref())).collect();
        print_json(&serde_json::json!({ "schema": crate::record::SCHEMA, "pipelines": list }));
    } else {
        reports.iter().for_each(|(name, prepared)| print(&text(name, prepared, scene.as_ref())));
    }
    Ok(())
}

/// Limits and whose they are.
fn read_limits(from: &str) -> Result<(wgpu_types::Limits, String)> {
    match from {
        "webgpu" => Ok((wgpu_types::Limits::default(), "WebGPU".to_owned())),
        "adapter" => {
            let adapter = device::adapters().into_iter().next().ok_or_else(device::no_adapter)?;
            Ok((adapter.limits(), format!("the adapter `{}`", adapter.get_info().name)))
        }
        file => {
            let wrong = |why: String| Problem::input("limits", format!("`{file}` gives no limits: {why}"));
            let text = std::fs::read_to_string(file).map_err(|e| {
                wrong(e.to_string()).help("`--limits` takes `webgpu`, `adapter` or a JSON file")
            })?;
            let limits = serde_json::from_str(&text).map_err(|e| {
                wrong(e.to_string()).help("`voxgi devices --json` shows limits as they are to be written")
            })?;
            Ok((limits, format!("`{file}`")))
        }
    }
}

/// `run`, `kept`, `dropped` or `open` (without a scene), and why.
fn status(prepared: &Prepared, stage: usize) -> (&'static str, Option<String>) {
    match (&prepared.schedule.fates[stage], graph::work::undecided(&prepared.graph, stage)) {
        (Fate::Dropped(reason), _) => ("dropped", Some(reason.clone())),
        (Fate::Run { .. }, Some(condition)) => ("open", Some(format!("depends on the scene: {condition}"))),
        (Fate::Run { step }, None) => {
            // Only with `--change` are there steps that nothing makes run again.
            let kept = prepared.schedule.steps.get(*step).is_some_and(|step| step.reruns().is_empty());
            let names: Vec<_> = prepared.depends[stage]
                .iter()
                .map(|b| graph::facts::name_of_bit(&prepared.graph.plan, *b))
                .collect();
            let again = if names.is_empty() {
                "once".to_owned()
            } else {
                format!("when this changes: {}", names.join(", "))
            };
            if kept { ("kept", Some("after the first frame".to_owned())) } else { ("run", Some(again)) }
        }
    }
}

fn place(placement: &Placement) -> String {
    match placement {
        Placement::Heap { heap, offset } => format!("heap {heap} at {offset}"),
        Placement::Object { pool, object } => format!("texture {object} of kind {pool}"),
        Placement::Alone => "its own".to_owned(),
        Placement::Unmade => "not made".to_owned(),
        Placement::Given => "the scene's".to_owned(),
    }
}

/// What is or, without a scene, can be lacking.
fn lacks(prepared: &Prepared, scene: Option<&Scene>) -> Vec<String> {
    match scene {
        Some(scene) => record::lacks(scene, &prepared.graph),
        None => {
            let lacks = prepared.graph.plan.lacks.iter();
            lacks
                .map(|lack| match &lack.unknown {
                    Some(when) => format!("{} (if {when})", lack.what),
                    None => lack.what.clone(),
                })
                .collect()
        }
    }
}

/// Bytes of a resource; `None` if not known without a scene.
fn taken(planned: &PlannedResource, made: &graph::Resource, scene: Option<&Scene>) -> Option<u64> {
    match made.shape {
        graph::Shape::Scene => Some(scene?.bytes(&planned.path)?.len() as u64),
        _ => made.bytes,
    }
}

/// Whether some resource's size is not known without a scene.
fn open(graph: &graph::Graph) -> bool {
    let own = graph
        .resources
        .iter()
        .filter(|r| matches!(r.shape, graph::Shape::Buffer(_) | graph::Shape::Texture(_)));
    own.into_iter().any(|resource| resource.bytes.is_none())
}

fn text(name: &str, prepared: &Prepared, scene: Option<&Scene>) -> String {
    let (graph, schedule) = (&prepared.graph, &prepared.schedule);
    let mut text = format!("{name}: {}\n", graph.plan.about);
    let width = graph.stages.iter().map(|s| s.path.len()).max().unwrap_or(0);
    for (index, stage) in graph.stages.iter().enumerate() {
        let (status, reason) = status(prepared, index);
        let _infallible =
            writeln!(text, "  {:<width$}  {status:<8}{}", stage.path, reason.unwrap_or_default());
    }
    let width = graph.plan.resources.iter().map(|r| r.path.len()).max().unwrap_or(0);
    let _infallible = writeln!(text, "  {:<width$}  {:>11}  {:>9}  memory", "resource", "size", "steps");
    for ((planned, made), at) in graph.plan.resources.iter().zip(&graph.resources).zip(&schedule.places) {
        let Some(life) = at.life else { continue };
        let kept = if at.retained { ", kept for later frames" } else { "" };
        let _infallible = writeln!(
            text,
            "  {:<width$}  {:>11}  {:>9}  {}{kept}",
            planned.path,
            taken(planned, made, scene).map_or_else(|| "open".to_owned(), bytes),
            format!("{}-{}", life.first, life.last),
            place(&at.placement)
        );
    }
    let memory = &schedule.memory;
    let _infallible = writeln!(
        text,
        "  memory: {}{} (without reuse {}, least possible {}), kept for later frames {}",
        bytes(memory.peak_bytes),
        if open(graph) { ", and what depends on the scene" } else { "" },
        bytes(memory.without_reuse_bytes),
        bytes(memory.lower_bound_bytes),
        bytes(memory.kept_bytes)
    );
    for lack in lacks(prepared, scene) {
        let _infallible = writeln!(text, "  left out: {lack}");
    }
    text.push('\n');
    text
}

fn json(name: &str, prepared: &Prepared, scene: Option<&Scene>) -> serde_json::Value {
    let (graph, schedule) = (&prepared.graph, &prepared.schedule);
    let stages: Vec<_> = graph
        .stages
        .iter()
        .enumerate()
        .map(|(index, stage)| {
            let (status, reason) = status(prepared, index);
            let depends: Vec<_> =
                prepared.depends[index].iter().map(|b| graph::facts::name_of_bit(&graph.plan, *b)).collect();
            serde_json::json!({ "path": stage.path, "status": status, "reason": reason, "depends": depends })
        })
        .collect();
    let resources: Vec<_> = graph
        .plan
        .resources
        .iter()
        .zip(&graph.resources)
        .zip(&schedule.places)
        .map(|((planned, made), at)| {
            serde_json::json!({
                "path": planned.path, "bytes": taken(planned, made, scene), "memory": place(&at.placement), "kept": at.retained,
                "first_step": at.life.map(|l| l.first), "last_step": at.life.map(|l| l.last),
            })
        })
        .collect();
    let order: Vec<_> = schedule
        .steps
        .iter()
        .filter_map(|step| match step {
            Step::Run { task, .. } => Some(graph.stages[*task].path.as_str()),
            Step::Start { .. } => None,
        })
        .collect();
    serde_json::json!({
        "pipeline": name, "about": graph.plan.about, "stages": stages, "order": order, "resources": resources,
        "memory": {
            "peak_bytes": schedule.memory.peak_bytes, "without_reuse_bytes": schedule.memory.without_reuse_bytes,
            "kept_bytes": schedule.memory.kept_bytes, "lower_bound_bytes": schedule.memory.lower_bound_bytes,
        },
        "lacks": lacks(prepared, scene),
        "warnings": prepared.warnings.iter().map(Problem::to_json).collect::<Vec<_>>(),
    })
}
