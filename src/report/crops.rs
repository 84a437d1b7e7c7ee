//! Equal-time crops: what runs that take as long as each other make of the place where they err most.

use super::analysis::{Point, equal_times, points};
use super::files::{Files, crop};
use super::format::{UNKNOWN, maybe, milliseconds};
use super::view::{RunView, SceneView, View};
use crate::picture::Encoded;
use crate::problem::Result;
use maud::{Markup, html};

/// Times within this share of the fastest are equal.
const SHARE: f64 = 0.2;
/// Side of a crop, in pixels.
const SIDE: u32 = 48;

pub fn section(view: &View, scene: &SceneView, files: &Files) -> Result<Markup> {
    let mut outputs = Vec::new();
    for output in &view.outputs {
        outputs.push((output, self::output(view, scene, output, files)?));
    }
    Ok(html! {
        section class="crops" {
            h3 { "Equal time" }
            @for (output, content) in &outputs {
                div data-output=(output) hidden[**output != view.output] { (content) }
            }
        }
    })
}

fn output(view: &View, scene: &SceneView, output: &str, files: &Files) -> Result<Markup> {
    let comparable = |point: &Point| {
        let pictures = |run: &RunView| {
            let truth = run.reference.is_some_and(|reference| reference.pictures.contains_key(output));
            truth && run.run.pictures.contains_key(output)
        };
        scene.run(point.run).is_some_and(pictures)
    };
    let mut points = points(&view.comparison.runs, &scene.entry.name, output, view.measure.key);
    points.retain(comparable);
    let mut rows = Vec::new();
    for group in equal_times(&points, SHARE) {
        let runs: Vec<&RunView> = group.iter().filter_map(|point| scene.run(point.run)).collect();
        rows.push(row(scene, output, &runs, files)?);
    }
    Ok(html! {
        @if rows.is_empty() {
            p class="quiet" { "No two runs of " (output) " have a time and a picture." }
        } @else {
            p class="quiet" {
                "Runs whose times are within " (SHARE * 100.0) " % of the fastest, or else the nearest two; the "
                (SIDE) "-pixel square in which they differ most from the reference as it is displayed, in sum "
                "over these runs."
            }
        }
        @for row in &rows { (row) }
    })
}

fn row(scene: &SceneView, output: &str, runs: &[&RunView], files: &Files) -> Result<Markup> {
    let mut pictures: Vec<(&RunView, Encoded, Encoded)> = Vec::new();
    for run in runs {
        let name = &run.run.name;
        if let (Some(own), Some(truth)) =
            (run.run.pictures.get(output), run.reference.and_then(|reference| reference.pictures.get(output)))
        {
            let own = files.read(&own.png, &format!("output `{output}` of run `{name}`"))?;
            let truth =
                files.read(&truth.png, &format!("output `{output}` of reference `{}`", run.run.reference))?;
            pictures.push((run, own, truth));
        }
    }
    let Some((first, _, truth)) = pictures.first() else { return Ok(html! {}) };
    let size = [truth.width().min(SIDE), truth.height().min(SIDE)];
    let mut sum = vec![0; truth.width() as usize * truth.height() as usize];
    for (_, own, truth) in &pictures {
        for (sum, difference) in sum.iter_mut().zip(differences(own, truth)) {
            *sum += difference;
        }
    }
    let corner = worst(&sum, [truth.width(), truth.height()], size);
    let mut figures = vec![figure(
        html! { b { "reference" } br; (first.run.reference) },
        &format!("Reference, part of {output}"),
        &crop(truth, corner, size)?,
    )];
    for (run, own, truth) in &pictures {
        let value = |key: &str| maybe(super::analysis::error(run.run, output, key));
        // In the crop alone, as it is displayed.
        let inside = mean(&differences(own, truth), truth.width(), corner, size) / (3.0 * 255.0) * 100.0;
        let caption = html! {
            b { (run.number) } " " a href={ "#" (run.anchor()) } { (run.run.name) } br;
            (milliseconds(run.run.gpu_ms.median)) br;
            "relMSE " (value("relmse")) ", FLIP " (value("flip")) br;
            "here " (format!("{inside:.1}")) " % off"
        };
        let alt = format!("The same part of {output} of {}", run.run.name);
        figures.push(figure(caption, &alt, &crop(own, corner, size)?));
    }
    let times = runs.iter().filter_map(|run| run.run.gpu_ms.median);
    let (least, most) = times.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), t| (a.min(t), b.max(t)));
    let times = if least.is_finite() {
        format!("{} to {}", milliseconds(Some(least)), milliseconds(Some(most)))
    } else {
        UNKNOWN.to_owned()
    };
    Ok(html! {
        div class="row" {
            p { b { (times) } ", pixels from (" (corner[0]) ", " (corner[1]) ") on scene " (scene.entry.name) }
            div class="strip" { @for figure in &figures { (figure) } }
        }
    })
}

fn figure(caption: Markup, alt: &str, uri: &str) -> Markup {
    html! { figure { img src=(uri) alt=(alt); figcaption { (caption) } } }
}

/// For each pixel the sum over its colours of how many of 255 steps they differ. Both have the same size.
fn differences(a: &Encoded, b: &Encoded) -> Vec<u64> {
    let texels = a.data().chunks_exact(4).zip(b.data().chunks_exact(4));
    texels.map(|(a, b)| a.iter().zip(b).take(3).map(|(a, b)| u64::from(a.abs_diff(*b))).sum()).collect()
}

fn mean(values: &[u64], width: u32, corner: [u32; 2], size: [u32; 2]) -> f64 {
    let rows = values.chunks_exact(width as usize).skip(corner[1] as usize).take(size[1] as usize);
    let sum: u64 = rows.flat_map(|row| row.iter().skip(corner[0] as usize).take(size[0] as usize)).sum();
    sum as f64 / (f64::from(size[0]) * f64::from(size[1]))
}

/// The upper left corner of the window of `window` pixels with the largest sum of `values`; the first in reading order
/// of several. By a table of sums over all rectangles from the origin.
pub(super) fn worst(values: &[u64], size: [u32; 2], window: [u32; 2]) -> [u32; 2] {
    let [width, height] = size.map(|side| side as usize);
    let [w, h] = window.map(|side| side as usize);
    let mut sums = vec![0; (width + 1) * (height + 1)];
    for (y, row) in values.chunks_exact(width).enumerate() {
        let mut line = 0;
        for (x, value) in row.iter().enumerate() {
            line += value;
            sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + line;
        }
    }
    let at = |x: usize, y: usize| sums[y * (width + 1) + x];
    let mut best = ([0, 0], 0);
    for y in 0..=height - h {
        for x in 0..=width - w {
            let sum = at(x + w, y + h) + at(x, y) - at(x, y + h) - at(x + w, y);
            if sum > best.1 {
                best = ([x as u32, y as u32], sum);
            }
        }
    }
    best.0
}
