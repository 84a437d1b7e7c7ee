//! How the content of resources begins: fills, poison for what is undefined, and resets of what is kept.

use super::memory::{Made, Place};
use super::{Reset, Setup};
use crate::device::Gpu;
use crate::graph::{Graph, Shape, TextureShape, facts};
use crate::plan::{ResourceId, Start};
use crate::problem::{Problem, Result};
use wgpu::{
    Buffer, BufferUsages, CommandEncoder, Extent3d, Features, ImageSubresourceRange, LoadOp, StoreOp,
    Texture, TextureUsages, TextureView,
};

/// What undefined memory is filled with, to find stages that read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Poison {
    /// All bits set: NaN in floats, 1 in unorm.
    Ones,
    /// The byte 0x5A throughout: an ordinary number in every format.
    Pattern,
}

impl Poison {
    fn byte(self) -> u8 {
        match self {
            Poison::Ones => 0xff,
            Poison::Pattern => 0x5a,
        }
    }

    /// Depth can't be written by copies.
    fn depth(self) -> f32 {
        match self {
            Poison::Ones => 1.0,
            Poison::Pattern => 0.3,
        }
    }
}

/// One command that fills.
pub enum FillOp {
    Zero { buffer: Buffer, offset: u64, bytes: u64 },
    Copy { from: Buffer, to: Buffer, offset: u64, bytes: u64 },
    ZeroTexture { texture: Texture, range: ImageSubresourceRange },
    CopyTexture { from: Buffer, row: u32, texture: Texture, mip: u32, layer: u32, size: Extent3d },
    Color { view: TextureView, value: f64 },
    Depth { view: TextureView, value: f32 },
}

impl FillOp {
    pub fn encode(&self, encoder: &mut CommandEncoder) {
        match self {
            FillOp::Zero { buffer, offset, bytes } => encoder.clear_buffer(buffer, *offset, Some(*bytes)),
            FillOp::Copy { from, to, offset, bytes } => {
                encoder.copy_buffer_to_buffer(from, 0, to, *offset, *bytes)
            }
            FillOp::ZeroTexture { texture, range } => encoder.clear_texture(texture, range),
            FillOp::CopyTexture { from, row, texture, mip, layer, size } => encoder.copy_buffer_to_texture(
                wgpu::TexelCopyBufferInfo {
                    buffer: from,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(*row),
                        rows_per_image: Some(size.height),
                    },
                },
                wgpu::TexelCopyTextureInfo {
                    texture,
                    mip_level: *mip,
                    origin: wgpu::Origin3d { x: 0, y: 0, z: *layer },
                    aspect: wgpu::TextureAspect::All,
                },
                *size,
            ),
            FillOp::Color { view, value } => {
                let color = wgpu::Color { r: *value, g: *value, b: *value, a: *value };
                drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("fill"),
                    color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                        view,
                        depth_slice: None,
                        resolve_target: None,
                        ops: wgpu::Operations { load: LoadOp::Clear(color), store: StoreOp::Store },
                    })],
                    ..Default::default()
                }));
            }
            FillOp::Depth { view, value } => {
                drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("fill"),
                    depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                        view,
                        depth_ops: Some(wgpu::Operations {
                            load: LoadOp::Clear(*value),
                            store: StoreOp::Store,
                        }),
                        stencil_ops: None,
                    }),
                    ..Default::default()
                }));
            }
        }
    }
}

/// Makes fills.
pub struct Filler<'a> {
    pub gpu: &'a Gpu,
    pub graph: &'a Graph,
    pub made: &'a Made,
    pub poison: Option<Poison>,
}

/// What to fill with.
#[derive(Clone, Copy)]
enum With {
    Value(f64),
    Poison(Poison),
}

impl<'a> Filler<'a> {
    pub fn new(setup: &Setup<'a>, graph: &'a Graph, made: &'a Made) -> Self {
        Self { gpu: setup.gpu, graph, made, poison: setup.poison }
    }

    /// The value that a raster stage may clear this resource to as it loads it.
    pub fn clear_value(&self, item: ResourceId) -> Option<f64> {
        match self.graph.plan.resources[item].start {
            Start::Fill(value) => Some(value),
            // What the stage writes over anyway: a clear is cheaper than a load.
            Start::Covered if self.poison.is_none() => Some(0.0),
            _ => None,
        }
    }

    /// Commands that start `cells` of a resource.
    pub fn fills(&self, item: ResourceId, cells: &[u32]) -> Result<Vec<FillOp>> {
        let with = match (&self.graph.plan.resources[item].start, self.poison) {
            (Start::Fill(value), _) => With::Value(*value),
            (Start::Covered, Some(poison)) => With::Poison(poison),
            _ => return Ok(Vec::new()),
        };
        self.fill(item, cells, with)
    }

