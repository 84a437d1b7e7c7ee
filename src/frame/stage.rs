//! Pipelines, bind groups and attachments of the stages that run.

use super::memory::Made;
use super::pipeline::RasterKey;
use super::uniforms::Uniforms;
use crate::device::Gpu;
use crate::document::Sampler;
use crate::graph::{Action, Bound, Graph, Linked, Threads};
use crate::kernel::{Choice, Program, Variants};
use crate::plan::ResourceId;
use crate::problem::{Problem, Result};
use crate::schedule::{Placement, Schedule};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::sync::Arc;
use wgpu::{
    BindGroup, Buffer, BufferUsages, ComputePipeline, LoadOp, RenderPipeline, ShaderModule, StoreOp,
    TextureView,
};

/// A stage ready to be encoded.
pub struct MadeStage {
    pub path: String,
    /// One for each parity of the frame number, where the stage touches history.
    pub groups: Vec<BindGroup>,
    pub work: MadeWork,
    pub counters: Option<(Buffer, Vec<String>)>,
}

pub enum MadeWork {
    Compute { pipeline: ComputePipeline, groups: [u32; 3] },
    ComputeIndirect { pipeline: ComputePipeline, buffer: Buffer, offset: u64 },
    Raster(Box<MadeRaster>),
}

pub struct MadeRaster {
    pub pipeline: RenderPipeline,
    pub colors: Vec<Option<Attachment>>,
    pub depth: Option<Attachment>,
    pub draw: MadeDraw,
}

pub enum MadeDraw {
    Vertices(std::ops::Range<u32>),
    Indirect(Buffer, u64),
}

pub struct Attachment {
    /// One for each parity.
    pub views: Vec<TextureView>,
    pub load: LoadOp<f64>,
    pub writes: bool,
    pub(super) cell: (ResourceId, u32),
}

impl Attachment {
    pub fn color(&self, parity: usize) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        let load = match self.load {
            LoadOp::Clear(v) => LoadOp::Clear(wgpu::Color { r: v, g: v, b: v, a: v }),
            _ => LoadOp::Load,
        };
        Some(wgpu::RenderPassColorAttachment {
            view: self.views.get(parity).or(self.views.first())?,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: StoreOp::Store },
        })
    }

    pub fn depth(&self, parity: usize) -> Option<wgpu::RenderPassDepthStencilAttachment<'_>> {
        let load = match self.load {
            LoadOp::Clear(v) => LoadOp::Clear(v as f32),
            _ => LoadOp::Load,
        };
        Some(wgpu::RenderPassDepthStencilAttachment {
            view: self.views.get(parity).or(self.views.first())?,
            depth_ops: self.writes.then_some(wgpu::Operations { load, store: StoreOp::Store }),
            stencil_ops: None,
        })
    }
}

impl MadeStage {
    /// The bind group for frames of this parity.
    pub fn group(&self, parity: usize) -> Option<&BindGroup> {
        self.groups.get(parity).or(self.groups.first())
    }

    /// Lets the stage's own load clear a cell, if the cell is one of its targets; says whether it is.
    pub fn clear(&mut self, item: ResourceId, cell: u32, value: f64) -> bool {
        let MadeWork::Raster(raster) = &mut self.work else { return false };
        let mut attachments = raster.colors.iter_mut().flatten().chain(&mut raster.depth);
        match attachments.find(|a| a.cell == (item, cell) && a.writes) {
            Some(attachment) => {
                attachment.load = LoadOp::Clear(value);
                true
            }
            None => false,
        }
    }
}

/// Makes stages, sharing what is alike.
pub struct Maker<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) graph: &'a Graph,
    pub(super) schedule: &'a Schedule,
    pub(super) made: &'a Made,
    pub(super) uniforms: Buffer,
    pub(super) offsets: Uniforms,
    pub(super) variants: Variants,
    pub(super) modules: FxHashMap<usize, (Arc<Program>, ShaderModule)>,
    pub(super) samplers: FxHashMap<Sampler, wgpu::Sampler>,
    pub(super) compute: FxHashMap<(usize, String), ComputePipeline>,
    pub(super) raster: Vec<(RasterKey, RenderPipeline)>,
}

impl<'a> Maker<'a> {
    /// Places all uniforms, then is ready to make stages. The uniforms come back from [`Maker::finish`].
    pub fn new(gpu: &'a Gpu, graph: &'a Graph, schedule: &'a Schedule, made: &'a Made) -> Self {
        let mut offsets = Uniforms::new(graph, gpu);
        for block in graph.stages.iter().flat_map(|s| &s.linked).flat_map(|l| &l.bindings) {
            if let Bound::Uniform(block) = block {
                offsets.add(block);
            }
        }
        let uniforms = offsets.make(gpu);
        Self {
            gpu,
            graph,
            schedule,
            made,
            uniforms,
            offsets,
            variants: Variants::default(),
            modules: FxHashMap::default(),
            samplers: FxHashMap::default(),
            compute: FxHashMap::default(),
            raster: Vec::new(),
        }
    }

