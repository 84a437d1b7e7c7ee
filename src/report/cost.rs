//! The cost/accuracy chart of a scene: error against GPU time, with the non-dominated front.

use super::analysis::{Point, cheapest_within, front, points};
use super::axis::Axis;
use super::format::{milliseconds, number};
use super::ink::Ink;
use super::labels::{Wish, place};
use super::measures::Measure;
use super::plot::{At, Frame, Plot, plot, swatch};
use super::view::{RunView, SceneView, View};
use crate::problem::Result;
use maud::{Markup, html};
use plotters::style::text_anchor::{HPos, VPos};
use std::collections::BTreeMap;

/// The wide one, and one for phones: text keeps its size.
const SIZES: [(&str, [u32; 2]); 2] = [("wide", [860, 470]), ("narrow", [343, 380])];
/// Names beside points are at most this many characters long; longer ones are in the list alone.
const LONGEST: usize = 56;
/// With more points than these, only those of the front have their names beside them.
const FEW: usize = 10;
/// Percent above the least error.
const ENOUGH: [f64; 3] = [5.0, 25.0, 100.0];

struct Chart<'a> {
    scene: &'a SceneView<'a>,
    output: &'a str,
    measure: &'static Measure,
    /// Those that can be drawn: with an error above 0.
    points: Vec<Point>,
    front: Vec<Point>,
    /// By the reference's name.
    noise: BTreeMap<&'a str, f64>,
}

pub fn section(view: &View, scene: &SceneView) -> Result<Markup> {
    let mut charts = Vec::new();
    for (output, measure, shown) in view.combinations() {
        charts.push((output, measure.key, shown, Chart::new(view, scene, output, measure).figure()?));
    }
    Ok(html! {
        section class="cost" {
            h3 { "What accuracy costs" }
            @for (output, measure, shown, chart) in &charts {
                div data-output=(output) data-measure=(measure) hidden[!shown] { (chart) }
            }
            (key(scene)?)
        }
    })
}

/// Markers, numbers and names.
fn key(scene: &SceneView) -> Result<Markup> {
    let mut items = Vec::new();
    for run in &scene.runs {
        items.push(html! {
            li {
                (swatch(run.series)?) " " b { (run.number) } " "
                a href={ "#" (run.anchor()) } { (run.run.name) } " "
                span class="quiet" { (milliseconds(run.run.gpu_ms.median)) }
            }
        });
    }
    Ok(html! { ol class="key" { @for item in &items { (item) } } })
}

impl<'a> Chart<'a> {
    fn new(view: &View, scene: &'a SceneView, output: &'a str, measure: &'static Measure) -> Self {
        let mut points = points(&view.comparison.runs, &scene.entry.name, output, measure.key);
        points.retain(|point| point.error > 0.0);
        // Noise is a relMSE; it says nothing of other measures.
        let references = scene.entry.references.iter().filter(|_| measure.key == "relmse");
        let noise = references.filter_map(|(name, reference)| {
            let noise =
                reference.noise.get(output).copied().filter(|noise| noise.is_finite() && *noise > 0.0)?;
            let used = scene.runs.iter().any(|run| run.run.reference == *name);
            used.then_some((name.as_str(), noise))
        });
        Self { scene, output, measure, front: front(&points), noise: noise.collect(), points }
    }

    fn figure(&self) -> Result<Markup> {
        if self.points.is_empty() {
            return Ok(html! {
                p class="quiet" {
                    "No run has both a time and " (self.measure.title) " of " (self.output) "."
                }
            });
        }
        let mut drawings = Vec::new();
        for (class, size) in SIZES {
            drawings.push(self.drawing(class, size)?);
        }
        Ok(html! {
            figure {
                @for drawing in &drawings { (drawing) }
                figcaption {
                    p {
                        "Lower left is better. The line joins the runs that no other beats in both: "
                        @for (at, point) in self.front.iter().enumerate() {
                            @if at > 0 { ", " }
                            @if let Some(run) = self.scene.run(point.run) {
                                a href={ "#" (run.anchor()) } { (run.number) }
                            }
                        }
                        ". Bars: tenth to ninetieth percentile of the frames."
                        @if !self.noise.is_empty() {
                            " Dashed: the reference's own noise; hollow markers are within it."
                        }
                    }
                    @if let Some(missing) = self.missing() { p { (missing) } }
                    (self.cheapest())
                }
            }
        })
    }

    fn drawing(&self, class: &str, size: [u32; 2]) -> Result<Markup> {
        let wide = class == "wide";
        let times =
            self.points.iter().flat_map(|point| self.bar(point).into_iter().flatten().chain([point.time]));
        let errors = self.points.iter().map(|point| point.error).chain(self.noise.values().copied());
        let x = Axis::log("GPU time of a frame, ms (log)", times);
        let y = Axis::log(format!("{} of {} (log)", self.measure.title, self.output), errors);
        let mut links: Vec<(At, &Point)> = Vec::new();
        let label = format!(
            "{} of {} against GPU time for {} runs; the table of errors below has the numbers",
            self.measure.title,
            self.output,
            self.points.len()
        );
        let drawn = plot(size, &label, |plot| {
            let frame = plot.axes(&x, &y, if wide { 68 } else { 60 })?;
            self.noise(plot, &frame)?;
            self.steps(plot, &frame)?;
            for point in &self.points {
                self.point(plot, &frame, point)?;
                links.push((frame.at(point.time, point.error), point));
            }
            self.names(plot, &frame, wide)
        })?;
        let percent = |at: i32, of: u32| format!("{:.2}%", f64::from(at) * 100.0 / f64::from(of));
        Ok(html! {
            div class={ "chart " (class) } {
                (drawn)
                @for (at, point) in &links {
                    @if let Some(run) = self.scene.run(point.run) {
                        @let text = self.describe(run, point);
                        a class="point" href={ "#" (run.anchor()) } title=(text) aria-label=(text)
                            style={ "left:" (percent(at.0, size[0])) ";top:" (percent(at.1, size[1])) } {}
                    }
                }
            }
        })
    }

