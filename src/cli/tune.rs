//! `voxgi tune`: the value of a knob that makes a time or an error least.

use super::compare::{HowArgs, subject};
use super::run::{self, show, steps};
use super::{print, print_json};
use crate::problem::{Problem, Result};
use crate::reference::Cache;
use crate::tune::estimate::Estimate;
use crate::tune::{Doing, Least, Outcome, Tried, Tuning, tune};
use crate::tuned::{Kept, Shelf};
use clap::Args;
use comfy_table::{CellAlignment, Table};
use indicatif::ProgressBar;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

#[derive(Args)]
pub struct TuneArgs {
    /// Scenes: glTF files and settings. Of several, the least sum of ratios to each scene's best counts.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// The pipeline, with knobs and parts: NAME, NAME,KNOB=VALUE.
    #[arg(short, long, value_name = "NAME[,KEY=VALUE…]")]
    pipeline: String,
    /// Set another knob; may be repeated.
    #[arg(long = "set", value_name = "KNOB=VALUE", value_parser = super::pair)]
    sets: Vec<(String, String)>,
    /// Put another part into a role; may be repeated.
    #[arg(long = "part", value_name = "ROLE=PART", value_parser = super::pair)]
    parts: Vec<(String, String)>,
    /// The knob whose value is to be found.
    #[arg(long, value_name = "KNOB")]
    knob: String,
    /// What is to be least.
    #[arg(long, value_enum)]
    least: What,
    /// Of a time: only that of the stages whose paths begin with this, in sum. Default: whole frames.
    #[arg(long, value_name = "PREFIX")]
    stage: Option<String>,
    /// Of an error: in this output.
    #[arg(long, value_name = "NAME", default_value = "color")]
    output: String,
    /// Try no values but these, both included.
    #[arg(long, value_name = "A..B", value_parser = within, allow_hyphen_values = true)]
    within: Option<[f64; 2]>,
    /// Of a time: frames of each value that count; values take turns.
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(6..=1000))]
    repeats: u32,
    /// Of an error: frames before the picture is looked at, after a first one.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// Of the order in which values take turns.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    how: HowArgs,
    /// Print what was tried and found as one JSON object.
    #[arg(long)]
    pub json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum What {
    /// Time on the GPU.
    Time,
    /// relMSE against the reference.
    Error,
}

fn within(text: &str) -> Result<[f64; 2], String> {
    let ends = text.split_once("..").and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
    let ends = ends.filter(|[a, b]: &[f64; 2]| a.is_finite() && b.is_finite() && a <= b);
    ends.ok_or_else(|| format!("`{text}` is not of the form A..B, two numbers of which B is not the less"))
}

pub fn run(args: &TuneArgs) -> Result<()> {
    let least = match (args.least, &args.stage) {
        (What::Time, stage) => Least::Time { stage: stage.clone() },
        (What::Error, None) => Least::Error { output: args.output.clone() },
        (What::Error, Some(_)) => {
            return Err(Problem::input("stage-of-error", "no single stage has an error")
                .help("leave `--stage` away, or say `--least time`; `--output` chooses what is looked at")
                .into());
        }
    };
    let library = args.how.library()?;
    let mut subject = subject(&args.pipeline, &library)?;
    subject.parts.splice(0..0, args.parts.iter().cloned());
    subject.sets.splice(0..0, args.sets.iter().cloned());
    // No pictures are written: the folder is nobody's.
    let plan = args.how.plan("tune", &args.scenes, vec![subject.clone()], PathBuf::new(), args.frames);
    let (knob, within) = (args.knob.clone(), args.within);
    let tuning = Tuning { plan, subject, knob, least, within, repeats: args.repeats, seed: args.seed };
    let mut bar: Option<(String, ProgressBar)> = None;
    let outcome = tune(&tuning, &library, &Cache::of_user()?, &mut |doing| watch(&mut bar, &doing))?;
    if let Some((_, bar)) = &bar {
        bar.finish_and_clear();
    }
    let when = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    let path = Shelf::of_user()?.keep(&Kept::new(&outcome, when))?;
    if args.json {
        let mut json = run::to_json(&outcome)?;
        json["kept"] = path.display().to_string().into();
        print_json(&json);
    } else {
        print(&table(&outcome, &path));
    }
    Ok(())
}