    /// Commands that put what is kept to its first value, with what they follow on.
    pub fn resets(&self) -> Result<Vec<Reset>> {
        let mut resets = Vec::new();
        for (item, planned) in self.graph.plan.resources.iter().enumerate() {
            if let Start::Kept { value, reset, steady } = &planned.start {
                let resource = &self.graph.resources[item];
                let cells: Vec<u32> = (0..resource.mips * resource.layers * resource.slots).collect();
                let fills = self.fill(item, &cells, With::Value(*value))?;
                if !fills.is_empty() {
                    resets.push(Reset { causes: facts::bits(reset), steady: *steady, fills });
                }
            }
        }
        Ok(resets)
    }

    fn fill(&self, item: ResourceId, cells: &[u32], with: With) -> Result<Vec<FillOp>> {
        let resource = &self.graph.resources[item];
        let mut fills = Vec::new();
        let per_slot = resource.mips * resource.layers;
        for cell in cells {
            let (slot, rest) = ((cell / per_slot) as usize, cell % per_slot);
            let (layer, mip) = (rest / resource.mips, rest % resource.mips);
            match (&self.made.places[item], &resource.shape) {
                (Place::Buffers(_), Shape::Buffer(_)) => {
                    if let Some((buffer, offset, bytes)) = self.made.buffer(item, slot) {
                        fills.push(self.buffer(buffer, *offset, *bytes, with));
                    }
                }
                (Place::Textures(_), Shape::Texture(shape)) => {
                    if let Some(texture) = self.made.texture(item, slot) {
                        fills.push(self.texture(
                            &self.graph.plan.resources[item].path,
                            texture,
                            shape,
                            (mip, layer),
                            with,
                        )?);
                    }
                }
                _ => {}
            }
        }
        Ok(fills)
    }

    fn buffer(&self, to: &Buffer, offset: u64, bytes: u64, with: With) -> FillOp {
        let word = match with {
            With::Value(0.0) => return FillOp::Zero { buffer: to.clone(), offset, bytes },
            // A buffer's words are integers if the value is whole: 1 fills with 1, 0.5 with the bits of 0.5f.
            With::Value(value) if value.fract() == 0.0 => (value as i64 as u32).to_le_bytes(),
            With::Value(value) => (value as f32).to_le_bytes(),
            With::Poison(poison) => [poison.byte(); 4],
        };
        FillOp::Copy { from: self.source(&word, bytes), to: to.clone(), offset, bytes }
    }

    fn source(&self, unit: &[u8], bytes: u64) -> Buffer {
        let size = bytes.next_multiple_of(4);
        let buffer = self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("fill source"),
            size,
            usage: BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let content: Vec<u8> = unit.iter().copied().cycle().take(size as usize).collect();
        self.gpu.queue.write_buffer(&buffer, 0, &content);
        buffer
    }

    fn texture(
        &self,
        path: &str,
        texture: &Texture,
        shape: &TextureShape,
        cell: (u32, u32),
        with: With,
    ) -> Result<FillOp> {
        let (mip, layer) = cell;
        let view = || {
            texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some(path),
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: mip,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        if shape.format.has_depth_aspect() {
            let value = match with {
                With::Value(value) => value as f32,
                With::Poison(poison) => poison.depth(),
            };
            return Ok(FillOp::Depth { view: view(), value });
        }
        let flat = shape.dimension == wgpu::TextureDimension::D2;
        if let With::Value(value) = with {
            if flat && texture.usage().contains(TextureUsages::RENDER_ATTACHMENT) {
                return Ok(FillOp::Color { view: view(), value });
            }
            if value == 0.0 && self.gpu.has(Features::CLEAR_TEXTURE) {
                let range = ImageSubresourceRange {
                    base_mip_level: mip,
                    mip_level_count: Some(1),
                    base_array_layer: layer,
                    array_layer_count: if flat { Some(1) } else { None },
                    ..Default::default()
                };
                return Ok(FillOp::ZeroTexture { texture: texture.clone(), range });
            }
        }
        let texel = match with {
            With::Poison(poison) => vec![poison.byte(); 16],
            With::Value(value) => super::layout::encode(shape.format, value).ok_or_else(|| {
                Problem::input(
                    "fill",
                    format!("`{path}` can't be filled with {value}: its format is {:?}", shape.format),
                )
                .help("fill with 0, or let a stage write it")
            })?,
        };
        let [width, height, depth] = shape.mip_size(mip).unwrap_or([1; 3]);
        let row = (u64::from(width) * crate::graph::texel_bytes(shape.format)).next_multiple_of(256);
        Ok(FillOp::CopyTexture {
            from: self.source(&texel, row * u64::from(height) * u64::from(depth)),
            row: row as u32,
            texture: texture.clone(),
            mip,
            layer,
            size: Extent3d { width, height, depth_or_array_layers: depth },
        })
    }
}
