//! Drawing: axes by the chart library, markers and lines upon them in pixels.

use super::axis::Axis;
use super::ink::Ink;
use crate::problem::{Problem, Result};
use maud::{Markup, PreEscaped, html};
use plotters::coord::Shift;
use plotters::coord::ranged1d::Ranged;
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::{
    ChartBuilder, Circle, DrawingArea, IntoDrawingArea, IntoFont, PathElement, Polygon, Rectangle,
    SVGBackend, Text, TextStyle,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, ShapeStyle};

/// A place in pixels, from the upper left.
pub type At = (i32, i32);

/// Sizes in the library's unit are 1.24 of CSS's.
const EM: f64 = 1.24;
const FONT: f64 = 12.0;

/// A chart that is being drawn.
pub struct Plot<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// From values to pixels.
pub struct Frame {
    pub left: i32,
    pub right: i32,
    pub top: i32,
    pub bottom: i32,
    x: Axis,
    y: Axis,
}

impl Frame {
    /// Where the point (`x`, `y`) is; values beyond the axes at their ends.
    pub fn at(&self, x: f64, y: f64) -> At {
        (self.x.map(&x, (self.left, self.right)), self.y.map(&y, (self.bottom, self.top)))
    }
}

/// Draws a picture of `size` pixels, which `label` describes for those who don't see it; with none it is decoration.
pub fn plot(size: [u32; 2], label: &str, draw: impl FnOnce(&Plot) -> Result<()>) -> Result<Markup> {
    let mut svg = String::new();
    {
        let plot = Plot { area: SVGBackend::with_string(&mut svg, (size[0], size[1])).into_drawing_area() };
        draw(&plot)?;
        plot.area.present().map_err(undrawable)?;
    }
    // The library's root element has a fixed size and no name: its content moves into one of our own.
    let body =
        svg.split_once('>').and_then(|(_, rest)| rest.rsplit_once("</svg>")).map_or("", |(body, _)| body);
    let described = !label.is_empty();
    Ok(html! {
        svg class="plot" viewBox={ "0 0 " (size[0]) " " (size[1]) }
            role=[described.then_some("img")] aria-label=[described.then_some(label)]
            aria-hidden=[(!described).then_some("true")] {
            (PreEscaped(body))
        }
    })
}

fn undrawable(error: impl std::fmt::Display) -> Problem {
    Problem::failure("report-chart", format!("a chart can't be drawn: {error}"))
}

fn line(ink: Ink, width: u32) -> ShapeStyle {
    ink.color().stroke_width(width)
}

impl Plot<'_> {
    /// Grid, axes and their labels, which take `left` pixels beside and 46 below the frame.
    pub fn axes(&self, x: &Axis, y: &Axis, left: u32) -> Result<Frame> {
        let mut chart = ChartBuilder::on(&self.area)
            .margin_top(10)
            .margin_right(14)
            .x_label_area_size(46)
            .y_label_area_size(left)
            .build_cartesian_2d(x.clone(), y.clone())
            .map_err(undrawable)?;
        chart
            .configure_mesh()
            .light_line_style(Ink::Grid.color().mix(0.0))
            .bold_line_style(Ink::Grid.color())
            .axis_style(Ink::Muted.color())
            .x_labels(x.ticks.len())
            .y_labels(y.ticks.len())
            .label_style(style(Ink::Muted, FONT))
            .axis_desc_style(style(Ink::Text, FONT))
            .x_desc(x.title.as_str())
            .y_desc(y.title.as_str())
            .draw()
            .map_err(undrawable)?;
        let (across, down) = chart.plotting_area().get_pixel_range();
        Ok(Frame {
            left: across.start,
            right: across.end,
            top: down.start,
            bottom: down.end,
            x: x.clone(),
            y: y.clone(),
        })
    }

    fn draw<E>(&self, element: &E) -> Result<()>
    where
        for<'b> &'b E: PointCollection<'b, At>,
        for<'b> E: Drawable<SVGBackend<'b>>,
    {
        self.area.draw(element).map_err(|error| undrawable(error).into())
    }

    pub fn path(&self, points: Vec<At>, ink: Ink, width: u32) -> Result<()> {
        self.draw(&PathElement::new(points, line(ink, width)))
    }

    /// From `from` to `to` in dashes, level.
    pub fn dashes(&self, from: At, to: At, ink: Ink) -> Result<()> {
        for start in (from.0..to.0).step_by(9) {
            self.path(vec![(start, from.1), ((start + 5).min(to.0), to.1)], ink, 1)?;
        }
        Ok(())
    }

    pub fn rectangle(&self, corners: [At; 2], ink: Ink) -> Result<()> {
        self.draw(&Rectangle::new(corners, ink.color().filled()))
    }

    /// Text whose `pos` is at `at`.
    pub fn text(&self, text: &str, at: At, ink: Ink, pos: (HPos, VPos)) -> Result<()> {
        self.draw(&Text::new(text.to_owned(), at, style(ink, FONT).pos(Pos::new(pos.0, pos.1))))
    }

    /// The marker of a series: unlike that of the next seven in shape and colour. Hollow if not `filled`.
    pub fn marker(&self, at: At, series: usize, filled: bool) -> Result<()> {
        let ink = Ink::Series(series);
        let corners: &[At] = match series % 8 {
            0 if filled => return self.draw(&Circle::new(at, 6, ink.color().filled())),
            0 => return self.draw(&Circle::new(at, 5, line(ink, 2))),
            1 => &[(-5, -5), (5, -5), (5, 5), (-5, 5)],
            2 => &[(0, -7), (7, 5), (-7, 5)],
            3 => &[(0, -7), (7, 0), (0, 7), (-7, 0)],
            4 => &[(0, 7), (7, -5), (-7, -5)],
            5 => &[
                (-2, -7),
                (2, -7),
                (2, -2),
                (7, -2),
                (7, 2),
                (2, 2),
                (2, 7),
                (-2, 7),
                (-2, 2),
                (-7, 2),
                (-7, -2),
                (-2, -2),
            ],
            6 => &[
                (-6, -3),
                (-3, -6),
                (0, -3),
                (3, -6),
                (6, -3),
                (3, 0),
                (6, 3),
                (3, 6),
                (0, 3),
                (-3, 6),
                (-6, 3),
                (-3, 0),
            ],
            _ => &[(-3, -6), (3, -6), (7, 0), (3, 6), (-3, 6), (-7, 0)],
        };
        let mut outline: Vec<At> = corners.iter().map(|(x, y)| (at.0 + x, at.1 + y)).collect();
        if filled {
            return self.draw(&Polygon::new(outline, ink.color().filled()));
        }
        outline.extend(outline.first().copied());
        self.path(outline, ink, 2)
    }
}

fn style(ink: Ink, size: f64) -> TextStyle<'static> {
    ("sans-serif", size * EM).into_font().color(&ink.color())
}

/// About how wide `text` is.
pub fn width(text: &str) -> i32 {
    i32::try_from(text.chars().count()).unwrap_or(i32::MAX / 8).saturating_mul(7)
}

/// A marker alone, for legends.
pub fn swatch(series: usize) -> Result<Markup> {
    plot([16, 16], "", |plot| plot.marker((8, 8), series, true))
}
