//! Kernels: from the WGSL files of a library to modules that a device can take.
//!
//! *Compose* puts a kernel and its imports into one text, with roles put in and conditions decided; *reflect* parses
//! it with naga and says what it binds; *finish* numbers the bindings, follows the resources' formats and validates.

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
