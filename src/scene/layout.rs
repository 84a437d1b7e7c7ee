//! The scene's data as kernels see it: `repr(C)` types whose bytes are the WGSL structs of the same name, and
//! tables of their fields ([`layout`]) that a linker can hold against what a kernel declares.
//!
//! WGSL aligns `vec3f` and matrix columns to 16 bytes; a scalar that follows a `vec3f` fills its last 4. Fields named
//! `pad` have no counterpart in WGSL: they are the space it leaves.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, UVec3, UVec4, Vec2, Vec3, Vec4};
use half::f16;
use std::mem::{offset_of, size_of};

/// A corner of triangles, in object space. `normal` has unit length.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    pub position: Vec3,
    pub u: f32,
    pub normal: Vec3,
    pub v: f32,
}

/// What only some scenes' corners have; the extra of a vertex has the vertex's index.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct VertexExtra {
    /// xyz: where texture coordinates of the normal map grow along u, in object space, of unit length; zero where the
    /// surface has no map. w: 1 or −1, the bitangent is `w * cross(normal, tangent)`.
    pub tangent: Vec4,
    /// Four `f16`: red and green, blue and alpha, the first in the lower half. Multiplies the base colour.
    pub color: [u32; 2],
    /// The second set of texture coordinates.
    pub uv: Vec2,
}

impl VertexExtra {
    /// Of a vertex that needs none.
    pub const NONE: Self = Self { tangent: Vec4::ZERO, color: [0x3c00_3c00; 2], uv: Vec2::ZERO };

    pub fn pack_color(color: [f32; 4]) -> [u32; 2] {
        let [r, g, b, a] = color.map(|c| u32::from(f16::from_f32(c).to_bits()));
        [r | g << 16, b | a << 16]
    }

    pub fn unpacked_color(&self) -> [f32; 4] {
        let [rg, ba] = self.color;
        [rg, rg >> 16, ba, ba >> 16].map(|bits| f16::from_bits(bits as u16).to_f32())
    }
}

/// Three indices into the vertices and one into the instances.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Triangle {
    pub a: u32,
    pub b: u32,
    pub c: u32,
    pub instance: u32,
}

/// One placing of one mesh part in the world.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Instance {
    /// `mat4x3f`: world position = `to_world * vec4(position, 1)`; the fourth lane of each column is 0.
    pub to_world: [Vec4; 4],
    /// `mat3x3f`: the inverse transpose of the linear part, or its cofactors where there is no inverse; normals come
    /// out not normalised.
    pub normal_to_world: [Vec4; 3],
    pub material: u32,
    /// −1 where the transform mirrors, so that the winding of a triangle's corners in the world is reversed; else 1.
    pub flip: f32,
    pub pad: [u32; 2],
}

/// A surface. An image reference is what [`super::Image::reference`] makes; width 0 stands for none. A `…_uv` is the
/// `mat3x2f` that takes (u, v, 1) of a vertex to the image's own coordinates, where the reference says that there is one.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Material {
    /// Multiplies the image's colour; linear Rec. 709.
    pub base_color: Vec3,
    /// A texel whose alpha is less is a hole. 0: there are no holes.
    pub alpha_cutoff: f32,
    /// Multiplies the image's colour; W/(sr·m²).
    pub emission: Vec3,
    /// Bit 0 [`DOUBLE_SIDED`], bit 1 [`UNLIT`].
    pub flags: u32,
    pub base_color_image: UVec4,
    pub emission_image: UVec4,
    /// Normals in the space of tangent, bitangent and normal; not sRGB-coded.
    pub normal_image: UVec4,
    /// Green multiplies `roughness`, blue `metallic`; not sRGB-coded.
    pub roughness_image: UVec4,
    pub base_color_uv: [Vec2; 3],
    pub emission_uv: [Vec2; 3],
    pub normal_uv: [Vec2; 3],
    pub roughness_uv: [Vec2; 3],
    pub metallic: f32,
    pub roughness: f32,
    /// Multiplies x and y of the normals in the image.
    pub normal_scale: f32,
    pub pad: u32,
}

pub const DOUBLE_SIDED: u32 = 1;
pub const UNLIT: u32 = 2;

