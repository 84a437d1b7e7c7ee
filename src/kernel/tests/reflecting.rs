//! Reflection, against expectations worked out by hand from the layout rules of WGSL.

use super::*;
use crate::kernel::{BindingKind, BufferLayout, Field, FieldKind, Scalar, Stage, StructLayout, Target, Use};
use wgpu_types::{StorageTextureAccess, TextureFormat, TextureSampleType, TextureViewDimension};

/// One binding of every kind, all used.
const EVERYTHING: &str = "
struct Knobs { scale: f32, @size(12) level: u32, offset: vec3f, turn: mat3x3f, table: array<vec4f, 2> }
struct Cell { count: atomic<u32>, light: vec3f }
struct Grid { size: vec3u, flags: i32, cells: array<Cell> }
struct Counters { written: atomic<u32>, dropped: atomic<u32> }
// How it runs.
var<uniform> knobs: Knobs;
var<uniform> tint: vec3f;
var<storage, read_write> grid: Grid;
var<storage> vertices: array<vec3f>;
var<storage, read_write> counters: Counters;
var albedo: texture_2d_array<f32>;
var ids: texture_2d<u32>;
var volume: texture_3d<f32>;
var depths: texture_depth_2d_array;
var faces: texture_cube<f32>;
var samples: texture_multisampled_2d<f32>;
var smooth_: sampler;
var compare: sampler_comparison;
var target_: texture_storage_3d<rgba16float, write>;
var sums: texture_storage_2d<r32uint, read_write>;
var<storage> unused: array<u32>;
var<workgroup> shared_: array<u32, 4>;

@compute @workgroup_size(8, 4) fn run(@builtin(global_invocation_id) id: vec3u) {
    shared_[0] = id.x;
    atomicAdd(&grid.cells[id.x].count, knobs.level);
    atomicStore(&counters.written, 1u);
    var sum = textureSampleLevel(albedo, smooth_, vec2f(), 0, 0.0).xyz + tint + vertices[id.x];
    sum += textureLoad(volume, id, 0).xyz + textureSampleLevel(faces, smooth_, sum, 0.0).xyz;
    sum += vec3f(textureSampleCompareLevel(depths, compare, vec2f(), 0, 0.5));
    sum += textureLoad(samples, id.xy, 0).xyz + vec3f(textureLoad(ids, id.xy, 0).xyz);
    textureStore(target_, id, vec4f(sum, 1.0));
    textureStore(sums, id.xy, textureLoad(sums, id.xy) + 1);
}
";

fn field(name: &str, offset: u64, kind: FieldKind) -> Field {
    Field { name: name.to_owned(), offset, kind }
}

fn vector(components: u8, scalar: Scalar) -> FieldKind {
    FieldKind::Vector { components, scalar }
}

fn kind(reflected: &Reflected, name: &str) -> BindingKind {
    reflected.bindings.iter().find(|binding| binding.name == name).unwrap().kind.clone()
}

