//! The tables as Markdown.

use crate::fit::{Slope, exponent};
use crate::rows::{PARENTS, Row};
use std::fmt::Write;
use voxgi::tune::estimate::Estimate;

/// Scenes of fewer triangles say nothing of how time grows with their number.
const MANY: usize = 1000;

const FITS: &str = "Exponents by least squares on the logarithms of medians ± half of the 95 % interval: over scenes of \
1,000 triangles and more at one resolution; over resolutions, with a constant for each scene.";

/// Scenes × resolutions × methods, for one separability. Empty without rows.
pub fn table(rows: &[&Row]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let methods: Vec<&str> = first.cells.iter().map(|cell| cell.method.as_str()).collect();
    let mixed: Vec<&str> = match PARENTS.iter().all(|parent| methods.contains(parent)) {
        true => methods.iter().copied().filter(|method| !PARENTS.contains(method)).collect(),
        false => Vec::new(),
    };
    let passes: Vec<&str> = methods
        .iter()
        .copied()
        .filter(|method| {
            rows.iter().any(|row| row.cell(method).and_then(|cell| cell.second_pass()).is_some())
        })
        .collect();
    let mut head: Vec<String> = ["scene (triangles)", "grid", "filled"].map(str::to_owned).into();
    head.extend(methods.iter().map(|method| (*method).to_owned()));
    head.extend(mixed.iter().map(|method| format!("{method} / better parent")));
    head.extend(passes.iter().map(|method| format!("{method}: large")));
    head.push("rounds".to_owned());
    let mut text = line(&head);
    text += &rule(head.len());
    for row in rows {
        let mut cells = vec![
            format!("{} ({})", row.scene, grouped(row.triangles as u64)),
            format!("{}³", row.resolution),
            filled(row),
        ];
        let fastest = row.fastest().map(|cell| cell.method.as_str());
        cells.extend(methods.iter().map(|method| {
            let time = row.cell(method).and_then(|cell| cell.estimate()).map_or_else(none, time);
            if fastest == Some(*method) { format!("**{time}**") } else { time }
        }));
        cells.extend(mixed.iter().map(|method| row.over_parent(method).map_or_else(none, ratio)));
        cells.extend(passes.iter().map(|method| {
            let share = row.cell(method).and_then(|cell| cell.second_pass());
            share.map_or_else(none, |share| format!("{:.1} %", 100.0 * share))
        }));
        cells.push(rounds(row));
        text += &line(&cells);
    }
    text
}

/// How times grow, for one separability.
pub fn fits(rows: &[&Row]) -> String {
    let mut scenes: Vec<&str> = Vec::new();
    let mut resolutions: Vec<u32> = Vec::new();
    let mut methods: Vec<&str> = Vec::new();
    for row in rows {
        push_new(&mut scenes, &row.scene);
        push_new(&mut resolutions, row.resolution);
        row.cells.iter().for_each(|cell| push_new(&mut methods, &cell.method));
    }
    let mut head = vec!["time ~".to_owned()];
    head.extend(resolutions.iter().map(|resolution| format!("triangles^b at {resolution}³")));
    head.push("resolution^b".to_owned());
    let mut text = format!("{FITS}\n\n{}", line(&head));
    text += &rule(head.len());
    for method in methods {
        let points = |wanted: &dyn Fn(&Row) -> bool, x: fn(&Row) -> f64| -> Vec<(f64, f64)> {
            let wanted = rows.iter().filter(|row| wanted(row));
            wanted.filter_map(|row| Some((x(row), row.cell(method)?.median()?))).collect()
        };
        let mut cells = vec![method.to_owned()];
        for resolution in &resolutions {
            let at = points(&|row| row.resolution == *resolution && row.triangles >= MANY, |row| {
                row.triangles as f64
            });
            cells.push(slope(exponent(&[at])));
        }
        let by_scene =
            scenes.iter().map(|scene| points(&|row| row.scene == **scene, |row| f64::from(row.resolution)));
        cells.push(slope(exponent(&by_scene.collect::<Vec<_>>())));
        text += &line(&cells);
    }
    text
}

fn line<T: AsRef<str>>(cells: &[T]) -> String {
    let mut text = String::from("|");
    for cell in cells {
        let _infallible = write!(text, " {} |", cell.as_ref());
    }
    text.push('\n');
    text
}

/// Below the head of so many columns: numbers stand on the right.
fn rule(columns: usize) -> String {
    line(&(0..columns).map(|column| if column == 0 { "---" } else { "---:" }).collect::<Vec<_>>())
}

fn none() -> String {
    "–".to_owned()
}

/// Half the width of an interval; it need not be as long on both sides.
fn half(estimate: &Estimate) -> f64 {
    (estimate.high - estimate.low) / 2.0
}

/// Of one sample nothing is known but that.
fn is_single(estimate: &Estimate) -> bool {
    estimate.low == estimate.high
}

/// Milliseconds with as many decimals as make three digits.
fn time(estimate: Estimate) -> String {
    let decimals = match estimate.median {
        ms if ms < 1.0 => 3,
        ms if ms < 10.0 => 2,
        ms if ms < 100.0 => 1,
        _ => 0,
    };
    let median = format!("{:.decimals$}", estimate.median);
    if is_single(&estimate) { median } else { format!("{median} ± {:.decimals$}", half(&estimate)) }
}

fn ratio(estimate: Estimate) -> String {
    let median = format!("{:.2}", estimate.median);
    if is_single(&estimate) {
        median
    } else {
        format!("{median} ({:.2}–{:.2})", estimate.low, estimate.high)
    }
}

fn slope(slope: Option<Slope>) -> String {
    slope.map_or_else(none, |slope| format!("{:.2} ± {:.2}", slope.exponent, slope.half))
}

fn filled(row: &Row) -> String {
    let number = grouped(row.filled);
    if row.differ.is_empty() { number } else { format!("{number} ({} differ)", row.differ.join(", ")) }
}

/// How many, and which methods were too slow for more than one.
fn rounds(row: &Row) -> String {
    let most = row.cells.iter().map(|cell| cell.samples_ms.len()).max().unwrap_or(0);
    let single = row.cells.iter().filter(|cell| most > 1 && cell.samples_ms.len() == 1);
    let single: Vec<&str> = single.map(|cell| cell.method.as_str()).collect();
    match (most, single.is_empty()) {
        (1, _) => "one sample".to_owned(),
        (most, true) => most.to_string(),
        (most, false) => format!("{most}; {}: one sample", single.join(", ")),
    }
}

/// A whole number with commas between thousands.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

fn push_new<T: PartialEq>(all: &mut Vec<T>, one: T) {
    if !all.contains(&one) {
        all.push(one);
    }
}
