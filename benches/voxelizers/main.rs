//! Voxelizers side by side, as Markdown and JSON: scenes × resolutions × methods.
//!
//! `cargo bench --bench voxelizers -- --help` says what can be chosen. A time is that of the stages that clear the
//! voxels of the frame before and fill those of this one, with what is filled for them, in frames in which everything runs.
//! Methods take turns, one frame of each in a round, every other round backwards; first uses, in which drivers compile,
//! don't count.

mod fit;
mod rig;
mod rows;
mod table;

use clap::Parser;
use rig::Rig;
use rows::Row;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use voxgi::device::{Gpu, LimitSet};
use voxgi::frame::calibrate;
use voxgi::library::Library;
use voxgi::problem::{Problem, Result};
use voxgi::record::{self, Adapter};
use voxgi::scene::{self, Scene, generate};

/// Changes whenever a field of [`Report`] changes its name, its place or its meaning.
const SCHEMA: u32 = 1;

/// From few triangles to many, so that what quick rows leave of the time is for slow ones.
const SCENES: [&str; 8] = [
    "triangle",
    "bunny",
    "dragon-100k",
    "dragon-202k",
    "sponza-crytek",
    "sibenik",
    "hairball",
    "khronos/MetalRoughSpheresNoTextures",
];

#[derive(Parser)]
struct Args {
    /// Generated scenes by name, files, or files of the folder VOXGI_SCENES (.glb may be left out).
    #[arg(long, value_delimiter = ',', default_values = SCENES)]
    scenes: Vec<String>,
    /// Voxels along each edge of the grid.
    #[arg(long, value_delimiter = ',', default_value = "128,256,512")]
    resolutions: Vec<u32>,
    /// 6: thin, 26: conservative.
    #[arg(long, value_delimiter = ',', default_value = "6,26")]
    separabilities: Vec<u32>,
    /// Parts `voxelize/…`.
    #[arg(long, value_delimiter = ',', default_value = "triangles,fragments,hybrid,classified,queue")]
    methods: Vec<String>,
    /// The cutoff of a method in all rows, in voxels², such as `hybrid=800`. Default: the part's own.
    #[arg(long = "cutoff", value_name = "METHOD=AREA", value_parser = cutoff)]
    cutoffs: Vec<(String, f64)>,
    /// Rounds at most.
    #[arg(long, default_value_t = 21, value_parser = clap::value_parser!(u32).range(1..))]
    repeats: u32,
    /// Most seconds for each cell; a method whose first frame takes longer is sampled once.
    #[arg(long, default_value = "6", value_parser = seconds)]
    seconds: Duration,
    /// Most minutes for everything: there are fewer rounds, but no cell is left out.
    #[arg(long, default_value = "15", value_parser = minutes)]
    minutes: Duration,
    /// Use the adapter whose name contains this.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Where the JSON goes.
    #[arg(long, value_name = "FILE", default_value = concat!(env!("CARGO_TARGET_TMPDIR"), "/voxelizers.json"))]
    out: PathBuf,
    /// What cargo adds.
    #[arg(long, hide = true)]
    bench: bool,
}

/// All that was measured.
#[derive(Serialize)]
struct Report {
    schema: u32,
    adapter: Adapter,
    clock: &'static str,
    clock_reason: Option<String>,
    /// Scenes that were not found.
    missing: Vec<String>,
    rows: Vec<Row>,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(problems) => {
            eprintln!("{problems}");
            ExitCode::from(problems.exit_code())
        }
    }
}

fn cutoff(text: &str) -> std::result::Result<(String, f64), String> {
    let parsed =
        text.split_once('=').and_then(|(method, area)| Some((method.to_owned(), area.parse().ok()?)));
    parsed.ok_or_else(|| "a method and an area, such as `hybrid=800`".to_owned())
}

fn seconds(text: &str) -> std::result::Result<Duration, String> {
    let number: f64 = text.parse().map_err(|_| "no number".to_owned())?;
    Duration::try_from_secs_f64(number).map_err(|error| error.to_string())
}

fn minutes(text: &str) -> std::result::Result<Duration, String> {
    seconds(text).map(|duration| duration.saturating_mul(60))
}

