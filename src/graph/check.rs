//! Checks on a linked stage and on the graph as a whole.

use super::{Graph, Resource, Shape, Touch, Usage};
use crate::plan::{Plan, PlannedStage, Reference};
use crate::problem::Problem;
use wgpu_types::Limits;

/// Whether two references mean some cell in common.
fn overlap(a: &Reference, b: &Reference) -> bool {
    let same = |x: Option<u32>, y: Option<u32>| x.is_none() || y.is_none() || x == y;
    a.resource == b.resource && a.previous == b.previous && same(a.mip, b.mip) && same(a.layer, b.layer)
}

/// What no device allows within one stage: a cell written and used in another way, at once.
pub fn stage(plan: &Plan, stage: &PlannedStage, resources: &[Resource], touches: &[Touch]) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (i, a) in touches.iter().enumerate() {
        for b in &touches[i + 1..] {
            let writes = a.write || b.write;
            // A depth target that is also sampled is read twice, which is fine when it is not written.
            if !writes || !overlap(&a.reference, &b.reference) {
                continue;
            }
            let texture =
                matches!(resources.get(a.reference.resource).map(|r| &r.shape), Some(Shape::Texture(_)));
            let name = &plan.resources[a.reference.resource].path;
            let (written, other) = if a.write { (a, b) } else { (b, a) };
            let verb = match other.how {
                Usage::Sampled => "sampled",
                Usage::Indirect => "read as arguments",
                _ if other.write => "written",
                _ => "read",
            };
            problems.push(
                Problem::input(
                    "written-and-read",
                    format!(
                        "stage `{}`: `{name}` is {verb} (as `{}`) while it is written (as `{}`)",
                        stage.path, other.binding, written.binding
                    ),
                )
                .at(&stage.place, "by this stage")
                .help(if texture {
                    "bind different mips or layers, or two textures in turn (`Repeat(swap: …)`, `@previous`)"
                } else {
                    "use two buffers; arguments and counters can't be one buffer in one dispatch"
                }),
            );
        }
    }
    problems
}

/// Outputs must be textures.
pub fn outputs(graph: &Graph) -> Vec<Problem> {
    let not_texture = graph.plan.outputs.iter().filter(|(_, reference, _)| {
        !matches!(graph.resources.get(reference.resource).map(|r| &r.shape), Some(Shape::Texture(_)))
    });
    not_texture
        .map(|(name, reference, place)| {
            Problem::input("output-kind", format!("the output `{name}` must be a texture"))
                .at(place, format!("`{}` is none, or nothing writes it", graph.name(reference)))
        })
        .collect()
}

/// What `limits` (an adapter's, or WebGPU's guaranteed ones) and `features` do not allow.
pub fn limits(graph: &Graph, limits: &Limits, whose: &str) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (resource, planned) in graph.resources.iter().zip(&graph.plan.resources) {
        let over = |what: &str, is: u64, most: u64| {
            Problem::input(
                "over-limit",
                format!("`{}`: {what} is {is}, and {whose} allows {most}", planned.path),
            )
            .at(&planned.place, "this resource")
            .help("choose a smaller size: `--size`, or the knob it depends on")
        };
        match &resource.shape {
            Shape::Texture(texture) => {
                use wgpu_types::TextureDimension as D;
                let most = match texture.dimension {
                    D::D1 => limits.max_texture_dimension_1d,
                    D::D2 => limits.max_texture_dimension_2d,
                    D::D3 => limits.max_texture_dimension_3d,
                };
                let largest = texture.size.map_or(0, |s| s.into_iter().max().unwrap_or(0));
                if largest > most {
                    problems.push(over("its size", largest.into(), most.into()));
                }
                if texture.layers > limits.max_texture_array_layers {
                    problems.push(over(
                        "its number of layers",
                        texture.layers.into(),
                        limits.max_texture_array_layers.into(),
                    ));
                }
            }
            Shape::Buffer(buffer) => {
                let bytes = buffer.bytes.unwrap_or(0);
                let binding = limits.max_storage_buffer_binding_size;
                if bytes > binding {
                    problems.push(over("its size in bytes", bytes, binding));
                } else if bytes > limits.max_buffer_size {
                    problems.push(over("its size in bytes", bytes, limits.max_buffer_size));
                }
            }
            Shape::Scene | Shape::Unused => {}
        }
    }
    for stage in &graph.stages {
        let Some(linked) = &stage.linked else { continue };
        problems.extend(stage_limits(stage, linked, limits, whose));
    }
    problems
}

/// Bytes that the variables of a workgroup take.
fn workgroup_bytes(module: &naga::Module) -> u32 {
    let variables = module.global_variables.iter().map(|(_, variable)| variable);
    variables.filter(|variable| variable.space == naga::AddressSpace::WorkGroup).fold(0, |bytes, variable| {
        bytes.saturating_add(module.types[variable.ty].inner.size(module.to_ctx()))
    })
}

fn stage_limits(stage: &super::Stage, linked: &super::Linked, limits: &Limits, whose: &str) -> Vec<Problem> {
    use super::Bound as B;
    let count = |wanted: fn(&B) -> bool| linked.bindings.iter().filter(|b| wanted(b)).count() as u32;
    let mut uses = vec![
        (
            "storage buffers",
            count(|b| matches!(b, B::Buffer { .. } | B::Counters(_))),
            limits.max_storage_buffers_per_shader_stage,
        ),
        (
            "storage textures",
            count(|b| matches!(b, B::StorageTexture { .. })),
            limits.max_storage_textures_per_shader_stage,
        ),
        (
            "sampled textures",
            count(|b| matches!(b, B::Texture { .. })),
            limits.max_sampled_textures_per_shader_stage,
        ),
        ("samplers", count(|b| matches!(b, B::Sampler(_))), limits.max_samplers_per_shader_stage),
        (
            "uniform buffers",
            count(|b| matches!(b, B::Uniform(_))),
            limits.max_uniform_buffers_per_shader_stage,
        ),
    ];
    match &linked.action {
        super::Action::Compute { workgroup, .. } => {
            let invocations = workgroup.iter().product();
            uses.push(("threads in a workgroup", invocations, limits.max_compute_invocations_per_workgroup));
            let memory = workgroup_bytes(&linked.program.module);
            uses.push(("bytes of workgroup memory", memory, limits.max_compute_workgroup_storage_size));
        }
        super::Action::Raster(raster) => {
            uses.push(("colour targets", raster.targets.len() as u32, limits.max_color_attachments));
        }
    }
    uses.into_iter()
        .filter(|(_, is, most)| is > most)
        .map(|(what, is, most)| {
            Problem::input(
                "over-limit",
                format!("stage `{}` has {is} {what}, {whose} allows {most}", stage.path),
            )
            .at(&stage.place, "this stage")
            .help("split the stage, or put several into one (slabs of a texture, fields of a buffer)")
        })
        .collect()
}
