//! `voxgi profile`: what each stage takes and moves over many frames.

mod camera;
mod rows;
mod table;

use super::run::{RunArgs, Started, progress, to_json};
use super::{print, print_json};
use crate::device::Gpu;
use crate::document::Cause;
use crate::frame::{Changes, Frame, Times};
use crate::graph::facts;
use crate::picture::write_bytes;
use crate::problem::{Problem, Result};
use crate::profile::run::{Course, Ran, Subject, run as run_course};
use crate::profile::{Profile, copy, trace};
use crate::scene::Camera;
use camera::CameraArgs;
use clap::Args;
use indicatif::ProgressBar;
use std::path::PathBuf;

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
    let ran = {
        let bar = progress(u64::from(frames) + u64::from(args.warm_up) + 1);
        let counters = args.trace.is_some() || args.out.is_some() || cfg!(feature = "tracy");
        let course = Course { warm_up: args.warm_up, frames, counters };
        let mut subject = Watched {
            started: &mut started,
            cameras: cameras.as_deref(),
            bar: &bar,
            #[cfg(feature = "tracy")]
            tracy: &mut tracy,
        };
        let ran = run_course(&mut subject, course);
        bar.finish_and_clear();
        ran?
    };
    let copy = copy::measure(&started.gpu, &started.clock)?;
    let record = started.record(&args.run, &ran.samples)?;
    let mut profile = Profile::new(record, &started.frame, started.scene(), &ran.samples, copy);
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

/// Frames behind a progress bar, with the scene and the camera moving as was asked.
struct Watched<'a> {
    started: &'a mut Started,
    /// One for each frame that counts.
    cameras: Option<&'a [Camera]>,
    bar: &'a ProgressBar,
    #[cfg(feature = "tracy")]
    tracy: &'a mut crate::profile::tracy::Tracks,
}

impl Subject for Watched<'_> {
    fn before(&mut self, counted: Option<u32>) -> Result<Changes> {
        match counted {
            None => Ok(self.started.changes.clone()),
            Some(index) => {
                let camera = self.cameras.and_then(|cameras| cameras.get(index as usize));
                self.started.go_to(index + 1, camera)
            }
        }
    }

    fn frame(&mut self) -> (&mut Frame, &Gpu) {
        (&mut self.started.frame, &self.started.gpu)
    }

    fn after(&mut self, _times: &Times, _counters: &[(String, u32)]) {
        self.bar.inc(1);
        #[cfg(feature = "tracy")]
        self.tracy.frame(&self.started.frame, _times, _counters);
    }
}

/// The names of what changes between frames, if not everything does.
fn changes(started: &Started) -> Option<Vec<String>> {
    match &started.changes {
        Changes::All => None,
        Changes::Only(bits) => {
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
