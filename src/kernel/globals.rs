//! The module-scope variables of a naga module as bindings: sorts and layouts.

use super::compose::Composed;
use super::{Binding, BindingKind, BufferLayout, Field, FieldKind, Scalar, StructLayout};
use crate::problem::Problem;
use naga::proc::Layouter;
use naga::{
    AddressSpace, ArraySize, GlobalVariable, Handle, ImageClass, ImageDimension, Module, ScalarKind, Type,
};
use naga::{StorageAccess, TypeInner, VectorSize};
use wgpu_naga_bridge::map_storage_format_from_naga;
use wgpu_types::{StorageTextureAccess, TextureSampleType, TextureViewDimension};

/// Reads the bindings of one module.
pub struct Globals<'a> {
    composed: &'a Composed,
    module: &'a Module,
    layouts: Layouter,
}

impl<'a> Globals<'a> {
    /// # Errors
    /// A type that is too large for any memory.
    pub fn new(composed: &'a Composed, module: &'a Module) -> Result<Self, Problem> {
        let mut layouts = Layouter::default();
        layouts.update(module.to_ctx()).map_err(|error| {
            Problem::input("wgsl", error.to_string()).at(&composed.start(), "in this kernel")
        })?;
        Ok(Self { composed, module, layouts })
    }

    /// `variable` as a binding. A texture counts as filterable if `filtered`.
    pub fn binding(&self, variable: &GlobalVariable, filtered: bool) -> Result<Binding, Problem> {
        let name = variable.name.clone().unwrap_or_default();
        let declared = self.composed.declarations.get(&name);
        let place = self.composed.place_of(&name);
        let kind = match variable.space {
            AddressSpace::Uniform => Some(BindingKind::Uniform(self.uniform(&name, variable.ty))),
            AddressSpace::Storage { access } => {
                Some(BindingKind::Storage(self.buffer(variable.ty, access.contains(StorageAccess::STORE))))
            }
            AddressSpace::Handle => self.handle(variable.ty, filtered),
            _ => None,
        };
        let Some(kind) = kind else {
            return Err(Problem::input("unsupported-binding", format!("nothing can be bound to `{name}`"))
                .at(&place, "a variable of this sort")
                .help("bindings are uniforms, storage buffers, textures, storage textures and samplers"));
        };
        Ok(Binding {
            role: declared.and_then(|declared| declared.role.clone()),
            about: declared.map(|declared| declared.declaration.about.clone()).unwrap_or_default(),
            name,
            place,
            kind,
        })
    }

    fn size(&self, ty: Handle<Type>) -> u64 {
        u64::from(self.layouts[ty].size)
    }

    /// A uniform that is no struct counts as one with a single field of its own name.
    fn uniform(&self, name: &str, ty: Handle<Type>) -> StructLayout {
        self.structure(ty).unwrap_or_else(|| StructLayout {
            size: self.size(ty),
            fields: vec![Field { name: name.to_owned(), offset: 0, kind: self.field(ty) }],
        })
    }

    fn structure(&self, ty: Handle<Type>) -> Option<StructLayout> {
        let TypeInner::Struct { members, span } = &self.module.types[ty].inner else { return None };
        let fields = members.iter().map(|member| Field {
            name: member.name.clone().unwrap_or_default(),
            offset: u64::from(member.offset),
            kind: self.field(member.ty),
        });
        Some(StructLayout { size: u64::from(*span), fields: fields.collect() })
    }

