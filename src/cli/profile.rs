//! `voxgi profile`: what each stage takes and moves over many frames.

mod camera;
mod rows;
mod table;

use super::run::{RunArgs, Started, progress, to_json};
use super::{print, print_json};
use crate::document::Cause;
use crate::graph::facts;
use crate::picture::write_bytes;
use crate::problem::{Problem, Result};
use crate::profile::run::{Course, Ran, moves, run as run_course};
use crate::profile::{Profile, copy, trace};
use crate::scene::Camera;
use camera::CameraArgs;
use clap::Args;
use std::path::{Path, PathBuf};

/// Frames that count, unless it is said.
const FRAMES: u32 = 20;

#[derive(Args)]
pub struct ProfileArgs {
    #[command(flatten)]
    run: RunArgs,
    /// Frames that count. Default: as many as the path has, or 20.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,
    /// Frames that don't count, between the first one, which is timed apart, and those that do.
    #[arg(long, value_name = "N", default_value_t = 2)]
    warm_up: u32,
    #[command(flatten)]
    camera: CameraArgs,
    /// Write a trace of the frames that count, for Perfetto or Chrome's trace viewer.
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Write the profile and the trace into this folder, as `profile.json` and `trace.json`.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the profile with all samples as one JSON object.
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &ProfileArgs) -> Result<()> {
    if let Some(file) = args.trace.as_deref().filter(|file| !folder_is_there(file)) {
        let message = format!("`{}` would be in a folder that does not exist", file.display());
        let help = "make the folder first; only that of `--out` is made";
        return Err(Problem::input("no-folder", message).help(help).into());
    }
    let path = args.camera.read()?;
    // The camera that moves is one of the things that change, if any are said at all.
    let moving = path.is_some();
    let ready = args.run.prepare(|request| {
        if moving && request.keep {
            request.varying.insert(facts::bit(Cause::Camera));
        }
    })?;
    let frames = args.frames.or(path.as_ref().and_then(camera::Path::frames)).unwrap_or(FRAMES);
    let base = &ready.scene.cameras[ready.request.camera];
    let cameras: Option<Vec<Camera>> =
        path.as_ref().map(|path| path.cameras(base, &ready.scene.bounds, frames)).transpose()?;
    let mut started = args.run.start(ready, None)?;
    #[cfg(feature = "tracy")]
    let mut tracy = crate::profile::tracy::Tracks::start(&started.frame);
    let ran = sample(args, &mut started, frames, cameras.as_deref(), |_frame, _times, _counters| {
        #[cfg(feature = "tracy")]
        tracy.frame(_frame, _times, _counters);
    })?;
    let copy = copy::measure(&started.gpu, &started.clock)?;
    let record = started.record(&args.run, &ran.samples)?;
    let mut profile = Profile::new(record, &started.frame, &started.scene, &ran.samples, copy);
    profile.warm_up = args.warm_up;
    profile.changes = changes(&started);
    profile.camera_moves = path.map(|path| path.to_string());
    write(args, &started, &ran, &profile)?;
    if args.json {
        print_json(&to_json(&profile)?);
    } else {
        print(&table::text(&profile, table::width()));
    }
    Ok(())
}

fn folder_is_there(file: &Path) -> bool {
    file.parent().is_some_and(|folder| folder.as_os_str().is_empty() || folder.is_dir())
}

/// Runs all frames behind a progress bar.
fn sample(
    args: &ProfileArgs,
    started: &mut Started,
    frames: u32,
    cameras: Option<&[Camera]>,
    mut after: impl FnMut(&crate::frame::Frame, &crate::frame::Times, &[(String, u32)]),
) -> Result<Ran> {
    let [width, height] = args.run.pipeline_args.size.map(f64::from);
    let moves = cameras
        .map(|cameras| moves(&started.frame, cameras, width / height, &started.changes))
        .transpose()?;
    let counters = args.trace.is_some() || args.out.is_some() || cfg!(feature = "tracy");
    let changes = started.changes.clone();
    let course = Course { warm_up: args.warm_up, frames, changes, moves, counters };
    let bar = progress(u64::from(frames) + u64::from(args.warm_up) + 1);
    let ran = run_course(&mut started.frame, &started.gpu, &course, |frame, times, counters| {
        bar.inc(1);
        after(frame, times, counters);
    });
    bar.finish_and_clear();
    Ok(ran?)
}

/// The names of what changes between frames, if not everything does.
fn changes(started: &Started) -> Option<Vec<String>> {
    match &started.changes {
        crate::frame::Changes::All => None,
        crate::frame::Changes::Only(bits) => {
            Some(bits.iter().map(|bit| facts::name_of_bit(&started.frame.graph.plan, *bit)).collect())
        }
    }
}

/// Writes what `--trace` and `--out` ask for.
fn write(args: &ProfileArgs, started: &Started, ran: &Ran, profile: &Profile) -> Result<()> {
    if let Some(folder) = &args.out {
        std::fs::create_dir_all(folder).map_err(|e| {
            Problem::failure("unwritable", format!("can't make the folder `{}`: {e}", folder.display()))
        })?;
        let text = format!("{:#}\n", to_json(profile)?);
        write_bytes(&folder.join("profile.json"), text.as_bytes())?;
    }
    let files: Vec<PathBuf> =
        args.trace.iter().cloned().chain(args.out.iter().map(|folder| folder.join("trace.json"))).collect();
    if files.is_empty() {
        return Ok(());
    }
    let record = &profile.record;
    let about = trace::About {
        adapter: &record.adapter.name,
        driver: &record.adapter.driver_info,
        pipeline: &record.pipeline,
        scene: &record.scene,
        clock: record.clock,
    };
    let text = to_json(&trace::trace(&started.frame, ran, &about))?.to_string();
    files.iter().try_for_each(|file| write_bytes(file, text.as_bytes()))
}
