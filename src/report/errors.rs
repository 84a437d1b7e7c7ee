//! Tables of errors.

use super::analysis::error;
use super::format::{UNKNOWN, maybe, number};
use super::measures::{Best, MEASURES, Measure};
use super::view::{RunView, SceneView, View};
use maud::{Markup, html};
use std::collections::{BTreeMap, BTreeSet};

pub fn section(view: &View, scene: &SceneView) -> Markup {
    html! {
        section class="errors" {
            h3 { "Errors" }
            @for output in &view.outputs {
                div data-output=(output) hidden[*output != view.output] { (self::output(scene, output)) }
            }
        }
    }
}

fn output(scene: &SceneView, output: &str) -> Markup {
    let errors = |run: &RunView| run.run.errors.get(output).cloned();
    let measured: Vec<(&RunView, BTreeMap<String, f64>)> =
        scene.runs.iter().filter_map(|run| Some((run, errors(run)?))).collect();
    if measured.is_empty() {
        return html! { p class="quiet" { "No run has an error of " (output) "." } };
    }
    let measures = measures(measured.iter().map(|(_, errors)| errors));
    let masks: BTreeSet<&String> = measured.iter().flat_map(|(run, _)| run.run.masked.keys()).collect();
    let all: Vec<&RunView> = measured.iter().map(|(run, _)| *run).collect();
    html! {
        div class="wide-table" tabindex="0" role="region" aria-label={ "Errors of " (output) } {
            table class="sortable" {
                caption { (output) ", all pixels; best in bold" }
                thead { tr {
                    th scope="col" { "run" }
                    th scope="col" class="n" { "GPU ms" }
                    @for measure in &measures { th scope="col" class="n" { (measure.title) } }
                    th scope="col" { "noise" }
                } }
                tbody {
                    @for run in &all {
                        tr {
                            (name(run))
                            (cell(run.run.gpu_ms.median, false))
                            @for measure in &measures {
                                @let value = error(run.run, output, measure.key);
                                @let values = all.iter().map(|run| error(run.run, output, measure.key));
                                (cell(value, is_best(measure, value, values)))
                            }
                            td class="verdict" { (verdict(run, output)) }
                        }
                    }
                }
            }
        }
        @if !masks.is_empty() { (masked(&all, output, &measures, &masks)) }
    }
}

/// The same over parts of the picture.
fn masked(runs: &[&RunView], output: &str, measures: &[&Measure], masks: &BTreeSet<&String>) -> Markup {
    let value = |run: &RunView, mask: &str, key: &str| -> Option<f64> {
        run.run.masked.get(mask)?.get(output)?.get(key).copied().filter(|value| value.is_finite())
    };
    html! {
        details {
            summary {
                "The same over parts of the picture"
                @for (at, mask) in masks.iter().enumerate() { @if at == 0 { ": " } @else { ", " } (mask) }
            }
            div class="wide-table" tabindex="0" role="region" aria-label={ "Errors of " (output) " over masks" } {
                table class="sortable" {
                    caption { (output) " by mask; best of each mask in bold" }
                    thead { tr {
                        th scope="col" { "run" }
                        th scope="col" { "pixels" }
                        @for measure in measures { th scope="col" class="n" { (measure.title) } }
                    } }
                    tbody {
                        @for mask in masks {
                            @for run in runs {
                                tr {
                                    (name(run))
                                    td { (mask) }
                                    @for measure in measures {
                                        @let own = value(run, mask, measure.key);
                                        @let all = runs.iter().map(|run| value(run, mask, measure.key));
                                        (cell(own, is_best(measure, own, all)))
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

pub fn name(run: &RunView) -> Markup {
    html! {
        th scope="row" data-value=(run.number) {
            b { (run.number) } " " a href={ "#" (run.anchor()) } { (run.run.name) }
        }
    }
}

/// A number, which sorts by its full value.
pub fn cell(value: Option<f64>, best: bool) -> Markup {
    html! {
        td class="n" data-value=[value.filter(|value| value.is_finite())] {
            @if best { strong { (maybe(value)) } } @else { (maybe(value)) }
        }
    }
}

/// Those that any run has, in the report's order.
fn measures<'a>(errors: impl Iterator<Item = &'a BTreeMap<String, f64>> + Clone) -> Vec<&'static Measure> {
    let known = |measure: &&Measure| errors.clone().any(|errors| errors.contains_key(measure.key));
    MEASURES.iter().filter(known).collect()
}

/// Whether `value` is the best of several.
fn is_best(measure: &Measure, value: Option<f64>, all: impl Iterator<Item = Option<f64>>) -> bool {
    let losses: Vec<f64> = all.flatten().map(|value| measure.loss(value)).collect();
    let least = losses.iter().copied().min_by(f64::total_cmp);
    losses.len() > 1 && least.is_some() && value.map(|value| measure.loss(value)) == least
}

fn verdict(run: &RunView, output: &str) -> String {
    let noise = run.reference.and_then(|reference| reference.noise.get(output));
    match (run.within_noise(output), noise, error(run.run, output, "relmse")) {
        (true, _, _) => "within the reference's noise".to_owned(),
        (false, Some(noise), Some(error)) if *noise > 0.0 => format!("{} × the noise", number(error / noise)),
        _ => UNKNOWN.to_owned(),
    }
}

/// Which value of a measure is the better one, in words.
pub fn better(measure: &Measure) -> &'static str {
    match measure.best {
        Best::Least => "least is best",
        Best::Most => "most is best",
        Best::One => "1 is best",
    }
}