/// A light without extent. `kind` is one of [`POINT`], [`SPOT`], [`DIRECTIONAL`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Light {
    /// Metres; of no meaning for a directional light.
    pub position: Vec3,
    pub kind: u32,
    /// Unit vector along which the light travels; of no meaning for a point light.
    pub direction: Vec3,
    pub first_view: u32,
    /// W/sr; for a directional light W/m² on a surface that faces it.
    pub intensity: Vec3,
    /// Cosine of the half angle that a spot's light fills; −1 for other lights.
    pub cos_outer: f32,
    /// Cosine of the half angle within which a spot has its full intensity; −1 for other lights.
    pub cos_inner: f32,
    /// Its views are `first_view..first_view + view_count`.
    pub view_count: u32,
    pub pad: [u32; 2],
}

pub const POINT: u32 = 0;
pub const SPOT: u32 = 1;
pub const DIRECTIONAL: u32 = 2;

/// The scene seen from a light, through a square; made by [`super::views`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct View {
    /// World to clip space, depth 1 at `near` and 0 at `far`.
    pub view_projection: Mat4,
    pub position: Vec3,
    pub light: u32,
    /// Unit vector along which the view looks.
    pub direction: Vec3,
    /// Of a point light: 0 to 5 for +x −x +y −y +z −z; else 0.
    pub face: u32,
    /// Metres from `position` along `direction`.
    pub near: f32,
    pub far: f32,
    /// Width of the view in metres, at unit distance if it is a perspective; divided by a picture's resolution it is the
    /// width of a texel.
    pub texel: f32,
    pub pad: u32,
}

/// Something that gives light; see [`super::emitters`]. `kind`: that of a light, [`super::emitters::TRIANGLE`] or
/// [`super::emitters::ENVIRONMENT`]. A light's position, direction and intensity are `a`, `b`, `c`; of a triangle these
/// are the corners, of the environment they have no meaning.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Emitter {
    pub a: Vec3,
    pub kind: u32,
    pub b: Vec3,
    pub instance: u32,
    pub c: Vec3,
    /// Of being chosen.
    pub probability: f32,
    /// The triangle's.
    pub vertices: UVec3,
    /// The emitter that is meant by an even choice of this one above `threshold`.
    pub other: u32,
    pub threshold: f32,
    pub cos_outer: f32,
    pub cos_inner: f32,
    pub pad: u32,
}

/// A camera for one aspect ratio; made by [`super::Camera::uniform`].
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct CameraUniform {
    /// World to clip space, depth 1 at `near` and 0 at infinity (orthographic: at the far plane).
    pub view_projection: Mat4,
    pub inverse_view_projection: Mat4,
    pub position: Vec3,
    pub near: f32,
    /// Unit vector. The ray through (x, y) of [−1, 1]², y up, begins at `position` and has the direction
    /// `forward + x * right + y * up`; if `parallel`, it begins at `position + x * right + y * up` and goes `forward`.
    pub forward: Vec3,
    /// Width over height.
    pub aspect: f32,
    pub right: Vec3,
    /// 1 for an orthographic camera, else 0.
    pub parallel: f32,
    pub up: Vec3,
    pub pad_up: u32,
    /// Distance along `forward` from depth d: `(x + y * d) / (z + w * d)`.
    pub distance: Vec4,
}

/// WGSL type of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    F32,
    U32,
    Vec2F,
    Vec2U,
    Vec3F,
    Vec3U,
    Vec4F,
    Vec4U,
    Mat3x2F,
    Mat3x3F,
    Mat4x3F,
    Mat4x4F,
}

impl FieldKind {
    /// Bytes, as WGSL's `SizeOf`.
    pub fn size(self) -> u32 {
        match self {
            FieldKind::F32 | FieldKind::U32 => 4,
            FieldKind::Vec2F | FieldKind::Vec2U => 8,
            FieldKind::Vec3F | FieldKind::Vec3U => 12,
            FieldKind::Vec4F | FieldKind::Vec4U => 16,
            FieldKind::Mat3x2F => 24,
            FieldKind::Mat3x3F => 48,
            FieldKind::Mat4x3F | FieldKind::Mat4x4F => 64,
        }
    }

