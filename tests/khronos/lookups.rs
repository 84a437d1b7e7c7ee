//! The kernels' functions for materials against the specification's formulas, evaluated here in double precision.

use glam::{DMat2, DVec2, DVec3, DVec4};
use serde_json::{Value, json};
use std::io::Cursor;
use std::path::Path;
use std::process::Command;
use voxgi::picture::{Picture, read_exr};
use voxgi::scene::Scene;

const SIZE: u32 = 64;

fn uri(kind: &str, bytes: &[u8]) -> String {
    let hex: String = bytes.iter().map(|byte| format!("%{byte:02x}")).collect();
    format!("data:{kind},{hex}")
}

/// Noise.
fn picture(width: u32, height: u32) -> String {
    let bytes = (0..width * height * 4).map(|i| (lot(i + 977 * width) * 255.0) as u8).collect();
    let mut png = Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_raw(width, height, bytes).expect("as many bytes");
    picture.write_to(&mut png, image::ImageFormat::Png).expect("a PNG");
    uri("image/png", &png.into_inner())
}

/// As the kernel draws.
fn lot(n: u32) -> f64 {
    let state = n.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    f64::from(((word >> 22) ^ word) & 0xffff) / 65536.0
}

const OFFSET: [f64; 2] = [0.3, -0.2];
const SCALE: [f64; 2] = [1.5, 0.75];
const ROTATION: f64 = 0.4;

fn materials() -> Value {
    let transform = |set: Value| {
        let fields = json!({"offset": OFFSET, "scale": SCALE, "rotation": ROTATION, "texCoord": set});
        json!({"KHR_texture_transform": fields})
    };
    json!([
        {
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.5, 0.75, 1, 1], "baseColorTexture": {"index": 0},
                "metallicFactor": 0.5, "roughnessFactor": 0.75,
                "metallicRoughnessTexture": {"index": 1, "texCoord": 1},
            },
            "emissiveFactor": [1, 0.5, 0.25], "emissiveTexture": {"index": 1, "extensions": transform(json!(1))},
            "normalTexture": {"index": 2, "scale": 0.5, "extensions": transform(json!(0))},
        },
        {
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 3, "texCoord": 1}},
            "normalTexture": {"index": 1, "texCoord": 0},
        },
        {"pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 0.125, 1], "metallicFactor": 0.125}},
    ])
}

fn document() -> Value {
    let positions: Vec<u8> =
        [0f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|x| x.to_le_bytes()).collect();
    let uvs = &positions[..24];
    let list =
        |view: u32, kind: &str| json!({"bufferView": view, "componentType": 5126, "count": 3, "type": kind});
    let attributes = json!({"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 1});
    let primitive = |material: u32| json!({"material": material, "attributes": attributes});
    json!({
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive(0), primitive(1), primitive(2)]}],
        "accessors": [list(0, "VEC3"), list(1, "VEC2")],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 1, "byteLength": 24}],
        "buffers": [
            {"byteLength": 36, "uri": uri("application/octet-stream", &positions)},
            {"byteLength": 24, "uri": uri("application/octet-stream", uvs)},
        ],
        "images": [{"uri": picture(5, 7)}, {"uri": picture(16, 4)}, {"uri": picture(33, 12)}],
        "samplers": [{"wrapS": 10497, "wrapT": 33648}, {"wrapS": 33071, "wrapT": 10497}, {"magFilter": 9728}],
        "textures": [
            {"source": 0, "sampler": 0}, {"source": 1, "sampler": 1}, {"source": 2}, {"source": 0, "sampler": 2},
        ],
        "materials": materials(),
    })
}

/// How the document's textures wrap, (0 repeat, 1 clamp, 2 mirror), and whether texels are magnified unblended.
const TEXTURES: [([u32; 2], bool); 4] = [([0, 2], false), ([1, 0], false), ([0, 0], false), ([0, 0], true)];
const IMAGES: [(u32, u32); 3] = [(5, 7), (16, 4), (33, 12)];

