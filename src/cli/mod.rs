//! The command line: `voxgi COMMAND …`.
//!
//! Exit codes: 0 done; 1 failed (device, driver, disk); 2 bad input (files, options, names). Results go to standard
//! output, messages and progress to standard error.

mod check;
mod compare;
mod devices;
mod generate;
mod kernels;
mod outputs;
mod picture_graph;
mod profile;
mod render;
mod run;
mod savings;
mod scenes;
mod sweep;
mod tune;
mod tuned;

use crate::library::Library;
use crate::play;
use crate::problem::{Problem, Problems, Result};
use crate::scene::{self, Scene};
use crate::session::Request;
use clap::{Args, Parser, Subcommand};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// A workbench for voxel-based global illumination: techniques as pipeline graphs, measured in time and error.
///
/// Exit codes: 0 done, 1 failed, 2 bad input.
#[derive(Parser)]
#[command(name = "voxgi", version, propagate_version = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Render a scene by a pipeline: pictures, and the time of each stage.
    Render(Box<render::RenderArgs>),
    /// Compare pipelines: pictures, errors against the reference, time of each stage; a report.
    Compare(Box<compare::CompareArgs>),
    /// Compare settings of one pipeline along its knobs and parts.
    Sweep(Box<sweep::SweepArgs>),
    /// Find the value of a knob that makes a time or an error least, and keep it for `--tuned`.
    Tune(Box<tune::TuneArgs>),
    /// Join parts of a comparison that were made apart.
    Merge(sweep::MergeArgs),
    /// Say what differs between two comparisons.
    Diff(sweep::DiffArgs),
    /// Profile a pipeline: time, bytes and bandwidth of each stage over many frames; traces.
    Profile(Box<profile::ProfileArgs>),
    /// Check pipelines without rendering: problems, what would run, memory, the graph as a picture.
    Check(Box<check::CheckArgs>),
    /// List kernels with their bindings and documentation.
    Kernels(kernels::KernelsArgs),
    /// List adapters and what each can do.
    Devices(devices::DevicesArgs),
    /// List scenes, how to get those whose models are not there, and what a scene has.
    Scenes(scenes::ScenesArgs),
    /// Write the generated scenes.
    Generate(generate::GenerateArgs),
}

/// Options of every command that reads pipelines.
#[derive(Args, Clone)]
struct PipelineArgs {
    /// Set a knob; may be repeated.
    #[arg(long = "set", value_name = "KNOB=VALUE", value_parser = pair)]
    sets: Vec<(String, String)>,
    /// Put another part into a role; may be repeated.
    #[arg(long = "part", value_name = "ROLE=PART", value_parser = pair)]
    parts: Vec<(String, String)>,
    /// Size of the picture in pixels.
    #[arg(long, value_name = "WxH", default_value = "256x256", value_parser = size)]
    size: [u32; 2],
    /// The scene's camera, by number.
    #[arg(long, value_name = "N", default_value_t = 0)]
    camera: usize,
    /// Most memory that the pipeline may take, as in `2GiB`, `512MiB`.
    #[arg(long, value_name = "BYTES", value_parser = memory)]
    memory: Option<u64>,
    /// A folder with `kernels/` and `pipelines/` that is searched before the built-in library; may be repeated.
    #[arg(long = "library", value_name = "DIR")]
    libraries: Vec<PathBuf>,
    /// Give each resource memory of its own.
    #[arg(long)]
    no_reuse: bool,
    /// Run also what no output needs.
    #[arg(long)]
    no_drop: bool,
    /// What changes between frames; stages that depend on nothing of it are kept. Default: everything.
    #[arg(long = "change", value_name = "WHAT", value_enum)]
    changes: Vec<Change>,
    /// Run every stage in each frame, whatever changes.
    #[arg(long)]
    no_keep: bool,
    /// The scene as it is at this time of its motion.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = seconds)]
    time: f64,
    /// Play the scene's motion from `--time` on, at so many frames a second of its time; what does not depend on what
    /// moved is kept.
    #[arg(long, value_name = "FPS", conflicts_with = "changes", value_parser = rate)]
    play: Option<f64>,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Change {
    Nothing,
    Camera,
    Lights,
    Geometry,
    Frame,
}

impl Change {
    fn causes(self) -> &'static [crate::document::Cause] {
        use crate::document::Cause;
        match self {
            Change::Nothing => &[],
            Change::Camera => &[Cause::Camera],
            Change::Lights => &[Cause::Lights],
            Change::Geometry => &[Cause::Geometry, Cause::Moving],
            Change::Frame => &[Cause::Frame],
        }
    }
}

