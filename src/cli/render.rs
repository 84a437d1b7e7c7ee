//! `voxgi render`: pictures, and the time of each stage.

use super::outputs::{Target, Writer};
use super::run::{RunArgs, Started, UntilArgs, heading, progress, show, steps, to_json};
use super::{print, print_json, savings};
use crate::converge::{Estimate, Step, Until, converge};
use crate::frame::Poison;
use crate::picture::{self, Curve};
use crate::plan::PlannedProgress;
use crate::problem::{Problem, Result};
use crate::record::{Record, Samples};
use crate::session::bytes;
use clap::Args;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Args)]
pub struct RenderArgs {
    #[command(flatten)]
    run: RunArgs,
    #[command(flatten)]
    until: UntilArgs,
    /// Write an output to a file (.png or .exr); may be repeated. Default: `display`, or else `color`.
    #[arg(long = "output", value_name = "NAME[=FILE]")]
    outputs: Vec<String>,
    /// Write all outputs, and the record, into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write a subresource, as `radiance@mip2`; slices of a volume are laid out side by side. Turns reuse off.
    #[arg(long = "dump", value_name = "RESOURCE[=FILE]")]
    dumps: Vec<String>,
    /// Frames to run and to sample, after a first one that is timed apart. Without it a single frame is run, whose
    /// times include what drivers do at the first use of a kernel.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// Tone curve of PNG files made from linear outputs.
    #[arg(long, value_name = "CURVE", default_value = "clip")]
    curve: Curve,
    /// Stops of exposure before the tone curve: 1 doubles.
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true)]
    exposure: f32,
    /// Fill undefined memory with a pattern, to find stages that read it.
    #[arg(long, value_name = "PATTERN", value_enum)]
    poison: Option<PoisonArg>,
    /// Look for the first stage that writes NaN or infinities.
    #[arg(long)]
    scan: bool,
    /// Measure what each stage that was kept or dropped takes when it runs, and what it would take to simulate each
    /// effect that the scene has nothing of.
    #[arg(long)]
    savings: bool,
    /// Print the record as one JSON object.
    #[arg(long)]
    pub json: bool,
}

/// Batches of samples where nothing is said.
const DEFAULT_BATCHES: u64 = 4;

#[derive(Clone, Copy, clap::ValueEnum)]
enum PoisonArg {
    Ones,
    Pattern,
}

pub fn run(args: &RenderArgs) -> Result<()> {
    let ready = args.run.prepare(|request| request.reuse &= args.dumps.is_empty())?;
    let targets = Target::parse(
        &ready.prepared.graph,
        &args.run.scene,
        &args.outputs,
        &args.dumps,
        args.out.as_deref(),
    )?;
    let poison = args.poison.map(|p| match p {
        PoisonArg::Ones => Poison::Ones,
        PoisonArg::Pattern => Poison::Pattern,
    });
    let mut started = args.run.start(ready, poison)?;
    let samples = match started.frame.graph.plan.progress.clone() {
        Some(progress) if args.frames.is_none() => converged(&mut started, &progress, &args.until)?,
        None if args.until.given() => {
            let message = format!("`{}` does not get better from frame to frame", args.run.pipeline);
            let help = "leave `--samples`, `--seconds` and `--error` away; `--frames` says how often it runs";
            return Err(Problem::input("no-progress", message).help(help).into());
        }
        _ => sample(&mut started, args.frames)?,
    };
    let Started { gpu, frame, .. } = &mut started;
    let scan = if args.scan { Some(frame.scan(gpu)?) } else { None };
    if let Some(folder) = &args.out {
        std::fs::create_dir_all(folder).map_err(|e| {
            Problem::failure("unwritable", format!("can't make the folder `{}`: {e}", folder.display()))
        })?;
    }
    let writer = Writer { gpu, frame, curve: args.curve, exposure: args.exposure };
    let outputs = writer.write(&targets)?;
    let mut record = started.record(&args.run, &samples)?;
    record.outputs = outputs;
    record.scan = scan;
    if args.savings {
        savings::stages(&mut record.stages, &args.run, &started)?;
        record.effects = Some(savings::effects(&args.run, &started)?);
    }
    if let Some(folder) = &args.out {
        let path = folder.join("record.json");
        picture::write_bytes(&path, format!("{:#}\n", to_json(&record)?).as_bytes())?;
    }
    if args.json {
        print_json(&to_json(&record)?);
    } else {
        print(&table(&record));
    }
    match record.scan.as_ref().and_then(|findings| findings.first()) {
        None => Ok(()),
        Some(first) => Err(Problem::failure(
            "not-finite",
            format!(
                "stage `{}` writes {} NaN and {} infinities into `{}`",
                first.stage, first.nan, first.infinite, first.resource
            ),
        )
        .help(format!("the first is texel or element {}", first.first))
        .into()),
    }
}

