//! Textures and buffers, made as the schedule placed them.

use super::Setup;
use crate::graph::{BufferShape, Graph, Shape, TextureShape};
use crate::plan::ResourceId;
use crate::problem::{Problem, Result};
use crate::schedule::{Placement, Schedule};
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;
use wgpu::{Buffer, BufferUsages, Texture, TextureDescriptor, TextureUsages};

/// Where a resource's content is: one entry for each history slot.
pub enum Place {
    Textures(Vec<Texture>),
    /// Buffer, offset and bytes.
    Buffers(Vec<(Buffer, u64, u64)>),
    Unmade,
}

/// All resources, by id.
pub struct Made {
    pub places: Vec<Place>,
}

impl Made {
    pub fn texture(&self, id: ResourceId, slot: usize) -> Option<&Texture> {
        match self.places.get(id)? {
            Place::Textures(textures) => textures.get(slot),
            _ => None,
        }
    }

    pub fn buffer(&self, id: ResourceId, slot: usize) -> Option<&(Buffer, u64, u64)> {
        match self.places.get(id)? {
            Place::Buffers(buffers) => buffers.get(slot),
            _ => None,
        }
    }
}

pub fn make(graph: &Graph, schedule: &Schedule, setup: &Setup<'_>) -> Result<Made> {
    let gpu = setup.gpu;
    let mut objects: FxHashMap<(u32, u32), Texture> = FxHashMap::default();
    let heap_usage = heap_usage(graph, schedule);
    let heaps: FxHashMap<u32, Buffer> = schedule
        .memory
        .heaps
        .iter()
        .map(|(heap, bytes)| (*heap, buffer(setup, "shared memory", *bytes, heap_usage)))
        .collect();
    let mut places = Vec::with_capacity(graph.resources.len());
    for (id, resource) in graph.resources.iter().enumerate() {
        let path = &graph.plan.resources[id].path;
        let placement = &schedule.places[id].placement;
        places.push(match (&resource.shape, placement) {
            (Shape::Unused, _) => Place::Unmade,
            // Its number of cells does not matter: the scene's buffers are made if some stage that runs binds them.
            (Shape::Scene, _) if binds(graph, schedule, id) => {
                let bytes = setup.scene.bytes(path).unwrap_or_default();
                let buffer =
                    buffer(setup, path, bytes.len() as u64, BufferUsages::STORAGE | BufferUsages::COPY_DST);
                gpu.queue.write_buffer(&buffer, 0, &bytes);
                Place::Buffers(vec![(buffer, 0, bytes.len() as u64)])
            }
            (Shape::Scene, _) | (_, Placement::Unmade | Placement::Given) => Place::Unmade,
            (Shape::Buffer(shape), Placement::Heap { heap, offset }) => match heaps.get(heap) {
                Some(heap) => Place::Buffers(vec![(heap.clone(), *offset, shape.bytes.unwrap_or(4))]),
                None => Place::Unmade,
            },
            (Shape::Buffer(shape), _) => {
                let bytes = known(shape, path)?;
                let slot = |_| (buffer(setup, path, bytes, shape.usage), 0, bytes);
                Place::Buffers((0..resource.slots).map(slot).collect())
            }
            (Shape::Texture(shape), Placement::Object { pool, object }) => {
                let key = (*pool, *object);
                let texture = match objects.entry(key) {
                    Entry::Occupied(made) => made.get().clone(),
                    Entry::Vacant(free) => {
                        let usage = joined(graph, schedule, key);
                        free.insert(texture(setup, path, shape, usage)?).clone()
                    }
                };
                Place::Textures(vec![texture])
            }
            (Shape::Texture(shape), _) => {
                let slots = (0..resource.slots).map(|_| texture(setup, path, shape, shape.usage));
                Place::Textures(slots.collect::<Result<_>>()?)
            }
        });
        gpu.check().map_err(|p| Problem { message: format!("resource `{path}`: {}", p.message), ..p })?;
    }
    Ok(Made { places })
}

fn known(shape: &BufferShape, path: &str) -> Result<u64> {
    shape.bytes.ok_or_else(|| {
        Problem::failure("unknown-size", format!("the size of `{path}` is not known for this scene")).into()
    })
}

/// Whether some stage of the schedule binds the resource.
fn binds(graph: &Graph, schedule: &Schedule, id: ResourceId) -> bool {
    schedule.steps.iter().any(|step| match step {
        crate::schedule::Step::Run { task, .. } => {
            let touches = graph.stages[*task].linked.iter().flat_map(|l| &l.touches);
            touches.into_iter().any(|t| t.reference.resource == id)
        }
        crate::schedule::Step::Start { .. } => false,
    })
}

fn heap_usage(graph: &Graph, schedule: &Schedule) -> BufferUsages {
    let shapes = graph.resources.iter().zip(&schedule.places);
    shapes
        .filter_map(|(resource, placement)| match (&resource.shape, &placement.placement) {
            (Shape::Buffer(shape), Placement::Heap { .. }) => Some(shape.usage),
            _ => None,
        })
        .fold(BufferUsages::empty(), |all, usage| all | usage)
}

/// The usages of all textures that share one object.
fn joined(graph: &Graph, schedule: &Schedule, key: (u32, u32)) -> TextureUsages {
    let shapes = graph.resources.iter().zip(&schedule.places);
    shapes
        .filter_map(|(resource, placement)| match (&resource.shape, &placement.placement) {
            (Shape::Texture(shape), Placement::Object { pool, object }) if (*pool, *object) == key => {
                Some(shape.usage)
            }
            _ => None,
        })
        .fold(TextureUsages::empty(), |all, usage| all | usage)
}

fn buffer(setup: &Setup<'_>, label: &str, size: u64, usage: BufferUsages) -> Buffer {
    setup.gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size.max(4).next_multiple_of(4),
        usage,
        mapped_at_creation: false,
    })
}

fn texture(setup: &Setup<'_>, label: &str, shape: &TextureShape, usage: TextureUsages) -> Result<Texture> {
    let Some([width, height, depth]) = shape.size else {
        return Err(Problem::failure(
            "unknown-size",
            format!("the size of `{label}` is not known for this scene"),
        )
        .into());
    };
    let layers = if shape.dimension == wgpu::TextureDimension::D3 { depth } else { shape.layers };
    Ok(setup.gpu.device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: shape.mips,
        sample_count: 1,
        dimension: shape.dimension,
        format: shape.format,
        usage,
        view_formats: &[],
    }))
}
