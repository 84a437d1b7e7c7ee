//! `voxgi render`: pictures, and the time of each stage.

use super::outputs::{Target, Writer};
use super::{PipelineArgs, print, print_json, savings, tell};
use crate::device::{Gpu, LimitSet};
use crate::frame::{Changes, Clock, Frame, Poison, calibrate};
use crate::picture::{self, Curve};
use crate::play::Play;
use crate::problem::{Problem, Result};
use crate::record::{self, Record, Samples};
use crate::scene::Scene;
use crate::session::{bytes, prepare};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Args)]
pub struct RenderArgs {
    /// A glTF file (.gltf, .glb) or a setting (.ron).
    scene: PathBuf,
    /// A pipeline's name, or the path of its .ron file.
    #[arg(short, long)]
    pipeline: String,
    #[command(flatten)]
    pipeline_args: PipelineArgs,
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
    /// Use the adapter whose name contains this.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Ask the device for no more than WebGPU guarantees.
    #[arg(long)]
    webgpu_limits: bool,
    /// Time stages by the wall clock, each submitted alone.
    #[arg(long)]
    wall_clock: bool,
    /// Fill undefined memory with a pattern, to find stages that read it.
    #[arg(long, value_name = "PATTERN", value_enum)]
    poison: Option<PoisonArg>,
    /// Look for the first stage that writes NaN or infinities.
    #[arg(long)]
    scan: bool,
    /// Measure what each stage that was kept or dropped takes when it runs.
    #[arg(long)]
    savings: bool,
    /// Print the record as one JSON object.
    #[arg(long)]
    pub json: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum PoisonArg {
    Ones,
    Pattern,
}

pub fn run(args: &RenderArgs) -> Result<()> {
    let library = args.pipeline_args.library()?;
    let scene = args.pipeline_args.scene(&args.scene)?;
    let mut request = args.pipeline_args.request_for(&args.pipeline, &scene);
    request.reuse &= args.dumps.is_empty();
    let prepared = prepare(&request, &library, Some(&scene))?;
    let warnings = prepared.warnings.clone();
    warnings.iter().for_each(tell);
    let targets =
        Target::parse(&prepared.graph, &args.scene, &args.outputs, &args.dumps, args.out.as_deref())?;
    let limits = if args.webgpu_limits { LimitSet::Webgpu } else { LimitSet::Adapter };
    let gpu = Gpu::open(args.adapter.as_deref(), &limits)?;
    let clock = match args.wall_clock {
        true => Clock::Wall("asked for by --wall-clock".to_owned()),
        false => calibrate::choose(&gpu)?,
    };
    let poison = args.poison.map(|p| match p {
        PoisonArg::Ones => Poison::Ones,
        PoisonArg::Pattern => Poison::Pattern,
    });
    let changes = match request.keep {
        true => Changes::Only(request.varying.clone()),
        false => Changes::All,
    };
    let mut frame = prepared.realise(&gpu, &scene, clock.clone(), poison)?;
    let samples = match (args.pipeline_args.play, scene.cameras.get(args.pipeline_args.camera)) {
        (Some(rate), Some(camera)) => {
            let mut play = Play::new(scene.clone(), camera.clone(), request.size, &frame);
            let start = args.pipeline_args.time;
            sample(&mut frame, &gpu, args.frames, |frame, index| {
                let bits = play.go_to(frame, &gpu, start + f64::from(index) / rate)?;
                Ok(if request.keep { Changes::Only(bits) } else { Changes::All })
            })?
        }
        _ => sample(&mut frame, &gpu, args.frames, |_, _| Ok(changes.clone()))?,
    };
    let scan = if args.scan { Some(frame.scan(&gpu)?) } else { None };
    if let Some(folder) = &args.out {
        std::fs::create_dir_all(folder).map_err(|e| {
            Problem::failure("unwritable", format!("can't make the folder `{}`: {e}", folder.display()))
        })?;
    }
    let writer = Writer { gpu: &gpu, frame: &frame, curve: args.curve, exposure: args.exposure };
    let outputs = writer.write(&targets)?;
    let mut record = make_record(args, &scene, &gpu, &frame, &samples, &clock)?;
    record.warnings = warnings.iter().map(Problem::to_json).collect();
    record.outputs = outputs;
    record.scan = scan;
    if args.savings {
        savings::measure(&mut record.stages, &request, &library, &scene, (&gpu, &clock))?;
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

/// The first frame apart, then, from the same state, the frames that count; or the first frame alone. `prepare` is told
/// the number of each frame before it runs, and says what has changed since the one before.
fn sample(
    frame: &mut Frame,
    gpu: &Gpu,
    frames: Option<u32>,
    mut prepare: impl FnMut(&mut Frame, u32) -> Result<Changes>,
) -> Result<Samples> {
    let bar = ProgressBar::new(u64::from(frames.unwrap_or(0)) + 1);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} frames, {eta} left") {
        bar.set_style(style);
    }
    let changes = prepare(frame, 0)?;
    let first = frame.run(gpu, &changes)?.clone();
    bar.inc(1);
    let mut samples = Samples { first: Some(first.clone()), frames: Vec::new() };
    match frames {
        None => samples.frames.push(first),
        Some(frames) => {
            // What is kept stays kept; only a pipeline that goes on from frame to frame starts again.
            if frame.goes_on() {
                frame.reset();
            }
            for index in 1..=frames {
                let changes = prepare(frame, index)?;
                samples.frames.push(frame.run(gpu, &changes)?.clone());
                bar.inc(1);
            }
        }
    }
    bar.finish_and_clear();
    Ok(samples)
}

fn make_record(
    args: &RenderArgs,
    scene: &Scene,
    gpu: &Gpu,
    frame: &Frame,
    samples: &Samples,
    clock: &Clock,
) -> Result<Record> {
    let plan = &frame.graph.plan;
    let (clock, clock_reason) = record::clock(clock);
    let [width, height] = args.pipeline_args.size;
    Ok(Record {
        schema: record::SCHEMA,
        pipeline: args.pipeline.clone(),
        scene: scene.name.clone(),
        camera: scene.cameras.get(args.pipeline_args.camera).map(|c| c.name.clone()).unwrap_or_default(),
        width,
        height,
        knobs: plan.knobs.iter().map(|k| (k.path.clone(), record::value(&k.value))).collect(),
        parts: plan.parts.clone(),
        adapter: record::adapter(gpu),
        clock,
        clock_reason,
        frames: samples.frames.len(),
        frame_ms: samples.median(|t| t.frame),
        frame: samples.frame_spread(),
        first_use_ms: samples.first.as_ref().and_then(|t| t.frame),
        encode_ms: samples.median(|t| Some(t.encode)),
        fills_ms: samples.median(|t| record::fills(frame, t)),
        stages: record::stages(frame, samples),
        counters: frame.counters(gpu)?.into_iter().collect(),
        memory: record::memory(frame),
        lacks: record::lacks(scene, &frame.graph),
        warnings: Vec::new(),
        outputs: BTreeMap::new(),
        scan: None,
    })
}

fn to_json(record: &Record) -> Result<serde_json::Value> {
    serde_json::to_value(record)
        .map_err(|e| Problem::failure("record", format!("the record can't be written as JSON: {e}")).into())
}

/// The record as a table for people.
fn table(record: &Record) -> String {
    let mut text = String::new();
    let ms = |time: Option<f64>| time.map_or_else(|| "unknown".to_owned(), |t| format!("{t:.3}"));
    let mut line = |line: std::fmt::Arguments<'_>| {
        let _infallible = text.write_fmt(line);
        text.push('\n');
    };
    line(format_args!(
        "{} by {}, {}x{}, on {} ({} {})",
        record.scene,
        record.pipeline,
        record.width,
        record.height,
        record.adapter.name,
        record.adapter.driver,
        record.adapter.driver_info
    ));
    let why = record.clock_reason.as_ref().map_or_else(String::new, |why| format!(", since {why}"));
    let which = match record.frames {
        1 => "one frame".to_owned(),
        frames => format!("medians of {frames} frames"),
    };
    line(format_args!("clock: {}{why}; {which}, in ms\n", record.clock));
    let widest = record.stages.iter().map(|s| s.path.len()).max().unwrap_or(0).max(5);
    line(format_args!(
        "{:<widest$}  {:>9}  {:>9}  {:>9}  {:>9}",
        "stage", "median", "p10", "p90", "first use"
    ));
    for stage in &record.stages {
        match &stage.reason {
            None => line(format_args!(
                "{:<widest$}  {:>9}  {:>9}",
                stage.path,
                ms(stage.gpu_ms),
                ms(stage.first_use_ms)
            )),
            Some(reason) => {
                let saved = stage.saved_ms.map_or_else(String::new, |saved| format!("; saves {saved:.3}"));
                line(format_args!("{:<widest$}  {:>9}  {reason}{saved}", stage.path, stage.status));
            }
        }
    }
    line(format_args!("{:<widest$}  {:>9}", "fills", ms(record.fills_ms)));
    line(format_args!(
        "{:<widest$}  {:>9}  {:>9}  {:>9}  {:>9}",
        "frame",
        ms(record.frame_ms),
        ms(record.frame.p10),
        ms(record.frame.p90),
        ms(record.first_use_ms)
    ));
    line(format_args!("{:<widest$}  {:>9}\n", "encode (CPU)", ms(record.encode_ms)));
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
