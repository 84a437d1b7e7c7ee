//! Of a sweep: curves along each knob, and what each step along it costs and gives.

use super::analysis::{Change, Line, coordinate, coordinates, error, lines, marginals, time};
use super::axis::Axis;
use super::format::{UNKNOWN, ratio, signed};
use super::ink::{Ink, SERIES};
use super::measures::Measure;
use super::plot::{plot, swatch};
use super::view::{SceneView, View};
use crate::comparison::Run;
use crate::problem::Result;
use maud::{Markup, html};

const SIZE: [u32; 2] = [400, 300];
/// Values that span at least this factor are on a log axis.
const WIDE: f64 = 4.0;
/// So many values are labels of their axis; of more, round numbers are.
const FEW: usize = 7;

/// Error or time of a run.
type Of<'a> = &'a dyn Fn(&Run) -> Option<f64>;

pub fn section(view: &View, scene: &SceneView) -> Result<Markup> {
    let runs = &view.comparison.runs;
    let names = coordinates(runs, &scene.entry.name);
    let mut knobs = Vec::new();
    for name in &names {
        knobs.push(knob(view, scene, name)?);
    }
    Ok(html! {
        section class="sweep" {
            h3 { "Along each knob" }
            @if names.is_empty() { p class="quiet" { "All runs have the same settings." } }
            @for knob in &knobs { (knob) }
            @if !names.is_empty() {
                h4 { "What each step costs and gives" }
                @for (output, measure, shown) in view.combinations() {
                    div data-output=(output) data-measure=(measure.key) hidden[!shown] {
                        (table(view, scene, output, measure))
                    }
                }
            }
        }
    })
}

fn knob(view: &View, scene: &SceneView, name: &str) -> Result<Markup> {
    let runs = &view.comparison.runs;
    let lines = lines(runs, &scene.entry.name, name);
    let mut errors = Vec::new();
    for (output, measure, shown) in view.combinations() {
        let of = |run: &Run| error(run, output, measure.key).filter(|error| *error > 0.0);
        let title = format!("{} of {output} (log)", measure.title);
        errors.push((output, measure.key, shown, curves(runs, &lines, name, &title, &of)?));
    }
    let times = curves(runs, &lines, name, "GPU time of a frame, ms (log)", &time)?;
    let mut key = Vec::new();
    for (at, line) in lines.iter().enumerate().take(SERIES) {
        key.push(html! { li { (swatch(at)?) " " (describe(line)) } });
    }
    Ok(html! {
        h4 { (name) }
        @if lines.is_empty() {
            p class="quiet" { "No two runs differ in it alone." }
        } @else {
            figure class="knob" {
                div class="pair" {
                    div {
                        @for (output, measure, shown, chart) in &errors {
                            div data-output=(output) data-measure=(measure) hidden[!shown] { (chart) }
                        }
                    }
                    div { (times) }
                }
                figcaption {
                    ul class="key" { @for item in &key { (item) } }
                    @if lines.len() > SERIES { p { "Thin grey: " (lines.len() - SERIES) " more." } }
                }
            }
        }
    })
}

fn describe(line: &Line) -> String {
    let fixed = line
        .fixed
        .iter()
        .map(|(name, value)| format!(" {name}={}", if value.is_empty() { UNKNOWN } else { value }));
    format!("{}{}", line.pipeline, fixed.collect::<String>())
}

