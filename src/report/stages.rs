//! Time per stage as stacked bars, what became of each stage, what is lacking, and memory.

use super::axis::Axis;
use super::errors::{cell, name};
use super::format::{UNKNOWN, bytes, maybe, milliseconds};
use super::ink::Ink;
use super::plot::{plot, width};
use super::view::{RunView, SceneView};
use crate::comparison::StageTime;
use crate::problem::Result;
use maud::{Markup, html};
use plotters::style::text_anchor::{HPos, VPos};
use std::collections::BTreeMap;

/// Stages with a colour of their own.
const LARGEST: usize = super::ink::SERIES;
const SIZES: [(&str, u32); 2] = [("wide", 860), ("narrow", 343)];
/// Height of a run's bar with the gap below it, and of what is above and below all bars.
const BAR: u32 = 30;
const FRAME: u32 = 56;

/// Time by the name of a stage, its instances of loops in one.
type Times = BTreeMap<String, f64>;

pub fn section(scene: &SceneView) -> Result<Markup> {
    let times: Vec<(RunView, Times)> =
        scene.runs.iter().map(|run| (*run, self::times(&run.run.stages))).collect();
    let names = largest(&times);
    let mut charts = Vec::new();
    for (class, width) in SIZES {
        charts.push((class, bars(&times, &names, width)?));
    }
    let rest = times.iter().any(|(_, times)| times.keys().any(|name| !names.contains(name)));
    Ok(html! {
        section class="stages" {
            h3 { "Time per stage" }
            @if names.is_empty() {
                p class="quiet" { "No stage has a time." }
            } @else {
                figure {
                    @for (class, chart) in &charts { div class={ "chart " (class) } { (chart) } }
                    figcaption {
                        ul class="key stack-key" {
                            @for (at, name) in names.iter().enumerate() {
                                li { (chip(Ink::Series(at), &letter(at))) " " (name) }
                            }
                            @if rest { li { (chip(Ink::Rest, "")) " other stages" } }
                        }
                    }
                }
            }
            @for run in &scene.runs { (table(run)) }
            (lacks(scene))
            (memory(scene))
        }
    })
}

fn chip(ink: Ink, text: &str) -> Markup {
    let upon = if let Ink::Series(at) = ink { Ink::Upon(at) } else { Ink::Upon(1) };
    html! { span class="chip" style={ "background:" (ink.property()) ";color:" (upon.property()) } { (text) } }
}

/// Of the stage in the chart: colours alone say too little.
fn letter(at: usize) -> String {
    ('A'..='Z').nth(at).map(String::from).unwrap_or_default()
}

/// `light/gather[3]` and `light/gather[4]` are one: indices of loops are left out.
fn without_indices(path: &str) -> String {
    let mut depth = 0;
    let mut name = String::new();
    for c in path.chars() {
        match c {
            '[' => depth += 1,
            ']' if depth > 0 => depth -= 1,
            c if depth == 0 => name.push(c),
            _ => {}
        }
    }
    name
}

fn times(stages: &[StageTime]) -> Times {
    let mut times = Times::new();
    for stage in stages {
        // A stage that is kept takes nothing in a frame, though it took something once.
        let ran = stage.status == "run";
        if let Some(ms) = stage.gpu_ms.filter(|ms| ran && ms.is_finite() && *ms > 0.0) {
            *times.entry(without_indices(&stage.path)).or_insert(0.0) += ms;
        }
    }
    times
}