    pub fn finish(self) -> Uniforms {
        self.offsets
    }

    pub fn make(&mut self, task: usize) -> Result<MadeStage> {
        let stage = &self.graph.stages[task];
        let Some(linked) = &stage.linked else {
            return Err(Problem::failure("unlinked", format!("stage `{}` can't be bound", stage.path)).into());
        };
        let named = |problem: Problem| Problem {
            message: format!("stage `{}`: {}", stage.path, problem.message),
            ..problem.at(&stage.place, "this stage")
        };
        let made = self.stage(&stage.path, linked);
        self.gpu.check().map_err(named)?;
        made
    }

    fn stage(&mut self, path: &str, linked: &Linked) -> Result<MadeStage> {
        let program = self.program(linked)?;
        let counters = linked.bindings.iter().find_map(|b| match b {
            Bound::Counters(names) => Some((self.counters(path, names.len()), names.clone())),
            _ => None,
        });
        let layout = self.layout(path, linked, &program);
        let history = linked.touches.iter().any(|t| self.graph.resources[t.reference.resource].slots > 1);
        let parities = if history { 2 } else { 1 };
        let groups = (0..parities)
            .map(|parity| self.group(path, linked, &layout, counters.as_ref().map(|c| &c.0), parity))
            .collect::<Result<_>>()?;
        let work = match &linked.action {
            Action::Compute { entry, workgroup, threads } => {
                let pipeline = self.compute_pipeline(path, &program, entry, &layout);
                match threads {
                    Threads::Count(count) => {
                        let limit = self.gpu.device.limits().max_compute_workgroups_per_dimension;
                        let groups =
                            workgroups(count.unwrap_or([1; 3]), *workgroup, limit).ok_or_else(|| {
                                Problem::input(
                                    "over-limit",
                                    format!(
                                        "stage `{path}` needs more workgroups than {limit} in one dimension"
                                    ),
                                )
                                .help("dispatch over fewer threads, or let each do more")
                            })?;
                        MadeWork::Compute { pipeline, groups }
                    }
                    Threads::Indirect { resource, offset } => {
                        let (buffer, offset) = self.arguments(*resource, *offset)?;
                        MadeWork::ComputeIndirect { pipeline, buffer, offset }
                    }
                }
            }
            Action::Raster(raster) => {
                MadeWork::Raster(Box::new(self.raster(path, &program, raster, &layout, parities)?))
            }
        };
        Ok(MadeStage { path: path.to_owned(), groups, work, counters })
    }

    /// The stage's program; buffers that share memory with one that the stage writes are declared writable.
    fn program(&mut self, linked: &Linked) -> Result<Arc<Program>> {
        let heap = |id: ResourceId| match self.schedule.places[id].placement {
            Placement::Heap { heap, .. } => Some(heap),
            _ => None,
        };
        let written: BTreeSet<u32> =
            linked.touches.iter().filter(|t| t.write).filter_map(|t| heap(t.reference.resource)).collect();
        let writable: BTreeSet<String> = linked
            .touches
            .iter()
            .filter(|t| !t.write && heap(t.reference.resource).is_some_and(|h| written.contains(&h)))
            .map(|t| t.binding.clone())
            .collect();
        if writable.is_empty() {
            return Ok(linked.program.clone());
        }
        let entries: Vec<&str> = match &linked.action {
            Action::Compute { entry, .. } => vec![entry],
            Action::Raster(r) => std::iter::once(r.vertex.as_str()).chain(r.fragment.as_deref()).collect(),
        };
        let choice = Choice { formats: linked.formats.clone(), writable, ..Choice::default() };
        self.variants.finish(&linked.reflected, &entries, &choice)
    }

    fn counters(&self, path: &str, count: usize) -> Buffer {
        self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(path),
            size: (4 * count.max(1) as u64).next_multiple_of(16),
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    pub(super) fn arguments(&self, resource: ResourceId, offset: u64) -> Result<(Buffer, u64)> {
        match self.made.buffer(resource, 0) {
            Some((buffer, start, _)) => Ok((buffer.clone(), start + offset)),
            None => Err(Problem::failure("unmade", "the buffer of arguments was not made").into()),
        }
    }
}

/// Workgroups that cover `threads`. One dimension of too many is folded into the next, if that is empty; kernels that
/// allow for it use `linear_index`.
pub(super) fn workgroups(threads: [u64; 3], size: [u32; 3], limit: u32) -> Option<[u32; 3]> {
    let mut groups = [0u64; 3];
    for i in 0..3 {
        groups[i] = threads[i].div_ceil(u64::from(size[i].max(1))).max(1);
    }
    let limit = u64::from(limit);
    if groups[0] > limit && groups[1] == 1 && groups[2] == 1 {
        let rows = groups[0].div_ceil(limit);
        groups = [groups[0].div_ceil(rows), rows, 1];
    }
    groups.iter().all(|g| *g <= limit).then(|| groups.map(|g| g as u32))
}
