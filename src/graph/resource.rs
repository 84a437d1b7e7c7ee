//! What each resource must be, from the plan's description and from how the stages use it.

use super::{BufferShape, Resource, Shape, TextureShape, Touch, Usage};
use crate::kernel::{BindingKind, BufferLayout, FieldKind, Scalar, StructLayout};
use crate::plan::{Plan, ResourceId, ResourceKind};
use crate::problem::{Place, Problem};
use crate::scene::layout::layout as scene_layout;
use std::collections::BTreeMap;
use wgpu_types::{BufferUsages, TextureDimension, TextureFormat, TextureUsages};

/// The resources as the plan describes them; uses are added stage by stage.
pub fn planned(plan: &Plan) -> Vec<Resource> {
    let mut highest: BTreeMap<ResourceId, (u32, u32)> = BTreeMap::new();
    let references = plan.stages.iter().flat_map(|s| s.bind.values().map(|b| &b.0)).chain(
        plan.scopes.iter().flat_map(|s| &s.names).filter_map(|(_, named)| match named {
            crate::plan::Named::Resource(reference) => Some(reference),
            _ => None,
        }),
    );
    for reference in references {
        let entry = highest.entry(reference.resource).or_default();
        entry.0 = entry.0.max(reference.mip.map_or(0, |m| m + 1));
        entry.1 = entry.1.max(reference.layer.map_or(0, |l| l + 1));
    }
    let resource = |(id, planned): (usize, &crate::plan::PlannedResource)| {
        // Without a scene a size may be unknown; then there are as many mips and layers as some stage names.
        let (named_mips, named_layers) = highest.get(&id).copied().unwrap_or_default();
        let slots = if planned.history { 2 } else { 1 };
        let (shape, mips, layers) = match &planned.kind {
            ResourceKind::Texture { format, dimensions, size, mips, layers, array } => {
                let mips = mips.unwrap_or(named_mips.max(1));
                let layers = layers.unwrap_or(named_layers.max(1));
                let dimension = match dimensions {
                    1 => TextureDimension::D1,
                    3 => TextureDimension::D3,
                    _ => TextureDimension::D2,
                };
                let shape = Shape::Texture(TextureShape {
                    format: *format,
                    dimension,
                    size: *size,
                    mips,
                    layers,
                    array: *array,
                    // Depth is filled by drawing, whether or not a stage draws into it.
                    usage: match format.has_depth_aspect() {
                        true => TextureUsages::COPY_SRC | TextureUsages::RENDER_ATTACHMENT,
                        false => TextureUsages::COPY_SRC | TextureUsages::COPY_DST,
                    },
                });
                (shape, mips, layers)
            }
            ResourceKind::Buffer { .. } => (Shape::Unused, 1, 1),
            ResourceKind::Scene => (Shape::Scene, 1, 1),
        };
        let mut resource = Resource { shape, mips, layers, slots, bytes: None };
        resource.bytes = resource.size();
        resource
    };
    plan.resources.iter().enumerate().map(resource).collect()
}

impl Resource {
    /// Bytes of all slots, if known.
    fn size(&self) -> Option<u64> {
        let one = match &self.shape {
            Shape::Texture(texture) => texture.bytes()?,
            Shape::Buffer(buffer) => buffer.bytes?,
            Shape::Scene | Shape::Unused => 0,
        };
        one.checked_mul(u64::from(self.slots))
    }
}

impl TextureShape {
    /// Texels of mip `mip`, at least one each way. Layers are not counted.
    pub fn mip_size(&self, mip: u32) -> Option<[u32; 3]> {
        let size = self.size?;
        let mut at = size.map(|n| n.checked_shr(mip).unwrap_or(0).max(1));
        if self.dimension != TextureDimension::D3 {
            at[2] = 1;
        }
        Some(at)
    }

    /// Bytes of all mips and layers.
    pub fn bytes(&self) -> Option<u64> {
        let texel = texel_bytes(self.format);
        let mut bytes = 0u64;
        for mip in 0..self.mips {
            let [w, h, d] = self.mip_size(mip)?.map(u64::from);
            bytes = bytes.checked_add(w.checked_mul(h)?.checked_mul(d)?.checked_mul(texel)?)?;
        }
        bytes.checked_mul(u64::from(self.layers))
    }
}

/// Bytes of a texel (formats without blocks).
pub fn texel_bytes(format: TextureFormat) -> u64 {
    u64::from(format.block_copy_size(None).unwrap_or(4))
}