/// Batches of a pipeline that gets better from frame to frame, until it is as good as asked for.
fn converged(started: &mut Started, progress: &PlannedProgress, until: &UntilArgs) -> Result<Samples> {
    let bar = steps("rendering");
    let until = until.until(Until { samples: Some(DEFAULT_BATCHES * progress.batch), ..Until::default() });
    let mut watch = |step: Step, _: Option<&Estimate>| {
        show(&bar, &step);
        Ok(())
    };
    let (_, times) = converge(&started.gpu, &mut started.frame, progress, None, &until, &mut watch)?;
    bar.finish_and_clear();
    let (first, frames) = (times.first().cloned(), times.get(1..).unwrap_or_default().to_vec());
    Ok(Samples { first, frames })
}

/// The first frame apart, then, from the same state, the frames that count, which the scene's motion goes on with; or
/// the first frame alone.
fn sample(started: &mut Started, frames: Option<u32>) -> Result<Samples> {
    let bar = progress(u64::from(frames.unwrap_or(0)) + 1);
    let changes = started.changes.clone();
    let first = started.frame.run(&started.gpu, &changes)?.clone();
    bar.inc(1);
    let mut samples = Samples { first: Some(first.clone()), frames: Vec::new() };
    match frames {
        None => samples.frames.push(first),
        Some(frames) => {
            // What is kept stays kept; only a pipeline that goes on from frame to frame starts again.
            if started.frame.goes_on() {
                started.frame.reset();
            }
            for index in 1..=frames {
                let changes = started.go_to(index, None)?;
                samples.frames.push(started.frame.run(&started.gpu, &changes)?.clone());
                bar.inc(1);
            }
        }
    }
    bar.finish_and_clear();
    Ok(samples)
}

/// The record as a table for people.
fn table(record: &Record) -> String {
    let mut text = String::new();
    let ms = |time: Option<f64>| time.map_or_else(|| "unknown".to_owned(), |t| format!("{t:.3}"));
    let mut line = |line: std::fmt::Arguments<'_>| {
        let _infallible = text.write_fmt(line);
        text.push('\n');
    };
    let which = match record.frames {
        1 => "one frame".to_owned(),
        frames => format!("medians of {frames} frames"),
    };
    line(format_args!("{}, in ms\n", heading(record, &which)));
    let widest = record.stages.iter().map(|s| s.path.len()).max().unwrap_or(0).max(5);
    line(format_args!(
        "{:<widest$}  {:>9}  {:>9}  {:>9}  {:>9}",
        "stage", "median", "p10", "p90", "first use"
    ));
    for stage in &record.stages {
        match &stage.reason {
            None => line(format_args!(
                "{:<widest$}  {:>9}  {:>9}  {:>9}  {:>9}",
                stage.path,
                ms(stage.gpu_ms),
                ms(stage.spread.p10),
                ms(stage.spread.p90),
                ms(stage.first_use_ms)
            )),
            Some(reason) => {
                let saved = stage.saved_ms.map_or_else(String::new, |saved| format!("; saves {saved:.3}"));
                line(format_args!("{:<widest$}  {:>9}  {reason}{saved}", stage.path, stage.status));
            }
        }
    }
    // A frame may have none, and what is not timed can't be told apart from it.
    if record.fills_ms.is_some() {
        line(format_args!("{:<widest$}  {:>9}", "fills", ms(record.fills_ms)));
    }
    line(format_args!(
        "{:<widest$}  {:>9}  {:>9}  {:>9}  {:>9}",
        "frame",
        ms(record.frame_ms),
        ms(record.frame.p10),
        ms(record.frame.p90),
        ms(record.first_use_ms)
    ));
    line(format_args!("{:<widest$}  {:>9}\n", "encode (CPU)", ms(record.encode_ms)));
    for effect in record.effects.iter().flatten() {
        let spread = format!("{} to {}", ms(effect.spread.p10), ms(effect.spread.p90));
        let stages: Vec<&str> = effect.stages.keys().map(String::as_str).collect();
        line(format_args!(
            "without {}: saves {} ({spread}), in {}",
            effect.feature,
            ms(effect.saved_ms),
            stages.join(", ")
        ));
    }
    for (counter, count) in &record.counters {
        line(format_args!("{counter:<widest$}  {count:>9}"));
    }
    line(format_args!(
        "memory: {} (without reuse {}), kept for later frames {}",
        bytes(record.memory.peak_bytes),
        bytes(record.memory.without_reuse_bytes),
        bytes(record.memory.kept_bytes)
    ));
    for lack in &record.lacks {
        line(format_args!("left out: {lack}"));
    }
    for (output, path) in &record.outputs {
        line(format_args!("{output}: {path}"));
    }
    text
}