    fn describe(&self, run: &RunView, point: &Point) -> String {
        let noise = if self.is_noise(run) { ", within the reference's noise" } else { "" };
        let (time, error) = (milliseconds(Some(point.time)), number(point.error));
        format!("{} {}: {time}, {} {error}{noise}", run.number, run.run.name, self.measure.title)
    }

    fn is_noise(&self, run: &RunView) -> bool {
        self.measure.key == "relmse" && run.within_noise(self.output)
    }

    /// Percentiles of the time, where they can be drawn.
    fn bar(&self, point: &Point) -> Option<[f64; 2]> {
        let timing = &self.scene.run(point.run)?.run.gpu_ms;
        let drawable = |time: &f64| time.is_finite() && *time > 0.0;
        Some([timing.p10.filter(drawable)?, timing.p90.filter(drawable)?])
    }

    fn noise(&self, plot: &Plot, frame: &Frame) -> Result<()> {
        for (name, noise) in &self.noise {
            let y = frame.at(1.0, *noise).1;
            plot.dashes((frame.left, y), (frame.right, y), Ink::Noise)?;
            let text = if self.noise.len() > 1 {
                format!("noise of {name}")
            } else {
                "reference's noise".to_owned()
            };
            // Below the left end, where nothing is both fast and that right.
            plot.text(&text, (frame.left + 6, y + 4), Ink::Muted, (HPos::Left, VPos::Top))?;
        }
        Ok(())
    }

    /// From a point of the front on, its error can be had for any longer time.
    fn steps(&self, plot: &Plot, frame: &Frame) -> Result<()> {
        let mut corners: Vec<At> = Vec::new();
        for point in &self.front {
            let at = frame.at(point.time, point.error);
            corners.push((at.0, corners.last().map_or(frame.top, |last| last.1)));
            corners.push(at);
        }
        corners.extend(corners.last().map(|last| (frame.right, last.1)));
        plot.path(corners, Ink::Muted, 2)
    }

    fn point(&self, plot: &Plot, frame: &Frame, point: &Point) -> Result<()> {
        let Some(run) = self.scene.run(point.run) else { return Ok(()) };
        if let Some([p10, p90]) = self.bar(point) {
            let ends = [frame.at(p10, point.error), frame.at(p90, point.error)];
            plot.path(ends.to_vec(), Ink::Series(run.series), 1)?;
            for (x, y) in ends {
                plot.path(vec![(x, y - 4), (x, y + 4)], Ink::Series(run.series), 1)?;
            }
        }
        plot.marker(frame.at(point.time, point.error), run.series, !self.is_noise(run))
    }

    fn names(&self, plot: &Plot, frame: &Frame, wide: bool) -> Result<()> {
        let mut wishes = Vec::new();
        for point in &self.points {
            let Some(run) = self.scene.run(point.run) else { continue };
            let noise = if self.is_noise(run) { " ≤ noise" } else { "" };
            let short = format!("{}{noise}", run.number);
            let low = self.front.contains(point);
            let named = low || self.points.len() <= FEW;
            let fits = wide && named && run.run.name.chars().count() <= LONGEST;
            let full = fits.then(|| format!("{} {}{noise}", run.number, run.run.name));
            let texts = full.into_iter().chain([short]).collect();
            wishes.push(Wish { at: frame.at(point.time, point.error), texts, low });
        }
        for (text, at) in place(&wishes, [(frame.left, frame.top), (frame.right, frame.bottom)]) {
            plot.text(&text, at, Ink::Text, (HPos::Left, VPos::Center))?;
        }
        Ok(())
    }

    /// Which runs are not in the chart, and why.
    fn missing(&self) -> Option<String> {
        let reason = |run: &RunView| {
            let why = match super::analysis::error(run.run, self.output, self.measure.key) {
                None => "has no such error",
                Some(0.0) => "has no error at all, which a log axis can't show",
                Some(_) => "has no time",
            };
            format!("{} {why}", run.number)
        };
        let drawn = |run: &&RunView| self.points.iter().any(|point| point.run == run.index);
        let missing: Vec<String> = self.scene.runs.iter().filter(|run| !drawn(run)).map(reason).collect();
        (!missing.is_empty()).then(|| format!("Not in the chart: {}.", missing.join("; ")))
    }

    /// The line for those who would not pay for the last bit of accuracy.
    fn cheapest(&self) -> Markup {
        let noise = self.noise.values().copied().fold(0.0, f64::max);
        let mut found: Vec<(String, Point)> = Vec::new();
        for percent in ENOUGH {
            match (cheapest_within(&self.points, percent, noise), found.last_mut()) {
                (Some(point), Some((percents, last))) if last.run == point.run => {
                    *percents += &format!(", {percent}");
                }
                (Some(point), _) => found.push((percent.to_string(), point)),
                (None, _) => {}
            }
        }
        html! {
            p {
                @for (at, (percents, point)) in found.iter().enumerate() {
                    @if at == 0 { "The cheapest " } @else { "; " }
                    "within " (percents) " % of the least error: "
                    @if let Some(run) = self.scene.run(point.run) {
                        a href={ "#" (run.anchor()) } { (run.number) " " (run.run.name) }
                        " (" (milliseconds(Some(point.time))) ", " (number(point.error)) ")"
                    }
                }
                "."
            }
        }
    }
}
