//! Triangles, areas and boxes of the scenes in `VOXGI_SCENES` against those of other programs.
//!
//! `truth.tsv` was measured by `measure.py`, with trimesh. Tolerances: coordinates and transforms are f32 here and f64
//! there, so a box may be off by some units in the last place of its largest coordinate, and an area, a sum of rounded
//! products, by a few 10⁻⁶ of itself. Counts are exact.

#[path = "../support/scenes.rs"]
mod support;

use glam::DVec3;
use support::scenes;
use voxgi::scene::listing::list;
use voxgi::scene::{Scene, load};

#[derive(Clone, Copy, Debug)]
struct Truth {
    triangles: usize,
    /// Of no area at all.
    degenerate: usize,
    area: f64,
    min: DVec3,
    max: DVec3,
}

/// What trimesh doesn't read, with the numbers that follow from the file by hand.
const NOT_BY_TRIMESH: [(&str, &str, Truth); 2] = [
    ("khronos/MeshPrimitiveModes.gltf", "trimesh reads no triangle fans", MODES),
    ("khronos/SimpleSparseAccessor.gltf", "trimesh reads no sparse accessors", SPARSE),
];

/// Three hexagons of circumradius 1, as 6 triangles, a strip of 4 and a fan of 6, side by side. The file has 0.866 for
/// half the root of 3.
const MODES: Truth = Truth {
    triangles: 16,
    degenerate: 0,
    area: 3.0 * 3.0 * 0.866,
    min: DVec3::new(-2.866, -4.0, 0.0),
    max: DVec3::new(2.866, -2.0, 0.0),
};

/// A strip of 6 × 1 m in squares cut in two, of whose upper corners three are raised, to 2, 3 and 4 m.
const SPARSE: Truth =
    Truth { triangles: 12, degenerate: 0, area: 12.0, min: DVec3::ZERO, max: DVec3::new(6.0, 4.0, 0.0) };

fn corners(scene: &Scene) -> impl Iterator<Item = [DVec3; 3]> {
    scene.triangles.iter().map(|t| {
        let [x, y, z, w] = scene.instances[t.instance as usize].to_world.map(|c| c.truncate().as_dvec3());
        [t.a, t.b, t.c].map(|corner| {
            let p = scene.vertices[corner as usize].position.as_dvec3();
            x * p.x + y * p.y + z * p.z + w
        })
    })
}

fn measure(scene: &Scene) -> Truth {
    let mut found = Truth {
        triangles: scene.triangles.len(),
        degenerate: 0,
        area: 0.0,
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };
    for [a, b, c] in corners(scene) {
        let area = (b - a).cross(c - a).length() * 0.5;
        found.area += area;
        found.degenerate += usize::from(area == 0.0);
        found.min = found.min.min(a).min(b).min(c);
        found.max = found.max.max(a).max(b).max(c);
    }
    found
}

/// What differs beyond tolerance.
fn differences(found: &Truth, truth: &Truth) -> Vec<String> {
    let mut list = Vec::new();
    if found.triangles != truth.triangles {
        list.push(format!("{} triangles, not {}", found.triangles, truth.triangles));
    }
    if (found.area - truth.area).abs() > 1e-5 * truth.area {
        list.push(format!("an area of {}, not {}", found.area, truth.area));
    }
    let reach = truth.min.abs().max(truth.max.abs()).max_element();
    let error = (found.min - truth.min).abs().max((found.max - truth.max).abs()).max_element();
    if error > 1e-6 * reach {
        list.push(format!("a box from {} to {}, not {} to {}", found.min, found.max, truth.min, truth.max));
    }
    // Whether a sliver has exactly no area is up to rounding, but for a handful.
    if found.degenerate.abs_diff(truth.degenerate) > 4 + truth.triangles / 1000 {
        list.push(format!("{} triangles without area, not {}", found.degenerate, truth.degenerate));
    }
    list
}

