//! `voxgi compare`: pipelines side by side, each held against the scene's reference.

use super::run::{UntilArgs, show, steps};
use super::tuned::Kept;
use super::{print, print_json, size};
use crate::compare::{Comparing, Doing, Plan, Subject};
use crate::comparison::{Comparison, Run};
use crate::converge::Until;
use crate::device::LimitSet;
use crate::library::Library;
use crate::measure;
use crate::picture::{self, Curve};
use crate::problem::{Problem, Result};
use crate::reference::Cache;
use crate::report;
use crate::scene::features;
use clap::Args;
use indicatif::ProgressBar;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

#[derive(Args)]
pub struct CompareArgs {
    /// Scenes: glTF files and settings.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// A pipeline, with knobs and parts of its own: NAME, NAME,KNOB=VALUE, NAME,KNOB=VALUE,ROLE=PART. May be repeated.
    /// NAME,scene.emissive=false leaves an effect out that the scene calls for.
    #[arg(short, long = "pipeline", value_name = "NAME[,KEY=VALUE…]", required = true)]
    pipelines: Vec<String>,
    /// Set a knob in all pipelines; may be repeated.
    #[arg(long = "set", value_name = "KNOB=VALUE", value_parser = super::pair)]
    sets: Vec<(String, String)>,
    /// Put another part into a role in all pipelines; may be repeated.
    #[arg(long = "part", value_name = "ROLE=PART", value_parser = super::pair)]
    parts: Vec<(String, String)>,
    #[command(flatten)]
    common: CommonArgs,
}

/// What `compare` and `sweep` have in common.
#[derive(Args)]
pub struct CommonArgs {
    #[command(flatten)]
    how: HowArgs,
    /// Use values that `voxgi tune` kept for the adapter and a pipeline, for knobs that are not set.
    #[arg(long)]
    tuned: bool,
    /// Frames that are timed, after a first one.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    frames: u32,
    /// The folder to write into; one that holds a part of this comparison is gone on with. Default: a new one in `runs/`.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the comparison as one JSON object.
    #[arg(long)]
    pub json: bool,
}

/// On what, against what, and of which size pipelines are run that are held against a reference.
#[derive(Args)]
pub struct HowArgs {
    /// Size of the pictures in pixels.
    #[arg(long, value_name = "WxH", default_value = "256x256", value_parser = size)]
    size: [u32; 2],
    /// The scenes' camera, by number.
    #[arg(long, value_name = "N", default_value_t = 0)]
    camera: usize,
    /// The scenes as they are at this time of their motion.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = super::seconds)]
    time: f64,
    /// The pipeline that makes references.
    #[arg(long, value_name = "NAME", default_value = "reference")]
    reference: String,
    /// Set a knob of the reference; may be repeated. Knobs that a pipeline has too follow the pipeline.
    #[arg(long = "reference-set", value_name = "KNOB=VALUE", value_parser = super::pair)]
    reference_sets: Vec<(String, String)>,
    #[command(flatten)]
    until: UntilArgs,
    /// Tone curve of PNGs, FLIP and SSIM.
    #[arg(long, value_name = "CURVE", default_value = "clip")]
    curve: Curve,
    /// Stops of exposure before the tone curve: 1 doubles.
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_negative_numbers = true)]
    exposure: f32,
    /// A folder with `kernels/` and `pipelines/` that is searched before the built-in library; may be repeated.
    #[arg(long = "library", value_name = "DIR")]
    libraries: Vec<PathBuf>,
    /// Use the adapter whose name contains this.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Ask the device for no more than WebGPU guarantees.
    #[arg(long)]
    webgpu_limits: bool,
    /// Time stages by the wall clock, each submitted alone.
    #[arg(long)]
    wall_clock: bool,
}

/// A reference is made until its noise is below this, or for ten minutes.
const DEFAULT_ERROR: f64 = 0.005;
const DEFAULT_TIME: Duration = Duration::from_secs(600);

impl CompareArgs {
    pub fn json(&self) -> bool {
        self.common.json
    }
}