#[test]
fn every_kind_of_binding() {
    let reflected = reflected(EVERYTHING);
    let names: Vec<&str> = reflected.bindings.iter().map(|binding| binding.name.as_str()).collect();
    let all = "knobs tint grid vertices counters albedo ids volume depths faces samples smooth_ compare target_ sums";
    assert_eq!(names, all.split(' ').collect::<Vec<_>>());
    assert_eq!(
        (reflected.bindings[0].about.as_str(), reflected.bindings[0].place.text()),
        ("How it runs.", "knobs")
    );
    let kind = |name| kind(&reflected, name);
    let knobs = vec![
        field("scale", 0, vector(1, Scalar::F32)),
        field("level", 4, vector(1, Scalar::U32)),
        field("offset", 16, vector(3, Scalar::F32)),
        field("turn", 32, FieldKind::Matrix { columns: 3, rows: 3 }),
        field("table", 80, FieldKind::Other),
    ];
    assert_eq!(kind("knobs"), BindingKind::Uniform(StructLayout { size: 112, fields: knobs }));
    let tint = StructLayout { size: 12, fields: vec![field("tint", 0, vector(3, Scalar::F32))] };
    assert_eq!(kind("tint"), BindingKind::Uniform(tint));
    let cell = vec![field("count", 0, vector(1, Scalar::U32)), field("light", 16, vector(3, Scalar::F32))];
    let cells = BufferLayout {
        writable: true,
        head: 16,
        stride: Some(32),
        element: Some(StructLayout { size: 32, fields: cell }),
        atomic: true,
    };
    assert_eq!(kind("grid"), BindingKind::Storage(cells));
    let vertices = BufferLayout { writable: false, head: 0, stride: Some(16), element: None, atomic: false };
    assert_eq!(kind("vertices"), BindingKind::Storage(vertices));
    let counters =
        vec![field("written", 0, vector(1, Scalar::U32)), field("dropped", 4, vector(1, Scalar::U32))];
    let counters = StructLayout { size: 8, fields: counters };
    let counters =
        BufferLayout { writable: true, head: 8, stride: None, element: Some(counters), atomic: true };
    assert_eq!(kind("counters"), BindingKind::Storage(counters));
    let texture = |dimension, sample| BindingKind::Texture { dimension, sample, multisampled: false };
    let float = |filterable| TextureSampleType::Float { filterable };
    assert_eq!(kind("albedo"), texture(TextureViewDimension::D2Array, float(true)));
    assert_eq!(kind("ids"), texture(TextureViewDimension::D2, TextureSampleType::Uint));
    assert_eq!(kind("volume"), texture(TextureViewDimension::D3, float(false)));
    assert_eq!(kind("depths"), texture(TextureViewDimension::D2Array, TextureSampleType::Depth));
    assert_eq!(kind("faces"), texture(TextureViewDimension::Cube, float(true)));
    let multisampled = BindingKind::Texture {
        dimension: TextureViewDimension::D2,
        sample: float(false),
        multisampled: true,
    };
    assert_eq!(kind("samples"), multisampled);
    assert_eq!(kind("smooth_"), BindingKind::Sampler { comparison: false });
    assert_eq!(kind("compare"), BindingKind::Sampler { comparison: true });
    let storage = |dimension, format, access| BindingKind::StorageTexture { dimension, format, access };
    let (write, both) = (StorageTextureAccess::WriteOnly, StorageTextureAccess::ReadWrite);
    assert_eq!(kind("target_"), storage(TextureViewDimension::D3, TextureFormat::Rgba16Float, write));
    assert_eq!(kind("sums"), storage(TextureViewDimension::D2, TextureFormat::R32Uint, both));
}

#[test]
fn uses_and_pairs_of_an_entry_point() {
    let reflected = reflected(EVERYTHING);
    let [entry] = &reflected.entries[..] else { panic!() };
    assert_eq!((entry.name.as_str(), entry.stage, entry.workgroup_size), ("run", Stage::Compute, [8, 4, 1]));
    let name = |index: usize| reflected.bindings[index].name.as_str();
    let of = |read, write| -> Vec<&str> {
        entry.uses.iter().filter(|u| (u.read, u.write) == (read, write)).map(|u| name(u.binding)).collect()
    };
    assert_eq!(of(false, true), ["counters", "target_"]);
    assert_eq!(of(true, true), ["grid", "sums"]);
    assert_eq!(of(true, false).len(), 11);
    let pairs: Vec<_> = entry.sampled.iter().map(|(image, sampler)| (name(*image), name(*sampler))).collect();
    assert_eq!(pairs, [("albedo", "smooth_"), ("depths", "compare"), ("faces", "smooth_")]);
}

