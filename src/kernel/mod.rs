//! Kernels: from the WGSL files of a library to modules that a device can take.
//!
//! *Compose* puts a kernel and its imports into one text, with roles put in and conditions decided; *reflect* parses
//! it with naga and says what it binds; *finish* numbers the bindings, follows the resources' formats and validates.

mod compose;
mod condition;
mod describe;
mod diagnose;
mod finish;
mod globals;
mod overrides;
mod reflect;
mod scan;
#[cfg(test)]
mod tests;
mod token;
mod variants;

pub use compose::{Composed, Declared, Segment, compose};
pub use describe::{Description, declares, describe};
pub use diagnose::undefined;
pub use finish::{Bound, Choice, Program, VariantKey, finish};
pub use reflect::{Reflected, reflect};
pub use scan::Declaration;
pub use variants::Variants;

use crate::problem::Place;
use wgpu_types::{StorageTextureAccess, TextureFormat, TextureSampleType, TextureViewDimension};

/// A module-scope variable of a kernel that something must be bound to.
#[derive(Clone, Debug, PartialEq)]
pub struct Binding {
    pub name: String,
    /// The role whose module declares it, if it comes from `role/NAME`; it is then looked up in that part's scope.
    pub role: Option<String>,
    pub place: Place,
    pub kind: BindingKind,
    /// The comment above its declaration.
    pub about: String,
}

#[derive(Clone, Debug, PartialEq)]
pub enum BindingKind {
    Uniform(StructLayout),
    Storage(BufferLayout),
    Texture { dimension: TextureViewDimension, sample: TextureSampleType, multisampled: bool },
    StorageTexture { dimension: TextureViewDimension, format: TextureFormat, access: StorageTextureAccess },
    Sampler { comparison: bool },
}

/// A storage buffer: a fixed head, then possibly a runtime-sized array.
#[derive(Clone, Debug, PartialEq)]
pub struct BufferLayout {
    /// Declared `read_write`.
    pub writable: bool,
    /// Bytes before the runtime-sized array, or all of them.
    pub head: u64,
    /// Bytes of an element of the runtime-sized array.
    pub stride: Option<u64>,
    /// The element of the array (or the whole, if there is none) where it is a struct.
    pub element: Option<StructLayout>,
    pub atomic: bool,
}

/// A WGSL struct in a host-shareable address space.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct StructLayout {
    pub size: u64,
    pub fields: Vec<Field>,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Field {
    pub name: String,
    /// Bytes from the start of the struct.
    pub offset: u64,
    pub kind: FieldKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scalar {
    F32,
    I32,
    U32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FieldKind {
    /// 1 to 4 components (atomics count as their scalar).
    Vector { components: u8, scalar: Scalar },
    /// Columns of `rows` f32, each padded as WGSL does.
    Matrix { columns: u8, rows: u8 },
    /// Arrays, structs: the engine fills none of these.
    Other,
}

/// A function that a pipeline can run.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub name: String,
    pub stage: Stage,
    /// Threads of a workgroup; `[1, 1, 1]` outside of compute.
    pub workgroup_size: [u32; 3],
    pub uses: Vec<Use>,
    /// Which texture is read through which sampler: indices into the bindings. Textures that are only loaded from are
    /// in no pair.
    pub sampled: Vec<(usize, usize)>,
    /// Colours a fragment entry writes, by location.
    pub targets: Vec<Target>,
    /// Whether a fragment entry writes its depth itself.
    pub depth: bool,
    pub place: Place,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    Vertex,
    Fragment,
    Compute,
}

/// How an entry point uses a binding, as a whole. Neither read nor written: only its size is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// Index into the bindings.
    pub binding: usize,
    pub read: bool,
    pub write: bool,
}

/// A colour that a fragment entry point writes: a member of the struct it returns.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    pub name: String,
    pub location: u32,
    pub scalar: Scalar,
    pub components: u8,
}

/// A constant that the engine sets before compilation.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    pub name: String,
    /// What it is where nobody sets it; `None` if it must be set, or if its default is computed from others.
    pub default: Option<f64>,
    pub place: Place,
    pub about: String,
}
