//! What the formats of resources can't do on a device, of what the stages ask of them.

use super::binding::format_name;
use super::{Bound, Graph, Shape, Stage, Usage};
use crate::plan::Reference;
use crate::problem::Problem;
use wgpu_types::{
    StorageTextureAccess as Access, TextureFormat, TextureFormatFeatureFlags as Flags, TextureFormatFeatures,
    TextureUsages,
};

/// Checks every use of every texture; `features` says what a format can do, `whose` which device that is.
pub fn check(
    graph: &Graph,
    features: &dyn Fn(TextureFormat) -> TextureFormatFeatures,
    whose: &str,
) -> Vec<Problem> {
    let mut problems: Vec<Problem> = Vec::new();
    for stage in &graph.stages {
        let uses = stage.linked.iter().flat_map(|linked| {
            let touches = linked.touches.iter().filter_map(|t| Some((t.reference, attached(t.how)?)));
            touches.chain(linked.bindings.iter().filter_map(bound))
        });
        for (reference, (usage, flag, what)) in uses {
            let Some(Shape::Texture(texture)) = graph.resources.get(reference.resource).map(|r| &r.shape)
            else {
                continue;
            };
            let can = features(texture.format);
            // Depth is compared, not filtered; every device can do that.
            let flag = if texture.format.has_depth_aspect() { Flags::empty() } else { flag };
            if !can.allowed_usages.contains(usage) || !can.flags.contains(flag) {
                let problem = refused(graph, stage, &reference, texture.format, what, whose);
                if !problems.iter().any(|p| p.message == problem.message) {
                    problems.push(problem);
                }
            }
        }
    }
    problems
}

type Need = (TextureUsages, Flags, &'static str);

fn attached(how: Usage) -> Option<Need> {
    match how {
        Usage::Color | Usage::Depth => Some((TextureUsages::RENDER_ATTACHMENT, Flags::empty(), "draw into")),
        _ => None,
    }
}

fn bound(bound: &Bound) -> Option<(Reference, Need)> {
    match bound {
        Bound::Texture { reference, filterable, .. } => {
            let (flag, what) =
                if *filterable { (Flags::FILTERABLE, "filter") } else { (Flags::empty(), "read") };
            Some((*reference, (TextureUsages::TEXTURE_BINDING, flag, what)))
        }
        Bound::StorageTexture { reference, access, .. } => {
            let (flag, what) = match access {
                Access::WriteOnly => (Flags::STORAGE_WRITE_ONLY, "write, as a storage texture,"),
                Access::ReadOnly => (Flags::STORAGE_READ_ONLY, "read, as a storage texture,"),
                Access::ReadWrite => (Flags::STORAGE_READ_WRITE, "read and write, as a storage texture,"),
                Access::Atomic => (Flags::STORAGE_ATOMIC, "change by atomics"),
            };
            Some((*reference, (TextureUsages::STORAGE_BINDING, flag, what)))
        }
        _ => None,
    }
}

fn refused(
    graph: &Graph,
    stage: &Stage,
    reference: &Reference,
    format: TextureFormat,
    what: &str,
    whose: &str,
) -> Problem {
    let planned = &graph.plan.resources[reference.resource];
    Problem::input(
        "lacks-feature",
        format!("{whose} can't {what} {}, the format of `{}`", format_name(format), planned.path),
    )
    .at(&planned.place, "the resource")
    .at(&stage.place, "this stage does so")
    .help("choose another format, or another adapter: `voxgi devices` lists what each can do")
}