fn wrap(index: f64, size: u32, mode: u32) -> usize {
    let size = f64::from(size);
    let place = match mode {
        0 => index.rem_euclid(size),
        1 => index.clamp(0.0, size - 1.0),
        _ => (index.rem_euclid(2.0 * size)).min(2.0 * size - 1.0 - index.rem_euclid(2.0 * size)),
    };
    place as usize
}

fn linear(coded: f64) -> f64 {
    if coded <= 0.04045 { coded / 12.92 } else { ((coded + 0.055) / 1.055).powf(2.4) }
}

/// Texture `index` at one level, of its image stored as colour or as data.
fn level(scene: &Scene, index: usize, srgb: bool, level: u32, uv: DVec2, nearest: bool) -> DVec4 {
    let (width, height) = IMAGES[[0, 1, 2, 0][index]];
    let image =
        scene.images.iter().find(|i| (i.width, i.height, i.srgb) == (width, height, srgb)).expect("an image");
    let side = |n: u32, level: u32| (n >> level).max(1);
    let before: u32 = (0..level).map(|level| side(width, level) * side(height, level)).sum();
    let (w, h) = (side(width, level), side(height, level));
    let texel = |x: f64, y: f64| {
        let [u, v] = TEXTURES[index].0;
        let place = wrap(y, h, v) * w as usize + wrap(x, w, u);
        let bytes = scene.texels[(image.offset + before) as usize + place].to_le_bytes();
        let [r, g, b, a] = bytes.map(|byte| f64::from(byte) / 255.0);
        if srgb { DVec4::new(linear(r), linear(g), linear(b), a) } else { DVec4::new(r, g, b, a) }
    };
    let at = uv * DVec2::new(w.into(), h.into());
    if nearest {
        return texel(at.x.floor(), at.y.floor());
    }
    let (low, part) = ((at - 0.5).floor(), (at - 0.5) - (at - 0.5).floor());
    let row = |y: f64| texel(low.x, y).lerp(texel(low.x + 1.0, y), part.x);
    row(low.y).lerp(row(low.y + 1.0), part.y)
}

/// A lot's texture coordinates and footprint in one set.
type Place = (DVec2, f64);

fn texture(scene: &Scene, index: usize, srgb: bool, (uv, footprint): Place) -> DVec4 {
    let (width, height) = IMAGES[[0, 1, 2, 0][index]];
    let texels = footprint * (f64::from(width) * f64::from(height)).sqrt();
    let most = f64::from(width.max(height).ilog2());
    let fine = texels.log2().clamp(0.0, most);
    let nearest = TEXTURES[index].1 && texels < 1.0;
    let sharp = level(scene, index, srgb, fine as u32, uv, nearest);
    if fine.fract() == 0.0 {
        return sharp;
    }
    sharp.lerp(level(scene, index, srgb, fine as u32 + 1, uv, false), fine.fract())
}

/// KHR_texture_transform, as a product of matrices.
fn transformed((uv, footprint): Place) -> Place {
    let scale = DMat2::from_diagonal(SCALE.into());
    // Counter-clockwise where v points down.
    let matrix = DMat2::from_angle(-ROTATION) * scale;
    (matrix * uv + DVec2::from(OFFSET), footprint * (SCALE[0] * SCALE[1]).sqrt())
}

