//! Each run's pictures against the reference's, with a slider, and maps of where they differ.

use super::analysis::coordinate;
use super::files::Files;
use super::format::{milliseconds, number};
use super::measures::MEASURES;
use super::view::{RunView, SceneView, View};
use crate::comparison::Run;
use crate::problem::Result;
use maud::{Markup, PreEscaped, html};

pub fn section(view: &View, scene: &SceneView, files: &Files) -> Result<Markup> {
    let mut styles = String::new();
    for (number, (name, reference)) in scene.entry.references.iter().enumerate() {
        let used: Vec<&RunView> = scene.runs.iter().filter(|run| run.run.reference == *name).collect();
        for (at, output) in view.outputs.iter().enumerate() {
            let needed = used.iter().any(|run| run.run.pictures.contains_key(output));
            if let (true, Some(pictures)) = (needed, reference.pictures.get(output)) {
                let whose =
                    format!("output `{output}` of reference `{name}` of scene `{}`", scene.entry.name);
                let uri = files.embed(&pictures.png, &whose)?;
                styles += &format!(".{}{{background-image:url({uri})}}\n", class(scene, number, at));
            }
        }
    }
    let mut runs = Vec::new();
    for run in &scene.runs {
        runs.push(self::run(view, scene, run, files)?);
    }
    Ok(html! {
        section class="pictures" {
            h3 { "Pictures" }
            // Each reference is in the page once, for all runs that stand beside it.
            style { (PreEscaped(styles)) }
            p class="scripted" {
                label {
                    "Run "
                    select data-choose="run" data-scene=(scene.anchor()) {
                        @for run in &scene.runs {
                            option value=(run.anchor()) { (run.number) " " (run.run.name) }
                        }
                    }
                }
            }
            @for run in &runs { (run) }
        }
    })
}

/// Of the reference's picture.
fn class(scene: &SceneView, reference: usize, output: usize) -> String {
    format!("truth-{}-{}-{}", scene.index, reference, output)
}

fn run(view: &View, scene: &SceneView, run: &RunView, files: &Files) -> Result<Markup> {
    let mut figures = Vec::new();
    for (at, output) in view.outputs.iter().enumerate() {
        let shown = *output == view.output;
        figures.push(match pictures(scene, run, (at, output), files)? {
            Some(figure) => html! { div data-output=(output) hidden[!shown] { (figure) } },
            None => html! {
                p data-output=(output) hidden[!shown] class="quiet" { "This run has no " (output) "." }
            },
        });
    }
    Ok(html! {
        article class="run" id=(run.anchor()) data-scene=(scene.anchor()) tabindex="-1" {
            h4 { (run.number) " " (run.run.name) }
            p class="quiet" {
                (milliseconds(run.run.gpu_ms.median)) " a frame by " (run.run.clock)
                @if let Some(reason) = &run.run.clock_reason { " (" (reason) ")" }
                ", against reference " (run.run.reference)
            }
            @for figure in &figures { (figure) }
            (settings(run.run))
        }
    })
}

/// Parts and knobs, those that were set in bold.
fn settings(run: &Run) -> Markup {
    let entry = |name: &str, value: &str| {
        let text = html! { (name) "=" (value) };
        html! { li { @if run.set.contains_key(name) { b { (text) } } @else { (text) } } }
    };
    html! {
        details {
            summary { "Settings" }
            ul class="settings" {
                @for (role, part) in &run.parts { (entry(role, part)) }
                @for name in run.knobs.keys() { (entry(name, &coordinate(run, name))) }
            }
        }
    }
}

fn pictures(
    scene: &SceneView,
    run: &RunView,
    output: (usize, &str),
    files: &Files,
) -> Result<Option<Markup>> {
    let (at, output) = output;
    let Some(pictures) = run.run.pictures.get(output) else { return Ok(None) };
    let name = &run.run.name;
    let whose = format!("output `{output}` of run `{name}` on scene `{}`", scene.entry.name);
    let own = files.embed(&pictures.png, &whose)?;
    let map = |path: &Option<String>, kind: &str| {
        path.as_deref().map(|path| files.embed(path, &format!("{kind} of {whose}"))).transpose()
    };
    let difference = map(&pictures.difference, "signed difference")?;
    let flip = map(&pictures.flip, "FLIP map")?;
    let reference = scene.entry.references.keys().position(|key| *key == run.run.reference);
    let has_truth = run.reference.is_some_and(|reference| reference.pictures.contains_key(output));
    let truth = reference.filter(|_| has_truth).map(|reference| class(scene, reference, at));
    Ok(Some(html! {
        div class="viewer" {
            figure class="slide" {
                div class="stack" {
                    @if let Some(truth) = &truth {
                        div class={ "truth " (truth) } role="img" aria-label={ "Reference, " (output) } {}
                    }
                    img class="own" draggable="false" src=(own) alt={ (output) " of " (name) };
                    @if truth.is_some() { span class="edge" aria-hidden="true" {} }
                }
                @if truth.is_some() {
                    div class="ends" { span { "reference" } span { "run" } }
                    input class="scripted" type="range" min="0" max="100" step="1" value="50"
                        aria-label={ "How much of the reference covers " (output) " of " (name) ", percent" };
                } @else {
                    figcaption { "There is no reference of " (output) "." }
                }
            }
            @if let Some(uri) = &difference {
                figure {
                    img src=(uri) alt={ "Signed difference of " (output) " of " (name) " to the reference" };
                    figcaption { "Difference: " b { "blue" } " darker, " b { "red" } " brighter than the reference" }
                }
            }
            @if let Some(uri) = &flip {
                figure {
                    img src=(uri) alt={ "FLIP map of " (output) " of " (name) " against the reference" };
                    figcaption { "FLIP: dark where no difference is seen, bright where it is" }
                }
            }
            (numbers(run, output))
        }
        p class="quiet" { a href=(link(&pictures.exr)) { "EXR" } ", linear, all outputs" }
    }))
}

/// A file of the folder, as a link that stays in it whatever its name.
pub fn link(path: &str) -> String {
    let mut link = String::from("./");
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'.' | b'-' | b'_' | b'=' | b',' => {
                link.push(char::from(byte))
            }
            _ => link += &format!("%{byte:02X}"),
        }
    }
    link
}

fn numbers(run: &RunView, output: &str) -> Markup {
    let errors = run.run.errors.get(output);
    let known = MEASURES.iter().filter_map(|measure| Some((measure, errors?.get(measure.key)?)));
    html! {
        dl class="numbers" {
            @for (measure, value) in known {
                div { dt { (measure.title) } dd { (number(*value)) } }
            }
            @if run.within_noise(output) { div { dt { "relMSE is" } dd { "within the reference's noise" } } }
        }
    }
}
