//! `voxgi sweep`, `merge` and `diff`: settings along knobs and parts, what parts of a sweep come to, what changed.

use super::compare::{CommonArgs, make, report, subject};
use super::{print, print_json};
use crate::compare::{Axis, Order, diff, expand, merge, shard};
use crate::comparison::Comparison;
use crate::problem::{Problem, Result};
use crate::report::analysis::{cheapest_within, marginals, points};
use crate::scene::features;
use clap::Args;
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Args)]
pub struct SweepArgs {
    /// Scenes: glTF files and settings.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// The pipeline, with knobs and parts that stay: NAME, NAME,KNOB=VALUE.
    #[arg(short, long, value_name = "NAME[,KEY=VALUE…]")]
    pipeline: String,
    /// Values of a knob; may be repeated for others.
    #[arg(long = "set", value_name = "KNOB=VALUE,VALUE…", value_parser = super::pair)]
    sets: Vec<(String, String)>,
    /// Parts of a role; may be repeated for others.
    #[arg(long = "part", value_name = "ROLE=PART,PART…", value_parser = super::pair)]
    parts: Vec<(String, String)>,
    /// An effect that the scenes call for, by its flag, such as scene.emissive: simulated and left out. May be repeated.
    #[arg(long = "effect", value_name = "FLAG", value_parser = effect)]
    effects: Vec<String>,
    /// One knob, role or effect at a time, the others at their first value. Default: every combination.
    #[arg(long)]
    one_at_a_time: bool,
    /// How often each setting is run, on a device of its own each time.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=100))]
    repeats: u32,
    /// Of the order of running, which is shuffled.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Only a part of the settings, as 2/8: `voxgi merge` joins the parts.
    #[arg(long, value_name = "K/N", value_parser = part_of)]
    shard: Option<(usize, usize)>,
    #[command(flatten)]
    common: CommonArgs,
}

