//! The page's head: what was run, on what, and against which references.

use super::format::{UNKNOWN, count, maybe, number, plural};
use super::measures::MEASURES;
use super::pictures::link;
use super::view::{SceneView, View};
use crate::comparison::FILE;
use maud::{Markup, html};
use std::collections::BTreeMap;

pub fn head(view: &View) -> Markup {
    let comparison = view.comparison;
    let adapter = &comparison.adapter;
    let mut clocks: BTreeMap<(&str, Option<&str>), usize> = BTreeMap::new();
    for run in &comparison.runs {
        *clocks.entry((&run.clock, run.clock_reason.as_deref())).or_default() += 1;
    }
    let [width, height] = comparison.size;
    html! {
        header {
            p class="quiet" {
                "voxgi " (comparison.version) ", " (comparison.command) ", "
                time datetime=(comparison.date) { (comparison.date) }
            }
            h1 { (comparison.name) }
            dl class="facts" {
                div {
                    dt { "What" }
                    dd {
                        (plural(comparison.runs.len(), "run", "runs")) " on "
                        (plural(comparison.scenes.len(), "scene", "scenes")) ", " (width) " × " (height) " pixels"
                    }
                }
                div { dt { "Adapter" } dd { (adapter.name) " (" (adapter.kind) ", " (adapter.backend) ")" } }
                div { dt { "Driver" } dd { (adapter.driver) " " (adapter.driver_info) } }
                div {
                    dt { "Clock" }
                    dd {
                        @for ((clock, reason), runs) in &clocks {
                            p {
                                (clock)
                                @if clocks.len() > 1 { " (" (plural(*runs, "run", "runs")) ")" }
                                @if let Some(reason) = reason { ": " (reason) }
                            }
                        }
                    }
                }
                div {
                    dt { "Pictures" }
                    dd { "exposure " (exposure(comparison.exposure)) ", tone curve " (comparison.curve) }
                }
                div { dt { "Numbers" } dd { a href=(link(FILE)) { (FILE) } ", with all samples" } }
            }
            div class="wide-table" tabindex="0" role="region" aria-label="Scenes and references" {
                table {
                    caption { "Scenes and what runs are held against" }
                    thead { tr {
                        th scope="col" { "scene" }
                        th scope="col" { "camera" }
                        th scope="col" class="n" { "triangles" }
                        th scope="col" { "reference" }
                        th scope="col" class="n" { "samples" }
                        th scope="col" class="n" { "noise of " (view.output) ", relMSE" }
                        th scope="col" class="n" { "seconds" }
                    } }
                    tbody { @for scene in &view.scenes { (references(view, scene)) } }
                }
            }
        }
    }
}

fn exposure(stops: f32) -> String {
    if stops == 0.0 { "0 stops".to_owned() } else { format!("{stops:+} stops") }
}

fn references(view: &View, scene: &SceneView) -> Markup {
    let entry = scene.entry;
    html! {
        @for (name, reference) in &entry.references {
            tr {
                th scope="row" {
                    a href={ "#" (scene.anchor()) } { (entry.name) } br;
                    span class="quiet" { (entry.file) }
                }
                td { (entry.camera) }
                td class="n" { (count(entry.triangles as u64)) }
                td { (name) ": " (reference.pipeline) }
                td class="n" {
                    (count(reference.samples))
                    @if reference.cached_samples > 0 {
                        br; span class="quiet" { (count(reference.cached_samples)) " cached" }
                    }
                }
                td class="n" { (maybe(reference.noise.get(&view.output).copied())) }
                td class="n" { (number(reference.seconds)) }
            }
        }
        @if entry.references.is_empty() {
            tr {
                th scope="row" { a href={ "#" (scene.anchor()) } { (entry.name) } }
                td { (entry.camera) }
                td class="n" { (count(entry.triangles as u64)) }
                td { "none" }
                @for _ in 0..3 { td class="n" { (UNKNOWN) } }
            }
        }
    }
}

/// What the page shows of all scenes: without scripts there is nothing to choose.
pub fn choice(view: &View) -> Markup {
    html! {
        form class="scripted choice" aria-label="What is shown" {
            label {
                "Output "
                select data-choose="output" {
                    @for output in &view.outputs {
                        option value=(output) selected[*output == view.output] { (output) }
                    }
                }
            }
            " "
            label {
                "Measure "
                select data-choose="measure" {
                    @for measure in MEASURES.iter().filter(|measure| view.has(measure)) {
                        option value=(measure.key) selected[measure.key == view.measure.key] { (measure.title) }
                    }
                }
            }
        }
    }
}
