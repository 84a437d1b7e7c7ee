//! Bind group layouts, views and bind groups.

use super::convert::{binding_type, make_sampler};
use super::stage::Maker;
use crate::graph::{Bound, Graph, Linked, Shape};
use crate::kernel::Program;
use crate::plan::{Reference, ResourceId};
use crate::problem::{Problem, Result};
use wgpu::{BindGroup, BindGroupEntry, BindGroupLayout, BindingResource, Buffer, TextureView};

impl Maker<'_> {
    pub fn layout(&self, path: &str, linked: &Linked, program: &Program) -> BindGroupLayout {
        let entries: Vec<_> = linked
            .bindings
            .iter()
            .zip(&program.bindings)
            .enumerate()
            .map(|(number, (bound, program))| wgpu::BindGroupLayoutEntry {
                binding: number as u32,
                visibility: program.visibility,
                ty: binding_type(bound, &program.binding.kind),
                count: None,
            })
            .collect();
        self.gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(path),
            entries: &entries,
        })
    }

    pub fn group(
        &mut self,
        path: &str,
        linked: &Linked,
        layout: &BindGroupLayout,
        counters: Option<&Buffer>,
        parity: usize,
    ) -> Result<BindGroup> {
        enum Held {
            View(TextureView),
            Sampler(wgpu::Sampler),
            Buffer(Buffer, u64, u64),
        }
        let unmade = |id: ResourceId| {
            Problem::failure("unmade", format!("`{}` was not made", self.graph.plan.resources[id].path))
        };
        let mut held = Vec::with_capacity(linked.bindings.len());
        for bound in &linked.bindings {
            held.push(match bound {
                Bound::Uniform(block) => Held::Buffer(
                    self.uniforms.clone(),
                    self.offsets.add(block),
                    block.bytes.len().max(16) as u64,
                ),
                Bound::Buffer { resource, previous } => {
                    let slot = slot(self.graph, *resource, *previous, parity);
                    let (buffer, offset, size) =
                        self.made.buffer(*resource, slot).ok_or_else(|| unmade(*resource))?;
                    Held::Buffer(buffer.clone(), *offset, *size)
                }
                Bound::Texture { reference, dimension, .. }
                | Bound::StorageTexture { reference, dimension, .. } => {
                    let one_mip = matches!(bound, Bound::StorageTexture { .. });
                    let view = self.view(reference, *dimension, one_mip, parity);
                    Held::View(view.ok_or_else(|| unmade(reference.resource))?)
                }
                Bound::Sampler(sampler) => {
                    let gpu = self.gpu;
                    let made =
                        self.samplers.entry(sampler.clone()).or_insert_with(|| make_sampler(gpu, sampler));
                    Held::Sampler(made.clone())
                }
                Bound::Counters(_) => match counters {
                    Some(buffer) => Held::Buffer(buffer.clone(), 0, buffer.size()),
                    None => continue,
                },
            });
        }
        let entries: Vec<_> = held
            .iter()
            .enumerate()
            .map(|(number, held)| BindGroupEntry {
                binding: number as u32,
                resource: match held {
                    Held::View(view) => BindingResource::TextureView(view),
                    Held::Sampler(sampler) => BindingResource::Sampler(sampler),
                    Held::Buffer(buffer, offset, size) => BindingResource::Buffer(wgpu::BufferBinding {
                        buffer,
                        offset: *offset,
                        size: wgpu::BufferSize::new(*size),
                    }),
                },
            })
            .collect();
        let descriptor = wgpu::BindGroupDescriptor { label: Some(path), layout, entries: &entries };
        Ok(self.gpu.device.create_bind_group(&descriptor))
    }

    /// The view of a reference, in the dimension that the kernel or the target wants.
    pub fn view(
        &self,
        reference: &Reference,
        dimension: wgpu::TextureViewDimension,
        one_mip: bool,
        parity: usize,
    ) -> Option<TextureView> {
        let slot = slot(self.graph, reference.resource, reference.previous, parity);
        let texture = self.made.texture(reference.resource, slot)?;
        let Shape::Texture(shape) = &self.graph.resources[reference.resource].shape else { return None };
        let mips = if one_mip || reference.mip.is_some() { 1 } else { shape.mips };
        let layers = if reference.layer.is_some() { 1 } else { shape.layers };
        let aspect = if shape.format.has_depth_aspect() && !one_mip {
            wgpu::TextureAspect::DepthOnly
        } else {
            wgpu::TextureAspect::All
        };
        Some(texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some(&self.graph.plan.resources[reference.resource].path),
            dimension: Some(dimension),
            aspect,
            base_mip_level: reference.mip.unwrap_or(0),
            mip_level_count: Some(mips),
            base_array_layer: reference.layer.unwrap_or(0),
            array_layer_count: Some(layers),
            ..Default::default()
        }))
    }
}

/// The history slot that a reference means in frames of this parity.
fn slot(graph: &Graph, resource: ResourceId, previous: bool, parity: usize) -> usize {
    if graph.resources[resource].slots < 2 { 0 } else { (parity + usize::from(previous)) % 2 }
}