/// Whether all methods fill the same voxels.
fn run(args: &Args) -> Result<bool> {
    let begun = Instant::now();
    let gpu = Gpu::open(args.adapter.as_deref(), &LimitSet::Adapter)?;
    let rig = Rig {
        clock: calibrate::choose(&gpu)?,
        gpu,
        library: Library::default(),
        methods: args.methods.clone(),
        cutoffs: args.cutoffs.iter().cloned().collect(),
        repeats: args.repeats,
        seconds: args.seconds,
    };
    let each = args.resolutions.len() * args.separabilities.len();
    let all = args.scenes.len() * each;
    let (mut rows, mut missing, mut done) = (Vec::new(), Vec::new(), 0);
    for name in &args.scenes {
        let Some(scene) = load(name)? else {
            eprintln!("{name}: missing");
            missing.push(name.clone());
            done += each;
            continue;
        };
        for resolution in &args.resolutions {
            for separability in &args.separabilities {
                // What quick rows leave is for those that come later.
                let left = args.minutes.saturating_sub(begun.elapsed()) / (all - done) as u32;
                let row = rig.measure(&scene, *resolution, *separability, left)?;
                done += 1;
                let seconds = begun.elapsed().as_secs();
                eprintln!("{} {resolution}³ {separability}: {done}/{all}, {seconds} s", row.scene);
                rows.push(row);
            }
        }
    }
    let (clock, clock_reason) = record::clock(&rig.clock);
    let report =
        Report { schema: SCHEMA, adapter: record::adapter(&rig.gpu), clock, clock_reason, missing, rows };
    print(&report, args);
    let text = serde_json::to_string_pretty(&report)
        .map_err(|e| Problem::failure("report", format!("it can't be written as JSON: {e}")))?;
    voxgi::picture::write_bytes(&args.out, text.as_bytes())?;
    println!("All samples: {}", args.out.display());
    Ok(report.rows.iter().all(|row| row.differ.is_empty()))
}

/// A scene by its name or file; `None` if it is not there.
fn load(name: &str) -> Result<Option<Scene>> {
    if let Some((file, make)) = generate::find(name) {
        let unwritable = |e| Problem::failure("unwritable", format!("can't make a temporary folder: {e}"));
        let folder = tempfile::tempdir().map_err(unwritable)?;
        let path = folder.path().join(file);
        voxgi::picture::write_bytes(&path, &make())?;
        return scene::load(&path).map(Some);
    }
    let folder = std::env::var_os(scene::listing::SCENES).map(PathBuf::from).unwrap_or_default();
    let paths = [PathBuf::from(name), folder.join(name), folder.join(format!("{name}.glb"))];
    paths.iter().find(|path| path.is_file()).map(|path| scene::load(path)).transpose()
}

fn print(report: &Report, args: &Args) {
    let Adapter { name, driver, driver_info, .. } = &report.adapter;
    let why = report.clock_reason.as_ref().map_or_else(String::new, |why| format!(", since {why}"));
    println!("# Voxelizers on {name} ({driver} {driver_info})\n");
    println!("* Binary voxels, ms by {}{why}; median ± half of the 95 % interval.", report.clock);
    println!("* Of fewer than six rounds, intervals are from the least to the most.");
    println!("* Over the better parent: median of the rounds' ratios, and its interval.");
    println!("* `large`: share of the second pass, which takes large triangles, in both passes.");
    let cutoffs: BTreeMap<&str, f64> = (report.rows.iter().flat_map(|row| &row.cells))
        .filter_map(|cell| Some((cell.method.as_str(), cell.cutoff?)))
        .collect();
    for (method, cutoff) in cutoffs {
        println!("* Cutoff of `{method}`: {cutoff} voxels².");
    }
    if !report.missing.is_empty() {
        println!("* Missing scenes: {}.", report.missing.join(", "));
    }
    for separability in args.separabilities.iter().collect::<BTreeSet<_>>() {
        let rows: Vec<&Row> = report.rows.iter().filter(|row| row.separability == *separability).collect();
        println!("\n## {separability}-separating\n\n{}", table::table(&rows));
        println!("{}", table::fits(&rows));
    }
}
