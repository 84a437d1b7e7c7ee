//! All uniforms of a frame in one buffer, filled from the fact table where that changed.

use crate::device::Gpu;
use crate::graph::facts::FactTable;
use crate::graph::{Copy, Graph, UniformBlock};
use crate::kernel::{FieldKind, Scalar};
use rustc_hash::FxHashMap;
use wgpu::{Buffer, BufferUsages};

pub struct Uniforms {
    pub facts: FactTable,
    /// What the buffer holds.
    bytes: Vec<u8>,
    /// Block offset and copy.
    copies: Vec<(u32, Copy)>,
    /// Equal blocks share a place.
    offsets: FxHashMap<UniformBlock, u64>,
    alignment: u64,
    buffer: Option<Buffer>,
}

impl Uniforms {
    pub fn new(graph: &Graph, gpu: &Gpu) -> Self {
        let views = graph.stages.iter().zip(&graph.plan.stages).flat_map(|(_, planned)| &planned.elements);
        let views =
            views.filter(|e| e.of == crate::plan::ElementOf::View).map(|e| e.index as usize + 1).max();
        Self {
            facts: FactTable::new(graph.plan.values.len(), views.unwrap_or(0)),
            bytes: Vec::new(),
            copies: Vec::new(),
            offsets: FxHashMap::default(),
            alignment: u64::from(gpu.device.limits().min_uniform_buffer_offset_alignment),
            buffer: None,
        }
    }

    /// Where the block will lie. All blocks must be added before [`Uniforms::buffer`] is asked for.
    pub fn add(&mut self, block: &UniformBlock) -> u64 {
        if let Some(offset) = self.offsets.get(block) {
            return *offset;
        }
        let offset = (self.bytes.len() as u64).next_multiple_of(self.alignment);
        self.bytes.resize(offset as usize, 0);
        self.bytes.extend_from_slice(&block.bytes);
        self.copies.extend(block.copies.iter().map(|copy| (offset as u32, *copy)));
        self.offsets.insert(block.clone(), offset);
        offset
    }

    /// Makes the buffer, with the constants in it.
    pub fn make(&mut self, gpu: &Gpu) -> Buffer {
        let size = (self.bytes.len() as u64).max(16).next_multiple_of(16);
        self.bytes.resize(size as usize, 0);
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("uniforms"),
            size,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&buffer, 0, &self.bytes);
        self.buffer = Some(buffer.clone());
        buffer
    }

    /// Fills the fields that come from facts, and uploads if any word changed.
    pub fn update(&mut self, gpu: &Gpu) {
        let mut changed = false;
        for (base, copy) in &self.copies {
            changed |= put(&mut self.bytes, *base, copy, &self.facts.words);
        }
        if changed && let Some(buffer) = &self.buffer {
            gpu.queue.write_buffer(buffer, 0, &self.bytes);
        }
    }
}

/// Copies one field's words to where WGSL wants them; says whether any byte changed.
fn put(bytes: &mut [u8], base: u32, copy: &Copy, facts: &[u32]) -> bool {
    let (rows, scalar) = match copy.kind {
        FieldKind::Vector { components, scalar } => (u32::from(components), scalar),
        FieldKind::Matrix { rows, .. } => (u32::from(rows), Scalar::F32),
        FieldKind::Other => return false,
    };
    // Columns of three rows are padded to four; a vector is a single column.
    let pitch = if rows == 3 { 4 } else { rows };
    let mut changed = false;
    for i in 0..copy.from.words {
        let at = (base + copy.offset + 4 * ((i / rows) * pitch + i % rows)) as usize;
        let Some(word) = facts.get((copy.from.start + i) as usize).copied() else { continue };
        let new = match (copy.from.scalar, scalar) {
            (Scalar::F32, Scalar::I32) => (f32::from_bits(word) as i32).to_le_bytes(),
            (Scalar::F32, Scalar::U32) => (f32::from_bits(word) as u32).to_le_bytes(),
            (Scalar::U32 | Scalar::I32, Scalar::F32) => (word as f32).to_le_bytes(),
            _ => word.to_le_bytes(),
        };
        if let Some(old) = bytes.get_mut(at..at + 4)
            && *old != new
        {
            old.copy_from_slice(&new);
            changed = true;
        }
    }
    changed
}