impl PipelineArgs {
    fn library(&self) -> Result<Library> {
        Library::new(self.libraries.clone())
    }

    /// The scene at the time asked for.
    fn scene(&self, path: &Path) -> Result<Scene> {
        let mut scene = scene::load(path)?;
        scene.pose(self.time);
        Ok(scene)
    }

    /// With `--play`, what `scene` moves may change between frames, and nothing else.
    fn request_for(&self, pipeline: &str, scene: &Scene) -> Request {
        let request = self.request(pipeline);
        match self.play {
            Some(_) if !self.no_keep => {
                Request { keep: true, varying: play::varies(scene, self.camera), ..request }
            }
            _ => request,
        }
    }

    fn request(&self, pipeline: &str) -> Request {
        let keep = !self.changes.is_empty() && !self.no_keep;
        let causes = self.changes.iter().flat_map(|c| c.causes());
        Request {
            pipeline: pipeline.to_owned(),
            sets: self.sets.clone(),
            parts: self.parts.clone(),
            size: self.size,
            camera: self.camera,
            reuse: !self.no_reuse,
            drop: !self.no_drop,
            keep,
            varying: if keep {
                causes.map(|c| crate::graph::facts::bit(*c)).collect()
            } else {
                crate::graph::work::all_causes()
            },
            memory: self.memory,
            claims: Vec::new(),
        }
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    let time = text.parse().ok().filter(|time: &f64| time.is_finite() && *time >= 0.0);
    time.ok_or_else(|| format!("`{text}` is no time in seconds from 0 on"))
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate: &f64| rate.is_finite() && *rate > 0.0);
    rate.ok_or_else(|| format!("`{text}` is no number of frames a second"))
}

fn pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err(format!("`{text}` is not of the form NAME=VALUE")),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.ok_or_else(|| format!("`{text}` is not of the form WxH, such as 256x256"))
}

fn memory(text: &str) -> Result<u64, String> {
    let digits = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let unit = match &text[digits..] {
        "" | "B" => 1,
        "KiB" => 1 << 10,
        "MiB" => 1 << 20,
        "GiB" => 1 << 30,
        unit => return Err(format!("`{unit}` is no unit of memory: B, KiB, MiB, GiB")),
    };
    let number: Option<u64> = text[..digits].parse().ok();
    number.and_then(|n| n.checked_mul(unit)).ok_or_else(|| format!("`{text}` is no number of bytes"))
}

/// Runs the command line and says the process's exit code.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    run::watch_unwrapping();
    let json = match &cli.command {
        Command::Render(args) => args.json,
        Command::Compare(args) => args.json(),
        Command::Sweep(args) => args.json(),
        Command::Tune(args) => args.json,
        Command::Diff(args) => args.json,
        Command::Profile(args) => args.json,
        Command::Check(args) => args.json,
        Command::Kernels(args) => args.json,
        Command::Devices(args) => args.json,
        Command::Scenes(args) => args.json,
        Command::Generate(_) | Command::Merge(_) => false,
    };
    let result = match &cli.command {
        Command::Render(args) => render::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Sweep(args) => sweep::sweep(args),
        Command::Tune(args) => tune::run(args),
        Command::Merge(args) => sweep::run_merge(args),
        Command::Diff(args) => sweep::run_diff(args),
        Command::Profile(args) => profile::run(args),
        Command::Check(args) => check::run(args),
        Command::Kernels(args) => kernels::run(args),
        Command::Devices(args) => devices::run(args),
        Command::Scenes(args) => scenes::run(args),
        Command::Generate(args) => generate::run(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(problems) => {
            report(&problems, json);
            ExitCode::from(problems.exit_code())
        }
    }
}

/// Problems for people on standard error; with `--json` also as one object on standard output.
fn report(problems: &Problems, json: bool) {
    problems.iter().for_each(tell);
    if json {
        let problems: Vec<_> = problems.iter().map(Problem::to_json).collect();
        print_json(&serde_json::json!({ "schema": crate::record::SCHEMA, "problems": problems }));
    }
}

/// One message on standard error.
fn tell(problem: &Problem) {
    let color = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    eprint!("{}", problem.render(color));
}

fn print_json(value: &serde_json::Value) {
    print(&format!("{value:#}\n"));
}

/// Writes to standard output; a reader that has gone away is no error.
fn print(text: &str) {
    use std::io::Write;
    let _gone = std::io::stdout().lock().write_all(text.as_bytes());
}
