//! The graph: every stage with its kernel reflected, every binding tied to a resource, everything checked that can
//! be checked before a GPU object exists.
//!
//! [`link()`] makes it from a [`Plan`]. Nothing here is about time: the order, what is dropped and what shares memory is
//! the scheduler's, which sees the graph as [`crate::schedule::Work`] (see [`work`]).

mod binding;
pub mod check;
pub mod facts;
pub mod formats;
mod link;
mod missing;
mod resource;
mod target;
mod uniform;
pub mod work;

use crate::document::{Blend, Compare, Sampler};
use crate::kernel::{Program, Reflected};
use crate::plan::{Plan, Reference, ResourceId};
use crate::problem::{Place, Problem};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use wgpu_types::{
    BufferUsages, StorageTextureAccess, TextureDimension, TextureFormat, TextureUsages, TextureViewDimension,
};

pub use binding::format_name;
pub use link::{Linking, link};
pub use resource::texel_bytes;
pub use uniform::{Copy, UniformBlock};

#[derive(Debug)]
pub struct Graph {
    pub plan: Plan,
    /// By [`ResourceId`].
    pub resources: Vec<Resource>,
    /// In listed order, as in the plan.
    pub stages: Vec<Stage>,
    pub warnings: Vec<Problem>,
}

/// A resource as its users need it.
#[derive(Clone, Debug)]
pub struct Resource {
    pub shape: Shape,
    /// Cells of one history slot: mips × layers, or 1.
    pub mips: u32,
    pub layers: u32,
    /// 2 for a resource of which some stage names `@previous`.
    pub slots: u32,
    /// Bytes of all slots; `None` if not known without a scene.
    pub bytes: Option<u64>,
}

#[derive(Clone, Debug)]
pub enum Shape {
    Texture(TextureShape),
    Buffer(BufferShape),
    /// The scene's buffer of this name.
    Scene,
    /// No stage binds it.
    Unused,
}

/// What a texture is made with. Textures that are alike in all of this can share memory.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct TextureShape {
    pub format: TextureFormat,
    pub dimension: TextureDimension,
    /// Texels of mip 0; `None` if not known without a scene.
    pub size: Option<[u32; 3]>,
    pub mips: u32,
    pub layers: u32,
    pub array: bool,
    pub usage: TextureUsages,
}

#[derive(Clone, Debug)]
pub struct BufferShape {
    /// Bytes before the runtime-sized array.
    pub head: u64,
    /// Bytes of an element; 0 without a runtime-sized array.
    pub stride: u64,
    pub bytes: Option<u64>,
    pub usage: BufferUsages,
    /// Some vertex stage binds it: it can't be declared writable there.
    pub vertex: bool,
}

#[derive(Debug)]
pub struct Stage {
    pub path: String,
    pub place: Place,
    /// Why it does not run for this scene and these knobs, if so.
    pub off: Option<String>,
    /// `when` can't be decided without a scene.
    pub undecided: bool,
    /// Absent for a stage that is off and can't be bound.
    pub linked: Option<Linked>,
    pub order_dependent: Option<String>,
}

/// A stage whose kernel is known in full.
#[derive(Debug)]
pub struct Linked {
    pub reflected: Arc<Reflected>,
    pub program: Arc<Program>,
    /// By binding number.
    pub bindings: Vec<Bound>,
    pub action: Action,
    pub touches: Vec<Touch>,
    /// What it depends on by itself: bits as in [`facts`].
    pub depends: BTreeSet<u32>,
    /// Formats given to storage textures, so that the program can be finished again.
    pub formats: BTreeMap<String, TextureFormat>,
}

/// One use of cells of a resource by a stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Touch {
    pub reference: Reference,
    pub read: bool,
    pub write: bool,
    pub how: Usage,
    /// The binding or target through which.
    pub binding: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Usage {
    Sampled,
    StorageTexture,
    StorageBuffer,
    Indirect,
    Color,
    Depth,
}

#[derive(Clone, Debug)]
pub enum Bound {
    Uniform(UniformBlock),
    Buffer {
        resource: ResourceId,
        previous: bool,
    },
    Texture {
        reference: Reference,
        dimension: TextureViewDimension,
        filterable: bool,
    },
    StorageTexture {
        reference: Reference,
        dimension: TextureViewDimension,
        access: StorageTextureAccess,
    },
    Sampler(Sampler),
    /// The stage's own counters: their names, in u32 order.
    Counters(Vec<String>),
}

#[derive(Clone, Debug)]
pub enum Action {
    Compute { entry: String, workgroup: [u32; 3], threads: Threads },
    Raster(Box<Raster>),
}

#[derive(Clone, Debug)]
pub enum Threads {
    /// `None` if not known without a scene.
    Count(Option<[u64; 3]>),
    Indirect {
        resource: ResourceId,
        offset: u64,
    },
}

#[derive(Clone, Debug)]
pub struct Raster {
    pub vertex: String,
    pub fragment: Option<String>,
    /// By location; `None`: written nowhere.
    pub targets: Vec<Option<Reference>>,
    pub depth: Option<(Reference, Compare, bool)>,
    pub blend: Option<Blend>,
    pub draw: Draw,
    /// Texels of the targets.
    pub size: Option<[u32; 2]>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Draw {
    /// A triangle list: the first vertex, and how many.
    Vertices(Option<(u64, u64)>),
    Points(Option<u64>),
    Indirect {
        resource: ResourceId,
        offset: u64,
    },
}

impl Graph {
    /// The cells of a resource that `reference` means: every mip and layer it does not choose.
    pub fn cells(&self, reference: &Reference) -> Vec<u32> {
        let Some(resource) = self.resources.get(reference.resource) else { return Vec::new() };
        let slot = u32::from(reference.previous && resource.slots > 1);
        let pick = |chosen: Option<u32>, all: u32| match chosen {
            Some(one) => one..one.saturating_add(1),
            None => 0..all,
        };
        let mut cells = Vec::new();
        for layer in pick(reference.layer, resource.layers) {
            for mip in pick(reference.mip, resource.mips) {
                cells.push((slot * resource.layers + layer) * resource.mips + mip);
            }
        }
        cells
    }

    /// A reference as the user writes it: `radiance@mip2`.
    pub fn name(&self, reference: &Reference) -> String {
        let mut name =
            self.plan.resources.get(reference.resource).map_or_else(String::new, |r| r.path.clone());
        if let Some(mip) = reference.mip {
            name += &format!("@mip{mip}");
        }
        if let Some(layer) = reference.layer {
            name += &format!("@layer{layer}");
        }
        if reference.previous {
            name += "@previous";
        }
        name
    }
}