/// One bar for each reference, one for values that are measured together.
fn watch(bar: &mut Option<(String, ProgressBar)>, doing: &Doing) {
    let title = match doing {
        Doing::Reference { scene, .. } => format!("{scene}: reference"),
        Doing::Values { scene, values, .. } => format!("{scene}: {}", values.join(", ")),
    };
    if bar.as_ref().is_none_or(|(of, _)| *of != title) {
        if let Some((_, old)) = bar.take() {
            old.finish_and_clear();
        }
        *bar = Some((title.clone(), steps(&title)));
    }
    let Some((_, bar)) = bar else { return };
    match doing {
        Doing::Reference { step, .. } => show(bar, step),
        Doing::Values { done, of, .. } => {
            bar.set_length(*of as u64);
            bar.set_position(*done as u64);
            bar.set_message(format!("{done}/{of}"));
        }
    }
}

/// A median with its interval; errors can be small.
fn cell(estimate: &Estimate, digits: usize) -> String {
    let Estimate { median, low, high } = estimate;
    match (low < high, *median > 0.0 && *median < 1e-3) {
        (true, _) => format!("{median:.digits$} ({low:.digits$} to {high:.digits$})"),
        (false, true) => format!("{median:.2e}"),
        (false, false) => format!("{median:.digits$}"),
    }
}

/// For people: each value with its median and interval on each scene, and what was chosen.
fn table(outcome: &Outcome, path: &Path) -> String {
    let mut text = String::new();
    let mut line = |line: std::fmt::Arguments<'_>| {
        let _infallible = text.write_fmt(line);
        text.push('\n');
    };
    let Outcome { knob, adapter, size: [width, height], .. } = outcome;
    let unit = if outcome.least == "time" { "ms" } else { "relMSE" };
    line(format_args!(
        "{knob} of {}, least {} of {}, {width}x{height}, on {} ({} {})",
        outcome.pipeline, outcome.least, outcome.of, adapter.name, adapter.driver, adapter.driver_info
    ));
    if let Some(clock) = outcome.clock {
        let why = outcome.clock_reason.as_ref().map_or_else(String::new, |why| format!(", since {why}"));
        line(format_args!("clock: {clock}{why}; medians and their 95 % intervals"));
    }
    let value = |value: &serde_json::Value| match value {
        serde_json::Value::String(text) => text.clone(),
        serde_json::Value::Number(number) => number.as_f64().unwrap_or(f64::NAN).to_string(),
        other => other.to_string(),
    };
    let name = match &outcome.unit {
        Some(unit) => format!("{knob} ({unit})"),
        None => knob.clone(),
    };
    let several = outcome.scenes.len() > 1;
    let digits = if outcome.least == "time" { 3 } else { 5 };
    let cells = |tried: &Tried| -> Vec<String> {
        let scenes = tried.scenes.iter().map(|measured| cell(&measured.estimate, digits));
        let together = several.then(|| cell(&tried.ratio, 3));
        let chosen = if tried.value == outcome.chosen { "chosen" } else { "" };
        let default = if tried.value == outcome.default { "default" } else { "" };
        let marks = format!("{default} {chosen}").trim().to_owned();
        [value(&tried.value)].into_iter().chain(scenes).chain(together).chain([marks]).collect()
    };
    let titles = outcome.scenes.iter().map(|scene| format!("{scene}, {unit}"));
    let together = several.then(|| "mean ratio to the best".to_owned());
    let mut table = Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header([name].into_iter().chain(titles).chain(together).chain([String::new()]));
    outcome.tried.iter().for_each(|tried| _ = table.add_row(cells(tried)));
    if let Some(values) = table.column_mut(0) {
        values.set_cell_alignment(CellAlignment::Right);
    }
    line(format_args!(""));
    table.lines().for_each(|row| line(format_args!("{}", row.trim_end())));
    let [from, to] = &outcome.alike;
    if from != to {
        line(format_args!("\nfrom {} to {} it is as good: the middle is chosen", value(from), value(to)));
    }
    line(format_args!(
        "\n{knob}={}, used with `--tuned`; kept in {}",
        value(&outcome.chosen),
        path.display()
    ));
    text
}