/// What the four outputs should be.
fn expected(scene: &Scene, material: u32, sets: [Place; 2], x: u32) -> [DVec4; 4] {
    let normal = |texel: DVec4, scale: f64| {
        let map = (texel.truncate() * 2.0 - 1.0) * DVec3::new(scale, scale, 1.0);
        let (n, t) = (DVec3::new(0.25, 1.0, 0.5), DVec3::new(1.0, -0.125, 0.25));
        let sign = if x.is_multiple_of(2) { 1.0 } else { -1.0 };
        let bent = t * map.x + n.cross(t) * sign * map.y + n * map.z;
        if x == 5 { n.normalize().extend(1.0) } else { bent.normalize().extend(1.0) }
    };
    let flat = DVec4::new(0.5, 0.5, 1.0, 1.0);
    match material {
        0 => {
            let surface = texture(scene, 1, false, sets[1]);
            let emission = texture(scene, 1, true, transformed(sets[1])).truncate();
            [
                texture(scene, 0, true, sets[0]) * DVec4::new(0.5, 0.75, 1.0, 1.0),
                (emission * DVec3::new(1.0, 0.5, 0.25)).extend(1.0),
                DVec4::new(0.5 * surface.z, 0.75 * surface.y, 0.0, 1.0),
                normal(texture(scene, 2, false, transformed(sets[0])), 0.5),
            ]
        }
        1 => [
            texture(scene, 3, true, sets[1]),
            DVec4::W,
            DVec4::new(1.0, 1.0, 0.0, 1.0),
            normal(texture(scene, 1, false, sets[0]), 1.0),
        ],
        _ => {
            [DVec4::new(0.25, 0.5, 0.125, 1.0), DVec4::W, DVec4::new(0.125, 1.0, 0.0, 1.0), normal(flat, 1.0)]
        }
    }
}

fn rendered(path: &Path) -> [Picture; 4] {
    let folder = tempfile::tempdir().expect("a folder");
    let outputs = ["base", "emitted", "surface", "bent"];
    let file = |output: &str| folder.path().join(format!("{output}.exr"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
    command.arg("render").arg(path).args(["-p", "lookups", "--size", &format!("{SIZE}x{SIZE}")]);
    command.arg("--library").arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/library-surfaces"));
    for output in outputs {
        command.arg("--output").arg(format!("{output}={}", file(output).display()));
    }
    let run = command.output().expect("the program starts");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    outputs.map(|output| read_exr(&file(output)).expect("a picture").pop().expect("a layer").1)
}

/// Greatest difference of each output. `spoil` changes what is expected of the coordinates.
fn differences(scene: &Scene, pictures: &[Picture; 4], spoil: impl Fn([Place; 2]) -> [Place; 2]) -> [f64; 4] {
    let mut worst = [0.0f64; 4];
    for (y, x) in (0..SIZE * SIZE).map(|i| (i / SIZE, i % SIZE)) {
        let n = 8 * (y * SIZE + x);
        let uv = |k: u32| DVec2::new(lot(n + k), lot(n + k + 1)) * 4.0 - 1.5;
        let sets = [(uv(0), (-8.0 * lot(n + 4)).exp2()), (uv(2), (-8.0 * lot(n + 5)).exp2())];
        let expected = expected(scene, y % 3, spoil(sets), x);
        for (i, expected) in expected.into_iter().enumerate() {
            let texel = pictures[i].texel(x, y).expect("the pixel is there");
            let channels = (0..texel.len().min(4)).map(|c| (f64::from(texel[c]) - expected[c]).abs());
            worst[i] = worst[i].max(channels.fold(0.0, f64::max));
        }
    }
    worst
}

#[test]
fn materials_are_looked_up_as_specified() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.gltf");
    std::fs::write(&path, document().to_string()).expect("the scene can be written");
    let scene = voxgi::scene::load(&path).expect("the scene loads");
    assert_eq!(scene.images.len(), 4, "one image is stored twice, as colour and as data");
    let pictures = rendered(&path);
    let right = differences(&scene, &pictures, |sets| sets);
    println!("differences {right:?}");
    assert!(right.iter().all(|difference| *difference < 2e-4), "{right:?}");
    for wrong in [
        differences(&scene, &pictures, |[a, b]| [b, a]),
        differences(&scene, &pictures, |sets| sets.map(|(uv, footprint)| (uv, footprint * 1.5))),
        differences(&scene, &pictures, |sets| {
            sets.map(|(uv, footprint)| (uv * DVec2::new(1.0, -1.0), footprint))
        }),
    ] {
        assert!(wrong.iter().all(|difference| *difference > 0.02), "{wrong:?}");
    }
}