#[test]
fn each_entry_point_has_uses_of_its_own_through_functions_too() {
    let reflected = reflected(
        "var<storage, read_write> a: array<u32>; var<storage, read_write> b: array<u32>; var t: texture_2d<f32>; var s: sampler;
         fn copy() { b[0] = a[0]; }
         fn look(image: texture_2d<f32>, through: sampler) -> f32 { return textureSampleLevel(image, through, vec2f(), 0.0).x; }
         @compute @workgroup_size(1) fn one() { copy(); }
         @compute @workgroup_size(1) fn two() { a[0] = arrayLength(&b) + u32(look(t, s)); }",
    );
    let uses = |entry: usize| &reflected.entries[entry].uses;
    let at = |binding, read, write| Use { binding, read, write };
    assert_eq!(*uses(0), [at(0, true, false), at(1, false, true)]);
    assert_eq!(*uses(1), [at(0, false, true), at(1, false, false), at(2, true, false), at(3, true, false)]);
    assert_eq!((&reflected.entries[0].sampled, &reflected.entries[1].sampled), (&vec![], &vec![(2, 3)]));
    assert_eq!(
        kind(&reflected, "t"),
        BindingKind::Texture {
            dimension: TextureViewDimension::D2,
            sample: TextureSampleType::Float { filterable: true },
            multisampled: false
        }
    );
}

#[test]
fn targets_are_the_named_members_of_what_a_fragment_entry_returns() {
    let reflected = reflected(
        "struct Out { @location(1) normal: vec3f, @builtin(frag_depth) depth: f32, @location(0) id: u32 }
         @vertex fn v(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f { return vec4f(f32(i)); }
         @fragment fn f() -> Out { return Out(vec3f(), 0.5, 1); }
         @fragment fn nothing() { discard; }",
    );
    let entry = |name: &str| reflected.entries.iter().find(|entry| entry.name == name).unwrap();
    let target = |name: &str, location, scalar, components| Target {
        name: name.to_owned(),
        location,
        scalar,
        components,
    };
    assert_eq!(entry("f").targets, [target("id", 0, Scalar::U32, 1), target("normal", 1, Scalar::F32, 3)]);
    assert!(entry("f").depth && !entry("nothing").depth);
    assert!(entry("v").targets.is_empty() && entry("nothing").targets.is_empty());
    assert_eq!((entry("v").stage, entry("f").stage), (Stage::Vertex, Stage::Fragment));
    assert_eq!(entry("f").place.line_column(), (3, 23));
}

#[test]
fn overrides_size_workgroups_and_must_fit() {
    let text = "// Threads in a row.\noverride width: u32 = 4 * 2;\noverride depth: i32;\n@id(7) override tall: bool = false;\noverride gain: f32 = 0.5;
        @compute @workgroup_size(width, select(1u, 4u, tall)) fn c() { var x = gain * f32(depth); }";
    let composed =
        Files::new(&[("main", &format!("// Header.\n\n{text}"))]).compose(&[], &known(&[])).unwrap();
    let give = |values: &[(&str, f64)]| {
        reflect(&composed, &values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect())
    };
    let size = |values: &[(&str, f64)]| give(values).unwrap().entries[0].workgroup_size;
    assert_eq!(size(&[("depth", 1.0)]), [8, 1, 1]);
    assert_eq!(size(&[("depth", -1.0), ("width", 16.0), ("tall", 1.0), ("unknown", 3.0)]), [16, 4, 1]);
    let declared = give(&[("depth", 1.0)]).unwrap().overrides;
    let listed: Vec<_> = declared.iter().map(|o| (o.name.as_str(), o.default, o.about.as_str())).collect();
    let expected = [
        ("width", Some(8.0), "Threads in a row."),
        ("depth", None, ""),
        ("tall", Some(0.0), ""),
        ("gain", Some(0.5), ""),
    ];
    assert_eq!(listed, expected);
    let refused = |values: &[(&str, f64)], line: usize, name: &str| {
        let problem = only(give(values));
        let (_, found, _, text) = label(&problem, 0);
        assert_eq!((problem.code, found, text.as_str()), ("override-value", line, name), "{values:?}");
    };
    refused(&[], 5, "depth");
    refused(&[("depth", 0.5)], 5, "depth");
    refused(&[("depth", 1.0), ("width", -1.0)], 4, "width");
    refused(&[("depth", 1.0), ("width", 4_294_967_296.0)], 4, "width");
    refused(&[("depth", 1.0), ("gain", f64::NAN)], 7, "gain");
    refused(&[("depth", 1.0), ("gain", 1e300)], 7, "gain");
    refused(&[("depth", 1.0), ("tall", 2.0)], 6, "tall");
    assert_eq!(only(give(&[("depth", 1.0), ("width", 0.0)])).code, "workgroup-size");
}
