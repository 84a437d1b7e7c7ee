//! What a scene does not call for is left out, and a feature that has no effect changes no bit of the picture.

use crate::bench::{Job, differences, gpu, root};
use serde_json::{Value, json};
use std::path::Path;
use voxgi::scene::{self, Scene};
use voxgi::schedule::Fate;

/// A scene of the repository with another JSON document.
fn edited(name: &str, edit: impl FnOnce(&mut Value)) -> Scene {
    let bytes = std::fs::read(root(&format!("scenes/{name}.glb"))).expect("the scene");
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    let mut document: Value = serde_json::from_slice(&bytes[20..20 + length]).expect("JSON");
    edit(&mut document);
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let binary = &bytes[20 + length..];
    let mut out = bytes[..8].to_vec();
    out.extend(((20 + json.len() + binary.len()) as u32).to_le_bytes());
    out.extend((json.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    out.extend(json);
    out.extend(binary);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("edited.glb");
    std::fs::write(&path, out).expect("a file");
    scene::load(&path).unwrap_or_else(|problems| panic!("{name}: {problems:?}"))
}

/// The Cornell box with more in its setting.
fn set(more: &str) -> Scene {
    let folder = tempfile::tempdir().expect("a folder");
    let from = root("scenes/cornell-box.glb");
    std::fs::copy(&from, folder.path().join("cornell-box.glb")).expect("a copy");
    let path = folder.path().join("set.ron");
    std::fs::write(&path, format!("Setting(gltf: \"cornell-box.glb\", {more})")).expect("a file");
    scene::load(Path::new(&path)).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn job<'a>(scene: &'a Scene) -> Job<'a> {
    Job::new(scene, "cones", [40, 40]).set("resolution", "32").set("light_map_size", "128")
}

/// The stages that are left out, without the numbers of their elements.
fn dropped(scene: &Scene) -> Vec<String> {
    let prepared = job(scene).prepare().expect("a graph");
    let fates = prepared.graph.stages.iter().zip(&prepared.schedule.fates);
    let dropped = fates.filter(|(_, fate)| matches!(fate, Fate::Dropped(_)));
    let mut names: Vec<String> =
        dropped.map(|(stage, _)| stage.path.split('[').next().unwrap_or_default().to_owned()).collect();
    names.dedup();
    names
}

const MOTION: [&str; 3] = ["payload/clear_sums_moving", "payload/clear_bits_moving", "voxelize/moving"];
const EMISSION: [&str; 3] = ["storage/emitted", "mipmap_emitted/two", "mipmap_emitted/last"];

#[test]
fn each_scene_drops_what_it_does_not_call_for() {
    let lights = ["light_maps/light_depth"];
    let of = |lists: &[&[&str]]| lists.concat().iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let point = edited("cornell-point", |_| {});
    let area = edited("cornell-box", |_| {});
    let both = set("lights: [Point(position: (0.3, 0.3, 0.3), intensity: (1, 1, 1))]");
    let moving = crate::bench::moving_scene();
    let dark = edited("cornell-box", |document| {
        for material in document["materials"].as_array_mut().expect("materials") {
            material.as_object_mut().expect("a material").remove("emissiveFactor");
        }
    });
    assert_eq!(dropped(&point), of(&[&MOTION, &EMISSION]));
    assert_eq!(dropped(&area), of(&[&lights, &MOTION]));
    assert_eq!(dropped(&both), of(&[&MOTION]));
    assert_eq!(dropped(&moving), of(&[]));
    assert_eq!(dropped(&dark), of(&[&lights, &MOTION, &EMISSION]));
}

/// Holds two scenes to the same picture, of which only the second has a feature; `there` says that it has.
fn no_effect(without: &Scene, with: &Scene, there: impl Fn(&Scene) -> bool) {
    assert!(!there(without) && there(with), "the feature makes the difference");
    let (a, b) = (job(without).outputs(gpu(), 1), job(with).outputs(gpu(), 1));
    let found = differences(&a, &b);
    assert!(found.is_empty(), "{found:?}");
}

#[test]
fn motion_that_goes_nowhere() {
    let with = set(r#"motion: [(node: "tall_block", keys: [(time: 0), (time: 1)])]"#);
    no_effect(&set(""), &with, |scene| scene.still_triangles < scene.triangles.len());
}

#[test]
fn a_light_that_shines_away() {
    let with = set(
        r#"lights: [Spot(position: (0, 9, 0), direction: (0, 1, 0), intensity: (9, 9, 9), inner_degrees: 1,
            outer_degrees: 20)]"#,
    );
    no_effect(&set(""), &with, |scene| !scene.lights.is_empty());
}

#[test]
fn masks_without_holes() {
    let with = edited("cornell-point", |document| {
        document["materials"][0]["alphaMode"] = json!("MASK");
    });
    no_effect(&edited("cornell-point", |_| {}), &with, |scene| {
        scene.materials.iter().any(|material| material.alpha_cutoff > 0.0)
    });
}

#[test]
fn emission_too_faint_to_be_stored() {
    let with = edited("cornell-point", |document| {
        document["materials"][0]["emissiveFactor"] = json!([1e-30, 0, 0]);
    });
    no_effect(&edited("cornell-point", |_| {}), &with, |scene| {
        scene.materials.iter().any(|material| material.emission.max_element() > 0.0)
    });
}

/// The control: a feature that has an effect shows.
#[test]
fn a_light_that_shines_in_shows() {
    let with = set("lights: [Point(position: (0.3, 0.3, 0.3), intensity: (0.1, 0.1, 0.1))]");
    assert!(!differences(&job(&set("")).outputs(gpu(), 1), &job(&with).outputs(gpu(), 1)).is_empty());
}
