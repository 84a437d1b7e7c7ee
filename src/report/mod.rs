//! One HTML page from a folder of runs: pictures, errors, times, and what accuracy costs.
//!
//! The page is whole: pictures, charts, style and script are in it, nothing is loaded, and a content security policy
//! forbids the browser to. Only the numbers and the EXR files are links, relative to the folder. Names come
//! from files and command lines, so every one is escaped ([`maud`]). The same comparison gives the same bytes.
//!
//! What can be chosen (output, measure, run) is all in the page: a small script hides what is not chosen. Without
//! scripts, and on paper, the default output and measure are shown, with all runs.

pub mod analysis;
mod axis;
mod cost;
mod crops;
mod errors;
mod files;
mod format;
mod guide;
mod head;
mod ink;
mod labels;
mod measures;
mod pictures;
mod plot;
mod stages;
mod sweep;
#[cfg(test)]
mod tests;
mod view;

use crate::comparison::Comparison;
use crate::problem::Result;
use files::Files;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::path::Path;
use view::{SceneView, View};

/// Nothing from anywhere; what is in the page may be used.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; \
                      base-uri 'none'; form-action 'none'";

/// The page of `comparison`, whose files are in `folder`.
///
/// # Errors
/// `report-picture` (input) if a picture is missing, no PNG, of another size than the comparison, or outside of the
/// folder; `report-chart` (failure) if a chart can't be drawn.
pub fn html(comparison: &Comparison, folder: &Path) -> Result<String> {
    let view = View::new(comparison);
    let files = Files::new(comparison, folder);
    let mut scenes = Vec::new();
    for scene in &view.scenes {
        scenes.push(self::scene(&view, scene, &files)?);
    }
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (comparison.name) " – voxgi " (comparison.command) }
                style { (PreEscaped(ink::css())) (PreEscaped(include_str!("style.css"))) }
            }
            body {
                (head::head(&view))
                (head::choice(&view))
                main { @for scene in &scenes { (scene) } }
                (guide::guide(&view))
                script { (PreEscaped(include_str!("script.js"))) }
            }
        }
    };
    Ok(page.into_string())
}

fn scene(view: &View, scene: &SceneView, files: &Files) -> Result<Markup> {
    let content = if scene.runs.is_empty() {
        html! { p class="quiet" { "There are no runs on this scene." } }
    } else {
        html! {
            (cost::section(view, scene)?)
            @if view.comparison.command == "sweep" { (sweep::section(view, scene)?) }
            (pictures::section(view, scene, files)?)
            (crops::section(view, scene, files)?)
            (errors::section(view, scene))
            (stages::section(scene)?)
        }
    };
    Ok(html! {
        article class="scene" id=(scene.anchor()) {
            h2 { (scene.entry.name) }
            (content)
        }
    })
}