/// Adds one stage's use of a buffer: its layout must be the one that other stages see.
pub fn use_buffer(
    plan: &Plan,
    resources: &mut [Resource],
    first_use: &mut BTreeMap<ResourceId, Place>,
    id: ResourceId,
    layout: &BufferLayout,
    at: (&Place, bool),
) -> Result<(), Problem> {
    let (place, vertex) = at;
    let (Some(resource), Some(planned)) = (resources.get_mut(id), plan.resources.get(id)) else {
        return Ok(());
    };
    let ResourceKind::Buffer { count } = planned.kind else { return Ok(()) };
    let stride = layout.stride.unwrap_or(0);
    match &mut resource.shape {
        Shape::Buffer(buffer) => {
            if (buffer.head, buffer.stride) != (layout.head, stride) {
                let mut problem = Problem::input(
                    "buffer-layout",
                    format!(
                        "two kernels see `{}` differently: {} here, {} there",
                        planned.path,
                        describe(layout.head, stride),
                        describe(buffer.head, buffer.stride)
                    ),
                )
                .at(place, "this declaration")
                .help("declare the struct once in a module below `kernels/lib/` and import it in both");
                if let Some(first) = first_use.get(&id) {
                    problem = problem.at(first, "and this one");
                }
                return Err(problem);
            }
            buffer.vertex |= vertex;
        }
        shape => {
            first_use.insert(id, place.clone());
            let elements = if stride == 0 { Some(1) } else { count };
            let bytes = elements.and_then(|n| {
                n.checked_mul(stride)
                    .and_then(|tail| tail.checked_add(layout.head))
                    .map(|b| b.max(4).next_multiple_of(4))
            });
            if stride == 0 && count.is_some_and(|n| n > 1) {
                return Err(Problem::input(
                    "buffer-layout",
                    format!("`{}` has a count, but the kernel declares no runtime-sized array", planned.path),
                )
                .at(&planned.place, "declared here")
                .at(place, "the kernel's declaration")
                .help("declare it as `array<T>` in the kernel, or leave the count out"));
            }
            *shape = Shape::Buffer(BufferShape {
                head: layout.head,
                stride,
                bytes,
                usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST,
                vertex,
            });
            resource.bytes = resource.size();
        }
    }
    Ok(())
}

fn describe(head: u64, stride: u64) -> String {
    match (head, stride) {
        (0, stride) => format!("elements of {stride} bytes"),
        (head, 0) => format!("{head} bytes"),
        (head, stride) => format!("{head} bytes and elements of {stride} bytes"),
    }
}

/// Adds the usage flags that a stage's touches need.
pub fn add_usages(resources: &mut [Resource], touches: &[Touch]) {
    for touch in touches {
        let Some(resource) = resources.get_mut(touch.reference.resource) else { continue };
        match &mut resource.shape {
            Shape::Texture(texture) => {
                texture.usage |= match touch.how {
                    Usage::Sampled => TextureUsages::TEXTURE_BINDING,
                    Usage::StorageTexture => TextureUsages::STORAGE_BINDING,
                    _ => TextureUsages::RENDER_ATTACHMENT,
                }
            }
            Shape::Buffer(buffer) if touch.how == Usage::Indirect => buffer.usage |= BufferUsages::INDIRECT,
            _ => {}
        }
    }
}

/// Whether a kernel declares the scene's buffer `name` as it lies in memory.
pub fn check_scene_layout(name: &str, kind: &BindingKind, place: &Place) -> Option<Problem> {
    let BindingKind::Storage(layout) = kind else { return None };
    let ours = scene_layout(name)?;
    let same = |theirs: &StructLayout| {
        theirs.fields.len() == ours.fields.len()
            && theirs.fields.iter().zip(ours.fields).all(|(theirs, ours)| {
                theirs.name == ours.name
                    && theirs.offset == u64::from(ours.offset)
                    && kind_name(theirs.kind) == ours.kind.wgsl()
            })
    };
    let fits = !layout.writable
        && layout.head == 0
        && layout.stride == Some(u64::from(ours.stride))
        && layout.element.as_ref().is_none_or(same);
    (!fits).then(|| {
        let fields: Vec<_> =
            ours.fields.iter().map(|f| format!("{}: {} at {}", f.name, f.kind.wgsl(), f.offset)).collect();
        Problem::input("scene-layout", format!("this is not how the scene's `{name}` lie in memory"))
            .at(place, "declared here")
            .help(format!(
                "import lib/scene, or declare it read-only with elements `{}` of {} bytes: {}",
                ours.name,
                ours.stride,
                fields.join(", ")
            ))
    })
}

fn kind_name(kind: FieldKind) -> String {
    let letter = |scalar| match scalar {
        Scalar::F32 => ("f", "f32"),
        Scalar::I32 => ("i", "i32"),
        Scalar::U32 => ("u", "u32"),
    };
    match kind {
        FieldKind::Vector { components: 1, scalar } => letter(scalar).1.to_owned(),
        FieldKind::Vector { components, scalar } => format!("vec{components}{}", letter(scalar).0),
        FieldKind::Matrix { columns, rows } => format!("mat{columns}x{rows}f"),
        FieldKind::Other => "?".to_owned(),
    }
}
