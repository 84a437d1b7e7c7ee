//! Programs: numbers, formats, access, and that dropped parts leave nothing behind.

use super::*;
use crate::kernel::{BindingKind, Choice, Program, finish};
use naga::valid::Capabilities;
use naga::{AddressSpace, StorageAccess};
use wgpu_types::{ShaderStages, TextureFormat};

const STORE: &str = "
var<storage> source: array<vec4f>;
var<uniform> unrelated: vec4f;
var<storage, read_write> spare: array<vec4f>;
var image: texture_storage_2d<rgba16float, write>;
var counts: texture_storage_2d<r32uint, atomic>;
@compute @workgroup_size(8) fn other() { spare[0] = unrelated; }
@compute @workgroup_size(8) fn store(@builtin(global_invocation_id) id: vec3u) {
    textureStore(image, id.xy, source[id.x]);
    if id.x > 4 { textureStore(image, id.xy, vec4f(f32(arrayLength(&spare)))); }
}
@compute @workgroup_size(8) fn count() { textureAtomicAdd(counts, vec2u(), 1u); }
";

fn formats(formats: &[(&str, TextureFormat)]) -> Choice {
    let formats = formats.iter().map(|(name, format)| ((*name).to_owned(), *format)).collect();
    Choice { formats, ..Choice::default() }
}

fn names(program: &Program) -> Vec<&str> {
    program.bindings.iter().map(|bound| bound.binding.name.as_str()).collect()
}

/// What the module itself says: (name, group, number) of all that is bound.
fn numbers(program: &Program) -> Vec<(String, u32, u32)> {
    let variables = program.module.global_variables.iter();
    variables
        .map(|(_, v)| (v.name.clone().unwrap(), v.binding.unwrap().group, v.binding.unwrap().binding))
        .collect()
}

#[test]
fn only_what_the_chosen_entry_points_use_is_left_and_numbered() {
    let reflected = reflected(STORE);
    let store = finish(&reflected, &["store"], &Choice::default()).unwrap();
    assert_eq!(names(&store), ["source", "spare", "image"]);
    let expected = ["source", "spare", "image"].iter().zip(0..).map(|(n, i)| ((*n).to_owned(), 0, i));
    assert_eq!(numbers(&store), expected.collect::<Vec<_>>());
    assert_eq!(store.entries[0].uses.iter().map(|used| used.binding).collect::<Vec<_>>(), [0, 1, 2]);
    let access: Vec<_> = store.bindings.iter().map(|bound| (bound.read, bound.write)).collect();
    assert_eq!(access, [(true, false), (false, false), (false, true)]);
    let other = finish(&reflected, &["other"], &Choice::default()).unwrap();
    assert_eq!(names(&other), ["unrelated", "spare"]);
    assert_eq!(other.module.entry_points.len(), 1);
    let problem = only(finish(&reflected, &["stroe"], &Choice::default()));
    assert_eq!((problem.code, problem.help.as_deref()), ("unknown-entry", Some("did you mean `store`?")));
}

