//! The tables against naga's own layout of the WGSL that they stand for.

use crate::scene::layout::{FieldKind, VertexExtra, layout};
use crate::scene::{Scene, buffers, features};

const WGSL: &str = "
    struct Vertex { position: vec3f, u: f32, normal: vec3f, v: f32 }
    struct VertexExtra { tangent: vec4f, color: vec2u, uv: vec2f }
    struct Triangle { a: u32, b: u32, c: u32, instance: u32 }
    struct Instance { to_world: mat4x3f, normal_to_world: mat3x3f, material: u32, flip: f32 }
    struct Material {
        base_color: vec3f, alpha_cutoff: f32, emission: vec3f, flags: u32,
        base_color_image: vec4u, emission_image: vec4u, normal_image: vec4u, roughness_image: vec4u,
        base_color_uv: mat3x2f, emission_uv: mat3x2f, normal_uv: mat3x2f, roughness_uv: mat3x2f,
        metallic: f32, roughness: f32, normal_scale: f32,
    }
    struct Light {
        position: vec3f, kind: u32, direction: vec3f, first_view: u32, intensity: vec3f, cos_outer: f32,
        cos_inner: f32, view_count: u32,
    }
    struct Emitter {
        a: vec3f, kind: u32, b: vec3f, instance: u32, c: vec3f, probability: f32, vertices: vec3u, other: u32,
        threshold: f32, cos_outer: f32, cos_inner: f32,
    }
    struct View {
        view_projection: mat4x4f, position: vec3f, light: u32, direction: vec3f, face: u32,
        near: f32, far: f32, texel: f32,
    }
    struct Camera {
        view_projection: mat4x4f, inverse_view_projection: mat4x4f, position: vec3f, near: f32,
        forward: vec3f, aspect: f32, right: vec3f, parallel: f32, up: vec3f, distance: vec4f,
    }
";

#[test]
fn tables_are_what_wgsl_lays_out() {
    let module = naga::front::wgsl::parse_str(WGSL).unwrap();
    let mut found = 0;
    for name in buffers::NAMES.iter().chain(&["camera"]) {
        let table = layout(name).unwrap();
        let Some((_, ty)) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(table.name)) else {
            let lists = [
                ("texels", "u32", 4, 0),
                ("environment", "vec4f", 16, 0),
                ("bvh", "vec4u", 16, 0),
                ("atlas", "vec2u", 8, 0),
            ];
            assert!(lists.contains(&(*name, table.name, table.stride, table.fields.len())), "{name}");
            continue;
        };
        let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is a struct") };
        assert_eq!(table.stride, *span, "{name}");
        let ours: Vec<_> = table.fields.iter().map(|f| (f.name, f.offset, f.kind.size())).collect();
        let theirs: Vec<_> = members
            .iter()
            .map(|m| (m.name.as_deref().unwrap(), m.offset, module.types[m.ty].inner.size(module.to_ctx())))
            .collect();
        assert_eq!(ours, theirs, "{name}");
        found += 1;
    }
    assert_eq!(found, 9);
}

/// Each kind's WGSL name means a type of its size.
#[test]
fn kinds_are_named_as_wgsl_names_them() {
    use FieldKind::*;
    for kind in [F32, U32, Vec2F, Vec2U, Vec3F, Vec3U, Vec4F, Vec4U, Mat3x2F, Mat3x3F, Mat4x3F, Mat4x4F] {
        let module = naga::front::wgsl::parse_str(&format!("struct S {{ field: {} }}", kind.wgsl())).unwrap();
        let member = module.types.iter().find_map(|(_, ty)| match &ty.inner {
            naga::TypeInner::Struct { members, .. } => Some(members[0].ty),
            _ => None,
        });
        assert_eq!(module.types[member.unwrap()].inner.size(module.to_ctx()), kind.size());
    }
}

#[test]
fn empty_lists_are_one_zeroed_element() {
    let scene = Scene::default();
    for name in buffers::NAMES {
        let bytes = scene.bytes(name).unwrap();
        if name == "bvh" {
            continue;
        }
        assert_eq!(bytes.len(), layout(name).unwrap().stride as usize, "{name}");
        assert!(bytes.iter().all(|byte| *byte == 0), "{name}");
    }
    assert_eq!(scene.bytes("no such list"), None);
}

#[test]
fn features_are_those_that_are_named() {
    let features = features::features(&Scene::default());
    let kinds: Vec<_> = features.iter().map(|(name, feature)| (*name, feature.kind())).collect();
    let named: Vec<_> = features::NAMES.iter().map(|feature| (feature.name, feature.kind)).collect();
    assert_eq!(kinds, named);
    let wanted = "scene.triangles scene.still_triangles scene.vertices scene.materials scene.instances scene.min scene.max scene.center \
        scene.emissive scene.max_emission scene.textured scene.roughness_textured scene.normal_mapped scene.second_uv \
        scene.vertex_colors scene.vertex_extras scene.masked scene.double_sided scene.min_roughness scene.max_metallic \
        scene.moving scene.duration lights.point lights.spot lights.directional lights.total views.total scene.environment scene.environment_width \
        scene.environment_height scene.environment_levels scene.environment_rows scene.environment_turn cameras.total";
    assert_eq!(named.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(" "), wanted);
}

#[test]
fn colours_are_packed_as_kernels_unpack_them() {
    // unpack2x16float takes the lower half first.
    assert_eq!(VertexExtra::pack_color([1.0, 0.5, 0.25, 2.0]), [0x3800_3c00, 0x4000_3400]);
    let extra = VertexExtra { color: VertexExtra::pack_color([0.0, 0.125, 1.0, 0.75]), ..VertexExtra::NONE };
    assert_eq!(extra.unpacked_color(), [0.0, 0.125, 1.0, 0.75]);
    assert_eq!(VertexExtra::NONE.unpacked_color(), [1.0; 4]);
}