    pub fn wgsl(self) -> &'static str {
        match self {
            FieldKind::F32 => "f32",
            FieldKind::U32 => "u32",
            FieldKind::Vec2F => "vec2f",
            FieldKind::Vec2U => "vec2u",
            FieldKind::Vec3F => "vec3f",
            FieldKind::Vec3U => "vec3u",
            FieldKind::Vec4F => "vec4f",
            FieldKind::Vec4U => "vec4u",
            FieldKind::Mat3x2F => "mat3x2f",
            FieldKind::Mat3x3F => "mat3x3f",
            FieldKind::Mat4x3F => "mat4x3f",
            FieldKind::Mat4x4F => "mat4x4f",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    pub name: &'static str,
    /// Bytes from the start of the struct.
    pub offset: u32,
    pub kind: FieldKind,
}

/// One element of a built-in resource. Without fields it is the scalar `name`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StructLayout {
    /// WGSL name of the element's type.
    pub name: &'static str,
    /// Bytes from one element to the next.
    pub stride: u32,
    pub fields: &'static [Field],
}

macro_rules! layout_of {
    ($type:ident as $name:literal { $($field:ident: $kind:ident),+ }) => {
        StructLayout {
            name: $name,
            stride: size_of::<$type>() as u32,
            fields: &[$(Field {
                name: stringify!($field),
                offset: offset_of!($type, $field) as u32,
                kind: FieldKind::$kind,
            }),+],
        }
    };
}

static VERTEX: StructLayout =
    layout_of!(Vertex as "Vertex" { position: Vec3F, u: F32, normal: Vec3F, v: F32 });
static VERTEX_EXTRA: StructLayout =
    layout_of!(VertexExtra as "VertexExtra" { tangent: Vec4F, color: Vec2U, uv: Vec2F });
static TRIANGLE: StructLayout = layout_of!(Triangle as "Triangle" { a: U32, b: U32, c: U32, instance: U32 });
static INSTANCE: StructLayout = layout_of!(Instance as "Instance" {
    to_world: Mat4x3F, normal_to_world: Mat3x3F, material: U32, flip: F32
});
static MATERIAL: StructLayout = layout_of!(Material as "Material" {
    base_color: Vec3F, alpha_cutoff: F32, emission: Vec3F, flags: U32, base_color_image: Vec4U,
    emission_image: Vec4U, normal_image: Vec4U, roughness_image: Vec4U, base_color_uv: Mat3x2F,
    emission_uv: Mat3x2F, normal_uv: Mat3x2F, roughness_uv: Mat3x2F, metallic: F32, roughness: F32,
    normal_scale: F32
});
static LIGHT: StructLayout = layout_of!(Light as "Light" {
    position: Vec3F, kind: U32, direction: Vec3F, first_view: U32, intensity: Vec3F, cos_outer: F32,
    cos_inner: F32, view_count: U32
});
static VIEW: StructLayout = layout_of!(View as "View" {
    view_projection: Mat4x4F, position: Vec3F, light: U32, direction: Vec3F, face: U32, near: F32, far: F32,
    texel: F32
});
static EMITTER: StructLayout = layout_of!(Emitter as "Emitter" {
    a: Vec3F, kind: U32, b: Vec3F, instance: U32, c: Vec3F, probability: F32, vertices: Vec3U, other: U32,
    threshold: F32, cos_outer: F32, cos_inner: F32
});
static BVH: StructLayout = StructLayout { name: "vec4u", stride: 16, fields: &[] };
static ATLAS: StructLayout = StructLayout { name: "vec2u", stride: 8, fields: &[] };
static CAMERA: StructLayout = layout_of!(CameraUniform as "Camera" {
    view_projection: Mat4x4F, inverse_view_projection: Mat4x4F, position: Vec3F, near: F32, forward: Vec3F,
    aspect: F32, right: Vec3F, parallel: F32, up: Vec3F, distance: Vec4F
});
static ENVIRONMENT: StructLayout = StructLayout { name: "vec4f", stride: 16, fields: &[] };
static TEXEL: StructLayout = StructLayout { name: "u32", stride: 4, fields: &[] };

/// The element of the built-in resource `name`: a storage buffer of [`super::buffers::NAMES`], or the uniform
/// `camera`.
pub fn layout(name: &str) -> Option<&'static StructLayout> {
    Some(match name {
        "vertices" => &VERTEX,
        "vertex_extras" => &VERTEX_EXTRA,
        "triangles" => &TRIANGLE,
        "instances" => &INSTANCE,
        "materials" => &MATERIAL,
        "texels" => &TEXEL,
        "environment" => &ENVIRONMENT,
        "lights" => &LIGHT,
        "views" => &VIEW,
        "emitters" => &EMITTER,
        "bvh" => &BVH,
        "atlas" => &ATLAS,
        "camera" => &CAMERA,
        _ => return None,
    })
}