#[test]
fn bindings_are_visible_to_the_stages_that_use_them() {
    let reflected = reflected(
        "var<storage> points: array<vec4f>; var<uniform> tint: vec4f; var t: texture_2d<f32>; var s: sampler;
         struct Out { @location(0) color: vec4f }
         @vertex fn v(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f { return points[i] * tint; }
         @fragment fn f(@builtin(position) p: vec4f) -> Out { return Out(textureSample(t, s, p.xy) * tint); }",
    );
    let program = finish(&reflected, &["f", "v"], &Choice::default()).unwrap();
    let (vertex, fragment) = (ShaderStages::VERTEX, ShaderStages::FRAGMENT);
    let visible: Vec<_> = program.bindings.iter().map(|bound| bound.visibility).collect();
    assert_eq!(visible, [vertex, vertex | fragment, fragment, fragment]);
    assert_eq!(program.entries.iter().map(|entry| entry.name.as_str()).collect::<Vec<_>>(), ["f", "v"]);
    let fragment_only = finish(&reflected, &["f"], &Choice::default()).unwrap();
    assert_eq!(names(&fragment_only), ["tint", "t", "s"]);
    assert_eq!(fragment_only.entries[0].sampled, [(1, 2)]);
}

#[test]
fn storage_textures_follow_the_format_of_their_resource_within_a_class() {
    let reflected = reflected(STORE);
    for format in [TextureFormat::Rgba8Unorm, TextureFormat::R32Float, TextureFormat::Rg11b10Ufloat] {
        let program = finish(&reflected, &["store"], &formats(&[("image", format)])).unwrap();
        let bound = program.bindings.iter().find(|bound| bound.binding.name == "image").unwrap();
        let BindingKind::StorageTexture { format: declared, .. } = bound.binding.kind else { panic!() };
        assert_eq!(declared, format);
        let variable =
            program.module.global_variables.iter().find(|(_, v)| v.name.as_deref() == Some("image"));
        let naga::TypeInner::Image { class: naga::ImageClass::Storage { format: stored, .. }, .. } =
            program.module.types[variable.unwrap().1.ty].inner
        else {
            panic!()
        };
        assert_eq!(wgpu_naga_bridge::map_storage_format_from_naga(stored), format);
    }
    for (binding, entry, format, said) in [
        ("image", "store", TextureFormat::R32Uint, "stores floats"),
        ("image", "store", TextureFormat::Rgba8UnormSrgb, "no kernel stores to that format"),
        ("image", "store", TextureFormat::Depth32Float, "no kernel stores to that format"),
        ("counts", "count", TextureFormat::Rgba8Uint, "atomics"),
        ("counts", "count", TextureFormat::R32Sint, "stores unsigned integers"),
    ] {
        let problem = only(finish(&reflected, &[entry], &formats(&[(binding, format)])));
        assert_eq!(problem.code, "storage-format");
        assert!(problem.message.contains(said), "{}", problem.message);
        assert_eq!(label(&problem, 0).3, binding);
    }
    let unused = finish(&reflected, &["other"], &formats(&[("image", TextureFormat::R32Uint)]));
    assert!(unused.is_ok(), "a format of what is not used does not matter");
}

#[test]
fn a_reader_can_be_made_to_declare_its_buffer_writable() {
    let reflected = reflected(STORE);
    let writable = Choice { writable: ["source".to_owned()].into(), ..Choice::default() };
    let space = |choice: &Choice| {
        let program = finish(&reflected, &["store"], choice).unwrap();
        let BindingKind::Storage(layout) = &program.bindings[0].binding.kind else { panic!() };
        let (_, variable) = program.module.global_variables.iter().next().unwrap();
        assert_eq!(variable.name.as_deref(), Some("source"));
        (layout.writable, variable.space, program.bindings[0].write)
    };
    let (load, store) = (StorageAccess::LOAD, StorageAccess::STORE);
    assert_eq!(space(&Choice::default()), (false, AddressSpace::Storage { access: load }, false));
    assert_eq!(space(&writable), (true, AddressSpace::Storage { access: load | store }, false));
}

#[test]
fn what_the_device_lacks_is_said_at_the_kernel() {
    let reflected = reflected(STORE);
    let choice = Choice { capabilities: Capabilities::empty(), ..Choice::default() };
    let problem = only(finish(&reflected, &["count"], &choice));
    assert_eq!((problem.code, label(&problem, 0).0.as_str()), ("wgsl", "main.wgsl"));
    assert!(finish(&reflected, &["store"], &choice).is_ok());
}

#[test]
fn an_effect_that_is_dropped_leaves_no_binding_function_or_instruction_behind() {
    let text = "
        @if(lit) import lib/light;
        var<storage, read_write> image: array<vec4f>;
        @compute @workgroup_size(64) fn shade(@builtin(global_invocation_id) id: vec3u, @if(lit) @builtin(local_invocation_index) lane: u32,) {
            var color = vec4f(0.5);
            @if(lit) { for (var i = 0u; i < 4; i++) { color += lamp(i + lane); } }
            image[id.x] = color;
        }";
    let light = "@if(faded) var fade: texture_depth_2d;
        struct Lamp { color: vec4f, @if(faded) layer: u32, }
        var<storage> lamps: array<Lamp>;
        fn lamp(i: u32) -> vec4f {
            var color = lamps[i].color;
            @if(faded) color *= textureLoad(fade, vec2u(lamps[i].layer), 0);
            return color;
        }";
    let without = "
        var<storage, read_write> image: array<vec4f>;
        @compute @workgroup_size(64) fn shade(@builtin(global_invocation_id) id: vec3u) {
            var color = vec4f(0.5);
            image[id.x] = color;
        }";
    let program = |files: &[(&str, &str)], lit, faded| {
        let names = known(&[("lit", Value::Flag(lit)), ("faded", Value::Flag(faded))]);
        let composed = Files::new(files).compose(&[], &names).unwrap();
        finish(&reflect(&composed, &BTreeMap::new()).unwrap(), &["shade"], &Choice::default()).unwrap()
    };
    let size = |program: &Program| {
        let module = &program.module;
        let functions = module.functions.iter().map(|(_, f)| f.expressions.len()).sum::<usize>();
        (
            module.functions.len(),
            module.types.len(),
            functions + module.entry_points[0].function.expressions.len(),
        )
    };
    let files = [("main", text), ("lib/light", light)];
    let (full, plain, dark) =
        (program(&files, true, true), program(&files, true, false), program(&files, false, true));
    let never = program(&[("main", without)], false, false);
    assert_eq!(names(&full), ["fade", "lamps", "image"]);
    assert_eq!(names(&plain), ["lamps", "image"]);
    assert_eq!(names(&dark), ["image"]);
    assert!(size(&full).2 > size(&plain).2 && size(&plain).2 > size(&dark).2);
    assert_eq!(size(&dark), size(&never));
}
