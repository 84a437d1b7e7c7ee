//! Reading subresources back from the GPU.

use super::Frame;
use super::layout::{Component, components};
use crate::device::{Gpu, fault};
use crate::graph::{Shape, TextureShape, texel_bytes};
use crate::plan::Reference;
use crate::problem::Problem;
use wgpu::{Buffer, BufferUsages, CommandEncoderDescriptor};

/// One mip of one layer: `depth` slices of rows, row 0 on top, components side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    pub width: u32,
    pub height: u32,
    pub depth: u32,
    pub channels: usize,
    pub data: Vec<f32>,
    /// What the texture holds, tightly packed.
    pub bytes: Vec<u8>,
    /// Whether the bits can be NaN or infinite.
    pub float: bool,
}

impl Frame {
    /// Reads a mip of a layer as the last frame left it.
    pub fn read(&self, gpu: &Gpu, reference: &Reference) -> Result<Image, Problem> {
        let path = self.graph.name(reference);
        let unreadable = |why: &str| Problem::input("unreadable", format!("can't read `{path}` back: {why}"));
        let slot = (self.written_slot(reference.resource) + usize::from(reference.previous))
            % self.graph.resources[reference.resource].slots.max(1) as usize;
        let (Shape::Texture(shape), Some(texture)) =
            (&self.graph.resources[reference.resource].shape, self.made.texture(reference.resource, slot))
        else {
            return Err(unreadable("it is no texture, or no stage that runs touches it"));
        };
        let (component, channels) = components(shape.format).ok_or_else(|| {
            unreadable("voxgi knows no way to unpack its format")
                .at(&self.graph.plan.resources[reference.resource].place, "declared here")
                .help("let a stage copy it into another, such as rgba16float")
        })?;
        let mip = reference.mip.unwrap_or(0);
        let [width, height, depth] = shape.mip_size(mip).unwrap_or([1; 3]);
        let bytes = copy_texture(gpu, texture, shape, (mip, reference.layer.unwrap_or(0)))?;
        let data = decode(&bytes, component, channels);
        Ok(Image { width, height, depth, channels, data, bytes, float: component.is_float() })
    }

    /// The bytes of a buffer.
    pub fn read_buffer(&self, gpu: &Gpu, resource: usize) -> Result<Vec<u8>, Problem> {
        match self.made.buffer(resource, self.written_slot(resource)) {
            Some((buffer, offset, size)) => copy_buffer(gpu, buffer, *offset, *size),
            None => Err(Problem::input(
                "unreadable",
                format!(
                    "`{}` has no buffer: no stage that runs touches it",
                    self.graph.plan.resources[resource].path
                ),
            )),
        }
    }

    /// The counters of the stages that ran in the last frame: `stage.counter` and number.
    pub fn counters(&self, gpu: &Gpu) -> Result<Vec<(String, u32)>, Problem> {
        let mut counters = Vec::new();
        for stage in self.stages.iter().flatten() {
            if let Some((buffer, names)) = &stage.counters {
                let bytes = copy_buffer(gpu, buffer, 0, buffer.size())?;
                let words = bytes.chunks_exact(4).map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]]));
                counters.extend(names.iter().map(|n| format!("{}.{n}", stage.path)).zip(words));
            }
        }
        Ok(counters)
    }
}

/// Numbers from tightly packed texels.
pub fn decode(bytes: &[u8], component: Component, channels: usize) -> Vec<f32> {
    let pieces = bytes.chunks_exact(component.bytes()).enumerate();
    pieces.map(|(i, piece)| component.decode(piece, i % channels < 3)).collect()
}

fn read_buffer(gpu: &Gpu, size: u64) -> Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size,
        usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
        mapped_at_creation: false,
    })
}

fn mapped(gpu: &Gpu, buffer: &Buffer) -> Result<Vec<u8>, Problem> {
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    gpu.wait()?;
    let range = buffer.slice(..).get_mapped_range().map_err(|e| fault(&format!("reading back: {e}")))?;
    Ok(range.to_vec())
}

fn copy_buffer(gpu: &Gpu, from: &Buffer, offset: u64, size: u64) -> Result<Vec<u8>, Problem> {
    let to = read_buffer(gpu, size);
    let mut encoder =
        gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("readback") });
    encoder.copy_buffer_to_buffer(from, offset, &to, 0, size);
    gpu.queue.submit(std::iter::once(encoder.finish()));
    mapped(gpu, &to)
}

fn copy_texture(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    shape: &TextureShape,
    (mip, layer): (u32, u32),
) -> Result<Vec<u8>, Problem> {
    let [width, height, depth] = shape.mip_size(mip).unwrap_or([1; 3]);
    let tight = u64::from(width) * texel_bytes(shape.format);
    let row = tight.next_multiple_of(u64::from(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT));
    let rows = u64::from(height) * u64::from(depth);
    let to = read_buffer(gpu, row * rows);
    let mut encoder =
        gpu.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("readback") });
    encoder.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: mip,
            origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
            aspect: wgpu::TextureAspect::All,
        },
        wgpu::TexelCopyBufferInfo {
            buffer: &to,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row as u32),
                rows_per_image: Some(height),
            },
        },
        wgpu::Extent3d { width, height, depth_or_array_layers: depth },
    );
    gpu.queue.submit(std::iter::once(encoder.finish()));
    let padded = mapped(gpu, &to)?;
    Ok(padded.chunks_exact(row as usize).flat_map(|r| &r[..tight as usize]).copied().collect())
}