pub fn run(args: &CompareArgs) -> Result<()> {
    let library = args.common.library()?;
    let mut subjects: Vec<Subject> = Vec::new();
    for text in &args.pipelines {
        let mut subject = subject(text, &library)?;
        subject.parts.splice(0..0, args.parts.iter().cloned());
        subject.sets.splice(0..0, args.sets.iter().cloned());
        subjects.push(subject);
    }
    args.common.tune(&mut subjects, &library)?;
    for (index, subject) in subjects.iter().enumerate() {
        if subjects[..index].iter().any(|other| other.name() == subject.name()) {
            let message = format!("`{}` is to be compared with itself", subject.name());
            return Err(Problem::input("compared-twice", message)
                .help("leave one away, or set a knob")
                .into());
        }
    }
    let plan = args.common.plan("compare", &args.scenes, subjects);
    make(&plan, &library, args.common.json)
}

/// Makes the comparison and its report, and says what came out.
pub fn make(plan: &Plan, library: &Library, json: bool) -> Result<()> {
    let cache = Cache::of_user()?;
    let mut bar: Option<(String, ProgressBar)> = None;
    let comparison = Comparing::begin(plan, library, &cache)?.run(&mut |doing| watch(&mut bar, doing))?;
    if let Some((_, bar)) = &bar {
        bar.finish_and_clear();
    }
    let page = report(&comparison, &plan.folder)?;
    if json {
        print_json(&to_json(&comparison)?);
    } else {
        print(&format!("{}report: {}\n", table(&comparison), page.display()));
    }
    Ok(())
}

/// The comparison, and beside it the reference of its first run: most have only that.
fn to_json(comparison: &Comparison) -> Result<serde_json::Value> {
    let failed = |e| Problem::failure("record", format!("the comparison can't be written as JSON: {e}"));
    let mut value = serde_json::to_value(comparison).map_err(failed)?;
    let first = comparison.runs.first().and_then(|run| {
        let scene = comparison.scenes.iter().find(|scene| scene.name == run.scene)?;
        scene.references.get(&run.reference)
    });
    value["reference"] = serde_json::to_value(first).map_err(failed)?;
    Ok(value)
}

/// Writes the page into the folder.
pub fn report(comparison: &Comparison, folder: &Path) -> Result<PathBuf> {
    let page = folder.join("index.html");
    picture::write_bytes(&page, report::html(comparison, folder)?.as_bytes())?;
    Ok(page)
}

/// One bar for each reference, one for each scene's runs.
fn watch(bar: &mut Option<(String, ProgressBar)>, doing: &Doing) {
    let title = match doing {
        Doing::Reference { scene, .. } => format!("{scene}: reference"),
        Doing::Run { scene, .. } => format!("{scene}: runs"),
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
        Doing::Run { name, number, of, .. } => {
            bar.set_length(*of as u64);
            bar.set_position(*number as u64);
            bar.set_message(name.clone());
        }
    }
}

/// `NAME,KEY=VALUE,…`: a key is a role where it names one of the pipeline's, or an effect's flag, else a knob.
pub fn subject(text: &str, library: &Library) -> Result<Subject> {
    let mut pieces = text.split(',');
    let pipeline = pieces.next().unwrap_or_default().to_owned();
    let mut subject = Subject { pipeline, ..Subject::default() };
    for piece in pieces {
        let (key, value) = super::pair(piece).map_err(|why| {
            Problem::input("pipeline-option", format!("in `{text}`: {why}"))
                .help("a pipeline is given as NAME, or NAME,KNOB=VALUE,ROLE=PART")
        })?;
        subject.add(key, value, library)?;
    }
    Ok(subject)
}

impl Subject {
    /// Sets a knob, puts a part into a role, or says whether an effect is simulated.
    pub fn add(&mut self, key: String, value: String, library: &Library) -> Result<()> {
        let document = crate::document::parse(&library.pipeline(&self.pipeline)?)?;
        let crate::document::Root::Pipeline { parts, .. } = &document.root else { return Ok(()) };
        let is_role = parts.iter().any(|(role, _)| role.value == key);
        if is_role {
            self.parts.push((key, value));
        } else if features::effects().any(|flag| flag == key) {
            let simulated = value.parse().map_err(|_| {
                Problem::input("effect-value", format!("`{key}` can't be `{value}`"))
                    .help("true: the effect is simulated; false: it is left out")
            })?;
            // The last word counts, as it does for knobs.
            self.effects.retain(|(other, _)| *other != key);
            self.effects.push((key, simulated));
        } else {
            self.sets.push((key, value));
        }
        Ok(())
    }
}