fn rows() -> Vec<(&'static str, Truth)> {
    let parse = |row: &'static str| {
        let [name, numbers @ ..] = &row.split('\t').collect::<Vec<_>>()[..] else { panic!("{row}") };
        let n: Vec<f64> = numbers.iter().map(|number| number.parse().unwrap()).collect();
        let (min, max) = (DVec3::from_slice(&n[3..6]), DVec3::from_slice(&n[6..9]));
        (*name, Truth { triangles: n[0] as usize, degenerate: n[1] as usize, area: n[2], min, max })
    };
    include_str!("truth.tsv").lines().skip(1).map(parse).collect()
}

#[test]
fn scenes_are_as_another_loader_sees_them() {
    let Some(folder) = scenes() else { return };
    let rows = rows();
    assert!(rows.len() >= 36);
    let mut wrong = Vec::new();
    for (name, truth) in rows {
        let found =
            measure(&load(&folder.join(name)).unwrap_or_else(|problems| panic!("{name}: {problems}")));
        let differ = differences(&found, &truth);
        match NOT_BY_TRIMESH.iter().find(|(file, ..)| *file == name) {
            None => wrong.extend(differ.into_iter().map(|what| format!("{name} has {what}"))),
            Some((_, why, own)) => {
                assert!(!differ.is_empty(), "{name} no longer is an exception ({why})");
                let differ = differences(&found, own);
                wrong.extend(differ.into_iter().map(|what| format!("{name} has {what} ({why})")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A control: a triangle less, one percent of size, one corner a millimetre off.
#[test]
fn differences_are_seen() {
    let (_, truth) = rows().into_iter().find(|(name, _)| *name == "cornell-box.glb").unwrap();
    assert!(differences(&truth, &truth).is_empty());
    for wrong in [
        Truth { triangles: truth.triangles - 1, ..truth },
        Truth { area: truth.area * 1.01, ..truth },
        Truth { max: truth.max + DVec3::Y * 1e-3, ..truth },
        Truth { min: truth.min - DVec3::X * 1e-3, ..truth },
        Truth { degenerate: truth.degenerate + 38, ..truth },
    ] {
        assert!(!differences(&wrong, &truth).is_empty(), "{wrong:?}");
    }
}

/// Counts as the models' publishers state them, in the folder's `SOURCES.md`.
#[test]
fn counts_are_as_published() {
    let Some(folder) = scenes() else { return };
    for (name, triangles) in [
        ("sponza-crytek.glb", 262_267),
        ("sponza-dabrovic.glb", 66_450),
        ("bunny.glb", 69_666),
        ("dragon-100k.glb", 100_000),
        ("dragon-202k.glb", 202_520),
        ("khronos/Box.glb", 12),
        ("khronos/Duck.glb", 4_212),
        ("khronos/MeshPrimitiveModes.gltf", 16),
        ("khronos/NegativeScaleTest.glb", 7_724),
        ("khronos/OrientationTest.glb", 524),
        ("khronos/NormalTangentTest.glb", 7_774),
        ("khronos/NormalTangentMirrorTest.glb", 5_240),
        ("khronos/VertexColorTest.glb", 36),
        ("khronos/AlphaBlendModeTest.glb", 61),
        ("khronos/UnlitTest.glb", 88),
        ("khronos/EmissiveStrengthTest.glb", 90),
        ("khronos/LightsPunctualLamp.glb", 6_000),
        ("khronos/MetalRoughSpheresNoTextures.glb", 1_040_409),
        ("khronos/DamagedHelmet.glb", 15_452),
        ("khronos/FlightHelmet.glb", 94_722),
    ] {
        assert_eq!(load(&folder.join(name)).unwrap().triangles.len(), triangles, "{name}");
    }
    // `SOURCES.md` counts the triangles of each mesh once, and this file has one on several nodes.
    assert_eq!(load(&folder.join("khronos/TextureTransformTest.glb")).unwrap().triangles.len(), 24);
}

/// The outline, which reads no mesh, counts what loading does.
#[test]
fn outlines_count_the_same() {
    let Some(folder) = scenes() else { return };
    let mut seen = 0;
    for folder in [folder.clone(), folder.join("khronos")] {
        for (path, entry) in list(&folder).unwrap() {
            let (outline, scene) = (entry.unwrap().outline.unwrap(), load(&path).unwrap());
            assert_eq!(outline.triangles, scene.triangles.len() as u64, "{}", path.display());
            assert_eq!(outline.lights, scene.lights.len(), "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen >= 36);
}
