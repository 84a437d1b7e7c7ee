//! Render targets: a fragment entry's outputs by name, their formats, and the size they must share.

use super::binding::{format_name, missing};
use super::{Resource, Shape, Touch, Usage};
use crate::kernel::{Entry, Scalar};
use crate::plan::{DepthUse, Draw, Named, Plan, PlannedStage, Reference};
use crate::problem::Problem;
use std::collections::BTreeSet;
use wgpu_types::TextureSampleType;

/// The resource behind each output of the fragment entry, by location.
pub fn resolve(
    plan: &Plan,
    stage: &PlannedStage,
    resources: &[Resource],
    entries: &[&Entry],
    used: &mut BTreeSet<String>,
    problems: &mut Vec<Problem>,
) -> Vec<Option<Reference>> {
    let mut targets: Vec<Option<Reference>> = Vec::new();
    for entry in entries {
        for output in &entry.targets {
            let found = match stage.bind.get(&output.name) {
                Some((reference, _)) => {
                    used.insert(output.name.clone());
                    Some(*reference)
                }
                None => match plan.lookup(stage.scope, &output.name) {
                    Some(Named::Resource(reference)) => Some(*reference),
                    _ => None,
                },
            };
            let Some(reference) = found else {
                let label = format!("this entry point writes the target `{}`", output.name);
                problems.push(missing(plan, stage, stage.scope, &output.name, (&entry.place, label)));
                continue;
            };
            if let Some(problem) = misfit(plan, stage, resources, &reference, &output.name, output.scalar) {
                problems.push(problem);
                continue;
            }
            let location = output.location as usize;
            if targets.len() <= location {
                targets.resize(location + 1, None);
            }
            targets[location] = Some(one_image(&reference));
        }
    }
    targets
}

/// A target is one mip of one layer.
fn one_image(reference: &Reference) -> Reference {
    Reference { mip: Some(reference.mip.unwrap_or(0)), ..*reference }
}

fn misfit(
    plan: &Plan,
    stage: &PlannedStage,
    resources: &[Resource],
    reference: &Reference,
    name: &str,
    scalar: Scalar,
) -> Option<Problem> {
    let planned = plan.resources.get(reference.resource)?;
    let problem = |message: String| {
        Some(
            Problem::input("format", format!("stage `{}`: {message}", stage.path))
                .at(&planned.place, "the resource")
                .at(&stage.kernel_place, format!("writes it as the target `{name}`")),
        )
    };
    let Shape::Texture(texture) = &resources.get(reference.resource)?.shape else {
        return problem(format!("the target `{name}` must be a texture, and `{}` is none", planned.path));
    };
    let format = format_name(texture.format);
    let wants = match texture.format.sample_type(None, None) {
        Some(TextureSampleType::Float { .. }) => Scalar::F32,
        Some(TextureSampleType::Sint) => Scalar::I32,
        Some(TextureSampleType::Uint) => Scalar::U32,
        _ => return problem(format!("`{}` has the format {format}, which is no colour", planned.path)),
    };
    if wants != scalar {
        return problem(format!(
            "the target `{name}` is written as {scalar:?}, but `{}` has the format {format}",
            planned.path
        ));
    }
    if texture.array && reference.layer.is_none() && texture.layers > 1 {
        return problem(format!("the target `{name}` is one layer of `{}`: say which", planned.path));
    }
    None
}

/// What a raster stage does to its targets. Only a draw that covers the screen writes every texel; any other needs
/// what was there before.
pub fn touch(
    targets: &[Option<Reference>],
    depth: Option<&DepthUse>,
    draw: &Draw,
    blended: bool,
    touches: &mut Vec<Touch>,
) {
    let keeps = blended || *draw != Draw::Screen || depth.is_some();
    for reference in targets.iter().flatten() {
        touches.push(Touch {
            reference: *reference,
            read: keeps,
            write: true,
            how: Usage::Color,
            binding: "target".into(),
        });
    }
    if let Some(depth) = depth {
        touches.push(Touch {
            reference: one_image(&depth.target),
            read: true,
            write: depth.write,
            how: Usage::Depth,
            binding: "depth".into(),
        });
    }
}

/// The size that all targets share, if known.
pub fn size(
    plan: &Plan,
    stage: &PlannedStage,
    resources: &[Resource],
    targets: &[Option<Reference>],
    depth: Option<&DepthUse>,
    problems: &mut Vec<Problem>,
) -> Option<[u32; 2]> {
    let depth_target = depth.map(|d| d.target);
    let mut first: Option<(Reference, [u32; 2])> = None;
    let mut any = false;
    for reference in targets.iter().flatten().chain(&depth_target) {
        any = true;
        let Shape::Texture(texture) = &resources.get(reference.resource)?.shape else { continue };
        if Some(*reference) == depth_target && !texture.format.has_depth_aspect() {
            problems.push(
                Problem::input(
                    "format",
                    format!(
                        "stage `{}`: `{}` has the format {}, which holds no depth",
                        stage.path,
                        plan.resources[reference.resource].path,
                        format_name(texture.format)
                    ),
                )
                .at(&plan.resources[reference.resource].place, "the resource")
                .help("depth32float does"),
            );
        }
        let Some([w, h, _]) = texture.mip_size(reference.mip.unwrap_or(0)) else { continue };
        match first {
            None => first = Some((*reference, [w, h])),
            Some((other, size)) if size != [w, h] => problems.push(
                Problem::input(
                    "target-sizes",
                    format!(
                        "stage `{}`: targets differ in size: `{}` has {}x{}, `{}` has {w}x{h}",
                        stage.path,
                        plan.resources[other.resource].path,
                        size[0],
                        size[1],
                        plan.resources[reference.resource].path
                    ),
                )
                .at(&stage.place, "this stage"),
            ),
            Some(_) => {}
        }
    }
    if !any && problems.is_empty() {
        problems.push(
            Problem::input("no-target", format!("stage `{}` draws into nothing", stage.path))
                .at(&stage.place, "this stage")
                .help("a raster stage needs a fragment output or a `depth` target"),
        );
    }
    first.map(|(_, size)| size)
}