impl CommonArgs {
    pub fn library(&self) -> Result<Library> {
        self.how.library()
    }

    /// With `--tuned`, gives the subjects the values that are kept for them.
    pub fn tune(&self, subjects: &mut [Subject], library: &Library) -> Result<()> {
        match self.tuned {
            true => Kept::on(self.how.adapter.as_deref())?.put_into(subjects, library),
            false => Ok(()),
        }
    }

    pub fn plan(&self, command: &'static str, scenes: &[PathBuf], subjects: Vec<Subject>) -> Plan {
        let folder = self.out.clone().unwrap_or_else(|| folder(command, scenes));
        self.how.plan(command, scenes, subjects, folder, self.frames)
    }
}

impl HowArgs {
    pub fn library(&self) -> Result<Library> {
        Library::new(self.libraries.clone())
    }

    pub fn plan(
        &self,
        command: &'static str,
        scenes: &[PathBuf],
        subjects: Vec<Subject>,
        folder: PathBuf,
        frames: u32,
    ) -> Plan {
        let otherwise = Until { samples: None, time: Some(DEFAULT_TIME), error: Some(DEFAULT_ERROR) };
        Plan {
            command,
            folder,
            scenes: scenes.to_vec(),
            subjects,
            size: self.size,
            camera: self.camera,
            time: self.time,
            frames,
            repeats: 1,
            shuffle: None,
            reference: self.reference.clone(),
            reference_sets: self.reference_sets.clone(),
            until: self.until.until(otherwise),
            measure: measure::Options { exposure: self.exposure, curve: self.curve },
            adapter: self.adapter.clone(),
            limits: if self.webgpu_limits { LimitSet::Webgpu } else { LimitSet::Adapter },
            wall_clock: self.wall_clock,
        }
    }
}

/// `runs/2026-11-22-093000-compare-cornell-box`.
fn folder(command: &str, scenes: &[PathBuf]) -> PathBuf {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    let now: String =
        now.chars().filter(|c| *c != ':' && *c != 'Z').map(|c| if c == 'T' { '-' } else { c }).collect();
    let scene = scenes.first().and_then(|path| path.file_stem()).unwrap_or_default().to_string_lossy();
    Path::new("runs").join(format!("{now}-{command}-{scene}"))
}

/// The numbers that matter first, for people.
fn table(comparison: &Comparison) -> String {
    let mut text = String::new();
    let widest = comparison.runs.iter().map(|run| run.name.chars().count()).max().unwrap_or(0).max(4);
    let mut line = |line: std::fmt::Arguments<'_>| {
        let _infallible = text.write_fmt(line);
        text.push('\n');
    };
    let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.4}"));
    for scene in &comparison.scenes {
        line(format_args!("{}, {} triangles", scene.name, scene.triangles));
        for (name, reference) in &scene.references {
            let noise = reference.noise.get("color").copied();
            line(format_args!("  {name}: {} samples, noise of color {}", reference.samples, number(noise)));
        }
        line(format_args!(
            "  {:<widest$}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}",
            "run", "ms", "relMSE", "FLIP", "bias", "indirect"
        ));
        for run in comparison.runs.iter().filter(|run| run.scene == scene.name) {
            let error = |output: &str, measure: &str| -> Option<f64> {
                run.errors.get(output)?.get(measure).copied()
            };
            line(format_args!(
                "  {:<widest$}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}",
                run.name,
                run.gpu_ms.median.map_or_else(|| "unknown".to_owned(), |ms| format!("{ms:.2}")),
                number(error("color", "relmse")),
                number(error("color", "flip")),
                number(error("color", "bias")),
                number(error("indirect", "relmse")),
            ));
            lacking(run, &mut line);
        }
    }
    text
}

fn lacking(run: &Run, line: &mut impl FnMut(std::fmt::Arguments<'_>)) {
    if !run.within_noise.is_empty() {
        line(format_args!("    within the reference's noise: {}", run.within_noise.join(", ")));
    }
    for lack in &run.lacks {
        line(format_args!("    left out: {lack}"));
    }
}