/// The stages that take most in sum over all runs.
fn largest(times: &[(RunView, Times)]) -> Vec<String> {
    let mut sums = Times::new();
    for (name, ms) in times.iter().flat_map(|(_, times)| times) {
        *sums.entry(name.clone()).or_insert(0.0) += ms;
    }
    let mut sorted: Vec<(String, f64)> = sums.into_iter().collect();
    sorted.sort_by(|a, b| b.1.total_cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    sorted.into_iter().take(LARGEST).map(|(name, _)| name).collect()
}

fn bars(times: &[(RunView, Times)], names: &[String], across: u32) -> Result<Markup> {
    let rows = u32::try_from(times.len()).unwrap_or(u32::MAX / BAR / 2);
    let size = [across, rows * BAR + FRAME];
    let total = |times: &Times| times.values().sum::<f64>();
    let x =
        Axis::from_zero("ms, sum of the medians of the stages", times.iter().map(|(_, times)| total(times)));
    // The first run on top.
    let y = Axis::names("", times.iter().rev().map(|(run, _)| run.number.to_string()).collect());
    let label =
        format!("Time per stage of {} runs as stacked bars; tables below have the numbers", times.len());
    plot(size, &label, |plot| {
        let frame = plot.axes(&x, &y, 40)?;
        for (row, (_, times)) in times.iter().rev().enumerate() {
            let mut sum = 0.0;
            let own = names.iter().enumerate().filter_map(|(at, name)| Some((Some(at), *times.get(name)?)));
            let rest: f64 = times.iter().filter(|(name, _)| !names.contains(name)).map(|(_, ms)| ms).sum();
            for (at, ms) in own.chain([(None, rest)]) {
                let (left, middle) = frame.at(sum, row as f64);
                sum += ms;
                let (right, _) = frame.at(sum, row as f64);
                // A line of paper between two pieces.
                let right_edge = if right - left > 3 { right - 1 } else { right };
                let corners = [(left, middle - 10), (right_edge, middle + 10)];
                plot.rectangle(corners, at.map_or(Ink::Rest, Ink::Series))?;
                if let Some(at) = at.filter(|at| right - left > width(&letter(*at)) + 6) {
                    let center = ((left + right) / 2, middle);
                    plot.text(&letter(at), center, Ink::Upon(at), (HPos::Center, VPos::Center))?;
                }
            }
        }
        Ok(())
    })
}

fn table(run: &RunView) -> Markup {
    let stages = &run.run.stages;
    let counted = |status: &str| stages.iter().filter(|stage| stage.status == status).count();
    html! {
        details {
            summary {
                b { (run.number) } " " (run.run.name) ": " (counted("run")) " stages run, " (counted("kept")) " kept, "
                (counted("dropped")) " dropped"
            }
            div class="wide-table" tabindex="0" role="region" aria-label={ "Stages of " (run.run.name) } {
                table class="sortable" {
                    caption {
                        "Frame " (milliseconds(run.run.gpu_ms.median)) "; first use "
                        (milliseconds(run.run.first_use_ms)) "; encode " (milliseconds(run.run.encode_ms)) " of CPU"
                    }
                    thead { tr {
                        th scope="col" { "stage" }
                        th scope="col" class="n" { "ms" }
                        th scope="col" class="n" { "p10" }
                        th scope="col" class="n" { "p90" }
                        th scope="col" { "fate" }
                        th scope="col" { "why" }
                    } }
                    tbody {
                        @for stage in stages {
                            tr {
                                th scope="row" { (stage.path) }
                                (cell(stage.gpu_ms, false))
                                (cell(stage.spread.p10, false))
                                (cell(stage.spread.p90, false))
                                td { (stage.status) }
                                td { (stage.reason.as_deref().unwrap_or("")) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// What the scene calls for: by the loader for all runs, by each pipeline for its own.
fn lacks(scene: &SceneView) -> Markup {
    let own = |run: &RunView| -> Vec<String> {
        run.run.lacks.iter().filter(|lack| !scene.entry.lacks.contains(lack)).cloned().collect()
    };
    let mut alike: Vec<(Vec<String>, Vec<usize>)> = Vec::new();
    for run in &scene.runs {
        let lacks = own(run);
        match alike.iter_mut().find(|(known, _)| *known == lacks) {
            Some((_, runs)) => runs.push(run.number),
            None if lacks.is_empty() => {}
            None => alike.push((lacks, vec![run.number])),
        }
    }
    let runs = |numbers: &[usize]| numbers.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    html! {
        h4 { "What the scene calls for and is not done" }
        @if scene.entry.lacks.is_empty() && alike.is_empty() { p { "Nothing is lacking." } }
        ul {
            @for lack in &scene.entry.lacks { li { (lack) " (in all runs)" } }
            @for (lacks, numbers) in &alike {
                @for lack in lacks { li { (lack) " (in " (runs(numbers)) ")" } }
            }
        }
    }
}

fn memory(scene: &SceneView) -> Markup {
    html! {
        details {
            summary { "Memory" }
            div class="wide-table" tabindex="0" role="region" aria-label="Memory" {
                table class="sortable" {
                    caption { "Resources of the pipeline at once, kept ones included" }
                    thead { tr {
                        th scope="col" { "run" }
                        th scope="col" class="n" { "peak" }
                        th scope="col" class="n" { "first use, ms" }
                    } }
                    tbody {
                        @for run in &scene.runs {
                            tr {
                                (name(run))
                                @let peak = run.run.memory.peak_bytes;
                                td class="n" data-value=(peak) { @if peak == 0 { (UNKNOWN) } @else { (bytes(peak)) } }
                                td class="n" data-value=[run.run.first_use_ms] { (maybe(run.run.first_use_ms)) }
                            }
                        }
                    }
                }
            }
        }
    }
}