#[derive(Args)]
pub struct MergeArgs {
    /// Folders with parts of one comparison.
    #[arg(required = true)]
    folders: Vec<PathBuf>,
    /// The folder to write into.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Args)]
pub struct DiffArgs {
    /// A folder that `compare` or `sweep` wrote.
    before: PathBuf,
    after: PathBuf,
    /// Print one JSON object.
    #[arg(long)]
    pub json: bool,
}

impl SweepArgs {
    pub fn json(&self) -> bool {
        self.common.json
    }
}

fn part_of(text: &str) -> Result<(usize, usize), String> {
    let pair = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    pair.filter(|(k, n)| (1..=*n).contains(k)).ok_or_else(|| format!("`{text}` is no part such as 2/8"))
}

fn effect(text: &str) -> Result<String, String> {
    match features::effects().any(|known| known == text) {
        true => Ok(text.to_owned()),
        false => Err(format!(
            "`{text}` is no effect: there are {}",
            features::effects().collect::<Vec<_>>().join(", ")
        )),
    }
}

pub fn sweep(args: &SweepArgs) -> Result<()> {
    let library = args.common.library()?;
    let base = subject(&args.pipeline, &library)?;
    let values = |values: &str| values.split(',').map(str::to_owned).collect();
    let parts = args.parts.iter().map(|(role, parts)| Axis::Part(role.clone(), values(parts)));
    let knobs = args.sets.iter().map(|(knob, sets)| Axis::Knob(knob.clone(), values(sets)));
    let effects = args.effects.iter().map(|flag| Axis::Effect(flag.clone()));
    let axes: Vec<Axis> = parts.chain(knobs).chain(effects).collect();
    for (index, axis) in axes.iter().enumerate() {
        if axes[..index].iter().any(|other| other.key() == axis.key()) {
            let message = format!("`{}` is swept twice", axis.key());
            return Err(Problem::input("swept-twice", message)
                .help("give all its values in one list")
                .into());
        }
        if base.coordinates().contains_key(axis.key()) {
            let message = format!("`{}` is swept, and set for `{}` already", axis.key(), base.pipeline);
            return Err(Problem::input("swept-and-set", message).help("leave one of the two away").into());
        }
    }
    let order = if args.one_at_a_time { Order::OneAtATime } else { Order::Grid };
    let mut subjects = expand(&base, &axes, order)?;
    if let Some((number, of)) = args.shard {
        subjects = shard(subjects, number, of);
    }
    args.common.tune(&mut subjects, &library)?;
    let mut plan = args.common.plan("sweep", &args.scenes, subjects);
    (plan.repeats, plan.shuffle) = (args.repeats, Some(args.seed));
    make(&plan, &library, args.common.json)?;
    if !args.common.json
        && let Some(comparison) = Comparison::read(&plan.folder)?
    {
        print(&conclusions(&comparison));
    }
    Ok(())
}

/// What each step of a knob or part costs and brings, and what is cheapest.
fn conclusions(comparison: &Comparison) -> String {
    const PERCENT: f64 = 10.0;
    let mut text = String::new();
    for scene in &comparison.scenes {
        let _infallible = writeln!(text, "{}:", scene.name);
        for step in marginals(&comparison.runs, &scene.name, "color", "relmse") {
            let change = |change: &Option<crate::report::analysis::Change>, unit: &str| {
                change.as_ref().map_or_else(
                    || "unknown".to_owned(),
                    |c| {
                        let ratio = c.ratio.map_or_else(String::new, |ratio| format!(" (×{ratio:.3})"));
                        format!("{:+.4}{unit}{ratio}", c.difference)
                    },
                )
            };
            let _infallible = writeln!(
                text,
                "  {} {} → {}: {}, relMSE {}, from {} pairs",
                step.name,
                step.from,
                step.to,
                change(&step.time, " ms"),
                change(&step.error, ""),
                step.pairs
            );
        }
        let noise =
            scene.references.values().filter_map(|r| r.noise.get("color")).copied().fold(0.0, f64::max);
        let points = points(&comparison.runs, &scene.name, "color", "relmse");
        if let Some(best) = cheapest_within(&points, PERCENT, noise) {
            let _infallible = writeln!(
                text,
                "  the cheapest within {PERCENT} % of the best: {}, {:.2} ms, relMSE {:.4}",
                comparison.runs[best.run].name, best.time, best.error
            );
        }
    }
    text
}

pub fn run_merge(args: &MergeArgs) -> Result<()> {
    let comparison = merge(&args.folders, &args.out)?;
    let page = report(&comparison, &args.out)?;
    print(&format!("{} runs\nreport: {}\n", comparison.runs.len(), page.display()));
    Ok(())
}

pub fn run_diff(args: &DiffArgs) -> Result<()> {
    let read = |folder: &Path| -> Result<Comparison> {
        Ok(Comparison::read(folder)?.ok_or_else(|| {
            Problem::input("comparison-file", format!("there is no comparison in `{}`", folder.display()))
                .help("name folders that `voxgi compare` or `voxgi sweep` wrote")
        })?)
    };
    let (before, after) = (read(&args.before)?, read(&args.after)?);
    let found = diff((&before, &args.before), (&after, &args.after))?;
    if args.json {
        print_json(&serde_json::json!({ "schema": crate::comparison::SCHEMA, "differences": found }));
        return Ok(());
    }
    let mut text = String::new();
    let mut run: Option<&str> = None;
    for difference in &found {
        if run != Some(difference.run.as_str()) && !difference.run.is_empty() {
            let _infallible = writeln!(text, "{}", difference.run);
        }
        run = Some(&difference.run);
        let indent = if difference.run.is_empty() { "" } else { "  " };
        let _infallible = writeln!(text, "{indent}{difference}");
    }
    print(if found.is_empty() { "nothing differs\n" } else { &text });
    Ok(())
}
