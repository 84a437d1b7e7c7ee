//! Axes: what they span, and where their labels are.

use super::format::number;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

#[derive(Clone, Debug, PartialEq)]
enum Scale {
    Linear,
    Log,
    /// Values are 0, 1, … in the order of their names.
    Names(Vec<String>),
}

/// An axis, as the chart library takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub title: String,
    scale: Scale,
    /// The ends: values, of a logarithmic axis their decimal logarithms.
    low: f64,
    high: f64,
    /// Values with a label and a line of the grid.
    pub ticks: Vec<f64>,
}

/// Share of the span that is left free on either side.
const MARGIN: f64 = 0.08;
/// Least span of a logarithmic axis, in decades: points that differ by less than noise don't fill the chart.
const LEAST_DECADES: f64 = 0.3;
/// Most labels that an axis aims at.
const LABELS: f64 = 7.0;

impl Axis {
    /// Logarithmic over `values`, all above 0. With none, one decade.
    pub fn log(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = span(values.into_iter().map(f64::log10)).unwrap_or((0.0, 1.0));
        let missing = (LEAST_DECADES - (high - low)).max(0.0) / 2.0;
        let margin = (high - low).max(LEAST_DECADES) * MARGIN;
        let (low, high) = (low - missing - margin, high + missing + margin);
        let decades = high - low;
        let steps: &[f64] = match decades {
            d if d < 0.5 => &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0],
            d if d < 1.2 => &[1.0, 2.0, 3.0, 5.0, 7.0],
            d if d < 2.6 => &[1.0, 2.0, 5.0],
            d if d < 4.0 => &[1.0, 3.0],
            _ => &[1.0],
        };
        let every = (decades / (2.0 * LABELS)).ceil().max(1.0) as i32;
        let powers = (low.floor() as i32..=high.ceil() as i32).filter(|power| power.rem_euclid(every) == 0);
        let ticks = powers.flat_map(|power| steps.iter().map(move |step| step * 10_f64.powi(power)));
        Self {
            title: title.into(),
            scale: Scale::Log,
            low,
            high,
            ticks: ticks.filter(|tick| (low..=high).contains(&tick.log10())).collect(),
        }
    }

    /// Linear over `values`.
    pub fn linear(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let (low, high) = span(values).unwrap_or((0.0, 1.0));
        let extent = if high > low { high - low } else { high.abs().max(1.0) };
        let (low, high) = (low - extent * MARGIN, high + extent * MARGIN);
        let rough = (high - low) / LABELS;
        let power = 10_f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * power).find(|s| *s >= rough).unwrap_or(rough);
        let first = (low / step).ceil();
        let ticks = (0..=20).map(|at| (first + f64::from(at)) * step).take_while(|tick| *tick <= high);
        Self { title: title.into(), scale: Scale::Linear, low, high, ticks: ticks.collect() }
    }

    /// From 0 to the largest of `values`.
    pub fn from_zero(title: impl Into<String>, values: impl IntoIterator<Item = f64>) -> Self {
        let mut axis = Self::linear(title, values.into_iter().chain([0.0]));
        axis.low = 0.0;
        axis.ticks.retain(|tick| *tick >= 0.0);
        axis
    }

    /// Labels at `values`, not at round numbers.
    pub fn labelled(mut self, values: Vec<f64>) -> Self {
        self.ticks = values;
        self
    }

    pub fn names(title: impl Into<String>, names: Vec<String>) -> Self {
        let count = names.len();
        Self {
            title: title.into(),
            low: -0.5,
            high: count.max(1) as f64 - 0.5,
            ticks: (0..count).map(|index| index as f64).collect(),
            scale: Scale::Names(names),
        }
    }

    /// Where `value` is from 0, the low end, to 1; values beyond the ends are there.
    pub fn share(&self, value: f64) -> f64 {
        let position = if self.scale == Scale::Log { value.log10() } else { value };
        let share = (position - self.low) / (self.high - self.low);
        if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        from + (f64::from(to - from) * self.share(*value)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        if self.scale == Scale::Log {
            10_f64.powf(self.low)..10_f64.powf(self.high)
        } else {
            self.low..self.high
        }
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(tick: &f64) -> String {
        plain(*tick)
    }

    fn format_ext(&self, tick: &f64) -> String {
        match &self.scale {
            // Ticks are sums of steps, and 0.30000000000000004 is none.
            Scale::Linear if tick.abs() < (self.high - self.low) * 1e-9 => "0".to_owned(),
            Scale::Linear | Scale::Log => plain(*tick),
            Scale::Names(names) => names.get(tick.round() as usize).cloned().unwrap_or_default(),
        }
    }
}

/// Three digits at most, without trailing zeros.
fn plain(value: f64) -> String {
    let text = number(value);
    if !text.contains('.') || text.contains('e') {
        return text.replace(".00e", "e").replace("0e", "e");
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn span(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold(None, |span, value| match span {
        None => Some((value, value)),
        Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
    })
}
