//! The measures that a report shows, in its order, and the order of outputs.

use crate::comparison::Comparison;
use std::collections::BTreeSet;

/// Which value of a measure is best.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Best {
    Least,
    Most,
    /// Nearest to 1 by ratio.
    One,
}

#[derive(Clone, Copy, Debug)]
pub struct Measure {
    /// In the JSON.
    pub key: &'static str,
    pub title: &'static str,
    pub best: Best,
    /// One sentence.
    pub about: &'static str,
    /// Whether the charts offer it.
    pub charted: bool,
}

impl Measure {
    const fn new(
        key: &'static str,
        title: &'static str,
        best: Best,
        charted: bool,
        about: &'static str,
    ) -> Self {
        Self { key, title, best, about, charted }
    }

    /// How far a value is from the best one there can be, for comparing values with each other.
    pub fn loss(&self, value: f64) -> f64 {
        match self.best {
            Best::Least => value,
            Best::Most => -value,
            Best::One if value > 0.0 => value.ln().abs(),
            Best::One => f64::INFINITY,
        }
    }
}

pub const MEASURES: [Measure; 7] = [
    Measure::new(
        "relmse",
        "relMSE",
        Best::Least,
        true,
        "Mean over pixels and channels of (t − r)² / (r² + 0.01 M²): t the run, r the reference, M the \
         reference's mean. 0.01 is a typical error of 10 %.",
    ),
    Measure::new(
        "relmse_trimmed",
        "relMSE, trimmed",
        Best::Least,
        true,
        "relMSE without the 0.1 % of pixels whose error is largest: single bright pixels don't decide it.",
    ),
    Measure::new(
        "rmse",
        "RMSE",
        Best::Least,
        true,
        "Root of the mean of (t − r)², in the output's own unit: bright places decide it.",
    ),
    Measure::new(
        "smape",
        "SMAPE",
        Best::Least,
        true,
        "Mean of 2 |t − r| / (|t| + |r|), from 0 to 2: dark places count as much as bright ones.",
    ),
    Measure::new(
        "flip",
        "FLIP",
        Best::Least,
        true,
        "Mean of the LDR-FLIP map of the tone-mapped pictures, from 0 to 1: what a viewer sees who flips between the \
         two (Andersson et al. 2020).",
    ),
    Measure::new(
        "ssim",
        "SSIM",
        Best::Most,
        false,
        "Structural similarity of the tone-mapped pictures; 1 is alike (Wang et al. 2004).",
    ),
    Measure::new(
        "bias",
        "bias",
        Best::One,
        false,
        "Ratio of means, mean(t) / mean(r): 0.9 is 10 % too dark on the whole. Noise does not change it.",
    ),
];

/// What is shown first.
pub const DEFAULT_OUTPUT: &str = "color";
pub const DEFAULT_MEASURE: &str = "relmse";

const OUTPUTS: [&str; 7] = ["color", "direct", "indirect", "ambient_occlusion", "albedo", "normal", "depth"];

/// All outputs that any run has an error or a picture of: standard ones in their order, then the others by name.
pub fn outputs(comparison: &Comparison) -> Vec<String> {
    let runs = comparison.runs.iter();
    let names = runs.flat_map(|run| run.errors.keys().chain(run.pictures.keys()));
    let names: BTreeSet<&String> = names.collect();
    let place = |name: &str| OUTPUTS.iter().position(|known| *known == name).unwrap_or(OUTPUTS.len());
    let mut sorted: Vec<String> = names.into_iter().cloned().collect();
    sorted.sort_by_key(|name| place(name));
    sorted
}