fn curves(runs: &[Run], lines: &[Line], name: &str, title: &str, of: Of) -> Result<Markup> {
    let mut values: Vec<String> = Vec::new();
    for run in lines.iter().flat_map(|line| &line.runs) {
        let value = coordinate(&runs[*run], name);
        if !values.contains(&value) {
            values.push(value);
        }
    }
    let numbers: Vec<f64> = values.iter().filter_map(|value| value.parse().ok()).collect();
    let is_number = numbers.len() == values.len() && numbers.iter().all(|number| number.is_finite());
    let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let labelled = |axis: Axis| if numbers.len() <= FEW { axis.labelled(numbers.clone()) } else { axis };
    let x = match is_number {
        true if least > 0.0 && most / least >= WIDE => {
            labelled(Axis::log(format!("{name} (log)"), numbers.iter().copied()))
        }
        true => labelled(Axis::linear(name, numbers.iter().copied())),
        false => Axis::names(name, values.iter().map(|value| shortened(value)).collect()),
    };
    let place = |run: &Run| -> Option<f64> {
        let value = coordinate(run, name);
        if is_number {
            value.parse().ok()
        } else {
            values.iter().position(|known| *known == value).map(|at| at as f64)
        }
    };
    let all = lines.iter().flat_map(|line| &line.runs).filter_map(|run| of(&runs[*run]));
    let y = Axis::log(title, all);
    let label = format!("{title} along {name}, {} curves; the table below has the steps", lines.len());
    plot(SIZE, &label, |plot| {
        let frame = plot.axes(&x, &y, 66)?;
        for (at, line) in lines.iter().enumerate().rev() {
            let known = line.runs.iter().filter_map(|run| Some((place(&runs[*run])?, of(&runs[*run])?)));
            let points: Vec<_> = known.map(|(x, y)| frame.at(x, y)).collect();
            let ink = if at < SERIES { Ink::Series(at) } else { Ink::Grid };
            plot.path(points.clone(), ink, if at < SERIES { 2 } else { 1 })?;
            for point in points.into_iter().filter(|_| at < SERIES) {
                plot.marker(point, at, true)?;
            }
        }
        Ok(())
    })
}

fn shortened(value: &str) -> String {
    let last = value.rsplit('/').next().unwrap_or(value);
    if last.is_empty() { UNKNOWN.to_owned() } else { last.chars().take(14).collect() }
}

fn table(view: &View, scene: &SceneView, output: &str, measure: &Measure) -> Markup {
    let rows = marginals(&view.comparison.runs, &scene.entry.name, output, measure.key);
    let difference = |change: Option<Change>| change.map(|change| change.difference);
    let cells = |change: Option<Change>| {
        let value = difference(change);
        html! {
            td class="n" data-value=[value] { (value.map_or_else(|| UNKNOWN.to_owned(), signed)) }
            @let factor = change.and_then(|change| change.ratio);
            td class="n" data-value=[factor] { (ratio(factor)) }
        }
    };
    html! {
        div class="wide-table" tabindex="0" role="region" aria-label="Marginal cost and error" {
            table class="sortable" {
                caption {
                    "Medians over the pairs of runs that differ in that alone: time in ms, " (measure.title) " of "
                    (output)
                }
                thead { tr {
                    th scope="col" { "knob, part or effect" }
                    th scope="col" { "step" }
                    th scope="col" class="n" { "pairs" }
                    th scope="col" class="n" { "time +" }
                    th scope="col" class="n" { "time ×" }
                    th scope="col" class="n" { "error +" }
                    th scope="col" class="n" { "error ×" }
                    th scope="col" { "stages" }
                } }
                tbody {
                    @for row in &rows {
                        tr {
                            th scope="row" { (row.name) }
                            td { (value(&row.from)) " → " (value(&row.to)) }
                            td class="n" data-value=(row.pairs) { (row.pairs) }
                            (cells(row.time))
                            (cells(row.error))
                            td { (stages(&row.stages_from, &row.stages_to)) }
                        }
                    }
                }
            }
        }
    }
}

fn value(text: &str) -> &str {
    if text.is_empty() { UNKNOWN } else { text }
}

fn stages(gone: &[String], new: &[String]) -> String {
    let side =
        |sign: &str, names: &[String]| (!names.is_empty()).then(|| format!("{sign} {}", names.join(", ")));
    let both: Vec<String> = side("−", gone).into_iter().chain(side("+", new)).collect();
    if both.is_empty() { "the same".to_owned() } else { both.join("; ") }
}
