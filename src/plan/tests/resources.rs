//! Sizes, formats and references.

use super::*;
use wgpu_types::TextureFormat;

#[test]
fn sizes_are_computed() {
    let plan = plan(
        r#"knobs: {"n": (default: 20, range: (1, 64), about: ""),
                   "f": (default: "rgba8unorm", values: ["rgba8unorm", "r32float"], about: "")},
        resources: {
            "screen": Texture(format: "rgba16float", start: Covered),
            "half": Texture(format: "if(n > 4, 'r32uint', f)", size: ["screen.width / 2", 10], mips: "all", start: Fill(0)),
            "volume": Texture(format: "f", size: ["n", "n", "half.mips"], mips: "2", start: Kept(value: 1, reset: [Camera])),
            "line": Texture(format: "r8unorm", size: [7], mips: "all", start: Covered),
            "array": Texture(format: "depth32float", size: [4, 4], layers: "lights.point", start: Covered),
            "list": Buffer(count: "volume.depth * array.layers * scene.triangles", start: Covered),
            "head": Buffer(start: Covered),
        }"#,
    );
    let texture = |format, dimensions, size, mips, layers, array| ResourceKind::Texture {
        format,
        dimensions,
        size: Some(size),
        mips: Some(mips),
        layers: Some(layers),
        array,
    };
    use TextureFormat::{Depth32Float, R8Unorm, R32Uint, Rgba8Unorm, Rgba16Float};
    assert_eq!(plan.kind("screen"), &texture(Rgba16Float, 2, [640, 480, 1], 1, 1, false));
    assert_eq!(plan.kind("half"), &texture(R32Uint, 2, [320, 10, 1], 9, 1, false));
    assert_eq!(plan.kind("volume"), &texture(Rgba8Unorm, 3, [20, 20, 9], 2, 1, false));
    assert_eq!(plan.kind("line"), &texture(R8Unorm, 1, [7, 1, 1], 1, 1, false));
    assert_eq!(plan.kind("array"), &texture(Depth32Float, 2, [4, 4, 1], 1, 2, true));
    assert_eq!(plan.kind("list"), &ResourceKind::Buffer { count: Some(9 * 2 * 12) });
    assert_eq!(plan.kind("head"), &ResourceKind::Buffer { count: Some(1) });
    assert_eq!(plan.kind("lights"), &ResourceKind::Scene);
    let volume = plan.resources.iter().find(|resource| resource.path == "volume").unwrap();
    assert_eq!(volume.start, Start::Kept { value: 1.0, reset: [Cause::Camera].into(), steady: false });
}

#[test]
fn sizes_without_a_scene_are_unknown() {
    let text = r#"resources: {
        "array": Texture(format: "r32uint", size: [4, "scene.triangles"], layers: "lights.point", mips: "all", start: Covered),
        "list": Buffer(count: "array.height + array.mips + array.layers", start: Covered)}"#;
    let plan = plan_with(text, &[], &no_scene());
    let (format, dimensions) = (TextureFormat::R32Uint, 2);
    let unknown =
        ResourceKind::Texture { format, dimensions, size: None, mips: None, layers: None, array: true };
    assert_eq!(plan.kind("array"), &unknown);
    assert_eq!(plan.kind("list"), &ResourceKind::Buffer { count: None });
}

#[test]
fn references_name_pieces() {
    let plan = plan(
        r#"values: {"two": 2},
        resources: {
            "mips": Texture(format: "r32uint", size: [64, 64], mips: "all", start: Kept),
            "layers": Texture(format: "r32uint", size: [4, 4], mips: 2, layers: 5, start: Covered),
        },
        stages: [
            Compute(kernel: "k", over: Texels("b"), bind: {
                "a": "mips", "b": "mips@mip3", "c": " mips @ mip( two * (1 + 1) ) @previous ", "d": "layers@mip1@layer(two + 2)",
                "e": "layers@layer4", "f": "mips@previous",
            }),
            Raster(kernel: "r", draw: Indirect(buffer: "lights", offset: "two"), depth: (target: "layers@layer0", compare: Less)),
            Raster(kernel: "q", draw: Points("two + 1"), blend: Max),
            Compute(kernel: "c", over: Count("two", 3)),
            Compute(kernel: "i", over: Indirect(buffer: "views")),
        ]"#,
    );
    let bound: Vec<_> = ["a", "b", "c", "d", "e", "f"].iter().map(|key| plan.bound("k", key)).collect();
    assert_eq!(
        bound,
        ["mips", "mips@mip3", "mips@mip4@previous", "layers@mip1@layer4", "layers@layer4", "mips@previous"]
    );
    let history: Vec<_> = plan.resources.iter().filter(|r| r.history).map(|r| r.path.as_str()).collect();
    assert_eq!(history, ["mips"]);
    let Work::Compute(Threads::Texels(over, place)) = &plan.stage("k").work else { panic!() };
    assert_eq!((plan.show(over).as_str(), place.text()), ("mips@mip3", "b"));
    let Work::Raster { draw: Draw::Indirect(buffer, 2, _), depth: Some(depth), blend: None } =
        &plan.stage("r").work
    else {
        panic!()
    };
    assert_eq!((plan.show(buffer).as_str(), plan.show(&depth.target).as_str()), ("lights", "layers@layer0"));
    assert!(depth.write && depth.compare == Compare::Less);
    let points = Work::Raster { draw: Draw::Points(Some(3)), depth: None, blend: Some(Blend::Max) };
    assert_eq!(plan.stage("q").work, points);
    assert_eq!(plan.stage("c").work, Work::Compute(Threads::Count(Some([2, 3, 1]))));
    assert!(matches!(plan.stage("i").work, Work::Compute(Threads::Indirect(_, 0, _))));
}

/// What is dropped needs no numbers within bounds: it says `when` because of them.
#[test]
fn what_is_dropped_can_be_out_of_bounds() {
    let plan = plan_with(
        r#"parts: {"p": "p"}, resources: {"t": Texture(format: "r32uint", size: [4, 4], mips: 2, start: Covered)},
        stages: [
            Compute(kernel: "a", over: Count("12 / lights.directional"), when: "lights.directional > 0", bind: {"x": "t@mip7"}),
            Part(role: "p", when: "lights.directional > 0"),
        ]"#,
        &[(
            "p",
            r#"Part(about: "", role: "p", stages: [Compute(kernel: "b", over: Texels("q"))],
                resources: {"q": Buffer(count: "lights.directional", start: Covered)})"#,
        )],
        &setup(),
    );
    assert_eq!(plan.paths(), ["a", "p/b"]);
    assert_eq!(plan.bound("a", "x"), "t@mip1");
    assert_eq!(plan.kind("p.q"), &ResourceKind::Buffer { count: None });
}