    fn field(&self, ty: Handle<Type>) -> FieldKind {
        let vector = |components: u8, kind: naga::Scalar| match scalar(kind) {
            Some(scalar) => FieldKind::Vector { components, scalar },
            None => FieldKind::Other,
        };
        match self.module.types[ty].inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => vector(1, scalar),
            TypeInner::Vector { size, scalar } => vector(count(size), scalar),
            TypeInner::Matrix { columns, rows, scalar: naga::Scalar::F32 } => {
                FieldKind::Matrix { columns: count(columns), rows: count(rows) }
            }
            _ => FieldKind::Other,
        }
    }

    fn buffer(&self, ty: Handle<Type>, writable: bool) -> BufferLayout {
        let runtime = |ty: Handle<Type>| match self.module.types[ty].inner {
            TypeInner::Array { base, size: ArraySize::Dynamic, stride } => Some((base, u64::from(stride))),
            _ => None,
        };
        let (head, array) = match &self.module.types[ty].inner {
            TypeInner::Struct { members, .. } => {
                match members.last().and_then(|m| Some((m.offset, runtime(m.ty)?))) {
                    Some((offset, array)) => (u64::from(offset), Some(array)),
                    None => (self.size(ty), None),
                }
            }
            _ => match runtime(ty) {
                Some(array) => (0, Some(array)),
                None => (self.size(ty), None),
            },
        };
        BufferLayout {
            writable,
            head,
            stride: array.map(|(_, stride)| stride),
            element: self.structure(array.map_or(ty, |(base, _)| base)),
            atomic: self.is_atomic(ty),
        }
    }

    /// Whether a type is, or holds, an atomic. (Types can't hold themselves.)
    fn is_atomic(&self, ty: Handle<Type>) -> bool {
        match &self.module.types[ty].inner {
            TypeInner::Atomic(_) => true,
            TypeInner::Array { base, .. } => self.is_atomic(*base),
            TypeInner::Struct { members, .. } => members.iter().any(|member| self.is_atomic(member.ty)),
            _ => false,
        }
    }

    fn handle(&self, ty: Handle<Type>, filterable: bool) -> Option<BindingKind> {
        match self.module.types[ty].inner {
            TypeInner::Sampler { comparison } => Some(BindingKind::Sampler { comparison }),
            TypeInner::Image { dim, arrayed, class } => {
                let dimension = view_dimension(dim, arrayed)?;
                let (sample, multisampled) = match class {
                    ImageClass::Storage { format, access } => {
                        let (format, access) = (map_storage_format_from_naga(format), storage_access(access));
                        return Some(BindingKind::StorageTexture { dimension, format, access });
                    }
                    ImageClass::Depth { multi } => (TextureSampleType::Depth, multi),
                    ImageClass::Sampled { kind: ScalarKind::Sint, multi } => (TextureSampleType::Sint, multi),
                    ImageClass::Sampled { kind: ScalarKind::Uint, multi } => (TextureSampleType::Uint, multi),
                    ImageClass::Sampled { kind: _, multi } => {
                        (TextureSampleType::Float { filterable }, multi)
                    }
                    ImageClass::External => return None,
                };
                Some(BindingKind::Texture { dimension, sample, multisampled })
            }
            _ => None,
        }
    }
}

fn view_dimension(dim: ImageDimension, arrayed: bool) -> Option<TextureViewDimension> {
    Some(match (dim, arrayed) {
        (ImageDimension::D1, false) => TextureViewDimension::D1,
        (ImageDimension::D2, false) => TextureViewDimension::D2,
        (ImageDimension::D2, true) => TextureViewDimension::D2Array,
        (ImageDimension::D3, false) => TextureViewDimension::D3,
        (ImageDimension::Cube, false) => TextureViewDimension::Cube,
        (ImageDimension::Cube, true) => TextureViewDimension::CubeArray,
        (ImageDimension::D1 | ImageDimension::D3, true) => return None,
    })
}

fn storage_access(access: StorageAccess) -> StorageTextureAccess {
    if access.contains(StorageAccess::ATOMIC) {
        StorageTextureAccess::Atomic
    } else if access.contains(StorageAccess::LOAD | StorageAccess::STORE) {
        StorageTextureAccess::ReadWrite
    } else if access.contains(StorageAccess::LOAD) {
        StorageTextureAccess::ReadOnly
    } else {
        StorageTextureAccess::WriteOnly
    }
}

/// naga's scalar as one that the engine fills or a target holds.
pub fn scalar(scalar: naga::Scalar) -> Option<Scalar> {
    match scalar {
        naga::Scalar::F32 => Some(Scalar::F32),
        naga::Scalar::I32 => Some(Scalar::I32),
        naga::Scalar::U32 => Some(Scalar::U32),
        _ => None,
    }
}

pub fn count(size: VectorSize) -> u8 {
    size as u8
}
