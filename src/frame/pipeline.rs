//! Compute and render pipelines, shared between stages that are alike.

use super::convert::{blend_state, compare_function};
use super::stage::{Attachment, MadeDraw, MadeRaster, Maker};
use crate::graph::{Draw, Raster, Shape};
use crate::kernel::Program;
use crate::plan::Reference;
use crate::problem::{Problem, Result};
use std::sync::Arc;
use wgpu::{BindGroupLayout, ComputePipeline, LoadOp, RenderPipeline, ShaderModule};

/// What makes a render pipeline another one.
pub type RasterKey = (usize, Vec<Option<wgpu::ColorTargetState>>, Option<wgpu::DepthStencilState>, bool);

impl Maker<'_> {
    fn module(&mut self, path: &str, program: &Arc<Program>) -> (usize, ShaderModule) {
        let key = Arc::as_ptr(program) as usize;
        let gpu = self.gpu;
        let (_, module) = self.modules.entry(key).or_insert_with(|| {
            let source = wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(program.module.clone()));
            let descriptor = wgpu::ShaderModuleDescriptor { label: Some(path), source };
            (program.clone(), gpu.device.create_shader_module(descriptor))
        });
        (key, module.clone())
    }

    pub fn compute_pipeline(
        &mut self,
        path: &str,
        program: &Arc<Program>,
        entry: &str,
        layout: &BindGroupLayout,
    ) -> ComputePipeline {
        let (key, module) = self.module(path, program);
        if let Some(pipeline) = self.compute.get(&(key, entry.to_owned())) {
            return pipeline.clone();
        }
        let pipeline = self.gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(path),
            layout: Some(&self.pipeline_layout(path, layout)),
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        });
        self.compute.insert((key, entry.to_owned()), pipeline.clone());
        pipeline
    }

    fn pipeline_layout(&self, path: &str, layout: &BindGroupLayout) -> wgpu::PipelineLayout {
        self.gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(path),
            bind_group_layouts: &[Some(layout)],
            immediate_size: 0,
        })
    }

    pub fn raster(
        &mut self,
        path: &str,
        program: &Arc<Program>,
        raster: &Raster,
        layout: &BindGroupLayout,
        parities: usize,
    ) -> Result<MadeRaster> {
        let attachment = |reference: &Reference, writes: bool| {
            let views =
                (0..parities).filter_map(|p| self.view(reference, wgpu::TextureViewDimension::D2, true, p));
            let cell = self.graph.cells(reference).first().copied().unwrap_or(0);
            Attachment {
                views: views.collect(),
                load: LoadOp::Load,
                writes,
                cell: (reference.resource, cell),
            }
        };
        let colors = raster.targets.iter().map(|t| t.as_ref().map(|r| attachment(r, true))).collect();
        let depth = raster.depth.as_ref().map(|(r, _, write)| attachment(r, *write));
        let draw = match &raster.draw {
            Draw::Vertices(range) => MadeDraw::Vertices(vertices(path, range.unwrap_or_default())?),
            Draw::Points(count) => MadeDraw::Vertices(vertices(path, (0, count.unwrap_or(0)))?),
            Draw::Indirect { resource, offset } => {
                let (buffer, offset) = self.arguments(*resource, *offset)?;
                MadeDraw::Indirect(buffer, offset)
            }
        };
        let pipeline = self.raster_pipeline(path, program, raster, layout);
        Ok(MadeRaster { pipeline, colors, depth, draw })
    }

    fn raster_pipeline(
        &mut self,
        path: &str,
        program: &Arc<Program>,
        raster: &Raster,
        layout: &BindGroupLayout,
    ) -> RenderPipeline {
        let format = |reference: &Reference| match &self.graph.resources[reference.resource].shape {
            Shape::Texture(shape) => Some(shape.format),
            _ => None,
        };
        let targets: Vec<Option<wgpu::ColorTargetState>> = raster
            .targets
            .iter()
            .map(|target| {
                let format = format(target.as_ref()?)?;
                Some(wgpu::ColorTargetState {
                    format,
                    blend: raster.blend.map(blend_state),
                    write_mask: wgpu::ColorWrites::ALL,
                })
            })
            .collect();
        let depth = raster.depth.as_ref().and_then(|(reference, compare, write)| {
            Some(wgpu::DepthStencilState {
                format: format(reference)?,
                depth_write_enabled: Some(*write),
                depth_compare: Some(compare_function(*compare)),
                stencil: Default::default(),
                bias: Default::default(),
            })
        });
        let points = matches!(raster.draw, Draw::Points(_));
        let (module_key, module) = self.module(path, program);
        let key = (module_key, targets, depth, points);
        if let Some((_, pipeline)) = self.raster.iter().find(|(k, _)| *k == key) {
            return pipeline.clone();
        }
        let pipeline = self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(path),
            layout: Some(&self.pipeline_layout(path, layout)),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(&raster.vertex),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState {
                topology: if points {
                    wgpu::PrimitiveTopology::PointList
                } else {
                    wgpu::PrimitiveTopology::TriangleList
                },
                ..Default::default()
            },
            depth_stencil: key.2.clone(),
            multisample: Default::default(),
            fragment: raster.fragment.as_ref().map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &key.1,
            }),
            multiview_mask: None,
            cache: None,
        });
        self.raster.push((key, pipeline.clone()));
        pipeline
    }
}

/// The range of a draw call.
fn vertices(path: &str, (first, count): (u64, u64)) -> Result<std::ops::Range<u32>> {
    let index = |n: u64| {
        u32::try_from(n).map_err(|_| {
            let message = format!("stage `{path}` draws vertices up to number {n}, more than 2^32");
            Problem::input("over-limit", message)
        })
    };
    Ok(index(first)?..index(first.saturating_add(count))?)
}
