//! Normal maps: domes that are painted on plates, beside domes that are there.

use super::models::Model;
use super::shot::Shot;
use glam::DVec2;
use serde_json::json;

/// Largest mean angle, in degrees, between the normals of a painted dome and those of the one beside it. A pair: where
/// the dome is, where the paintings of it are.
fn difference(model: &Model, pairs: &[(f64, &[f64])]) -> f64 {
    let shot = Shot::new(model, "normal", [0.0, -0.1], 1.5);
    let mut worst = 0.0f64;
    for y in [0.8, 0.4, 0.0, -0.4, -0.8] {
        for (dome, painted) in pairs {
            for x in *painted {
                let real = shot.square(DVec2::new(*dome, y), 0.06);
                let shown = shot.square(DVec2::new(*x, y), 0.06);
                let angle = |i: usize| real[i].1.angle_between(shown[i].1).to_degrees();
                let sum: f64 = (0..real.len()).map(angle).sum();
                worst = worst.max(sum / real.len() as f64);
            }
        }
    }
    worst
}

/// Of the test without tangents in the file.
const MADE: &[(f64, &[f64])] = &[(-0.96, &[-0.64]), (-0.16, &[0.16]), (0.64, &[0.96])];
/// Of the test with tangents and mirrored texture coordinates.
const GIVEN: &[(f64, &[f64])] = &[(-1.275, &[-0.955, -0.629, -0.291]), (0.3, &[0.62, 0.941, 1.264])];

/// Degrees. The maps are JPEG pictures of 512 texels for all domes.
const SAME: f64 = 4.0;
/// The mean slope of the domes is more than this.
const OTHER: f64 = 12.0;

fn with_scale(model: &Model, scale: f32) -> Model {
    model.edited(|document| document["materials"][0]["normalTexture"]["scale"] = json!(scale))
}

#[test]
fn normal_tangent_test() {
    let Some(model) = Model::read("NormalTangentTest") else { return };
    let found = difference(&model, MADE);
    println!("made tangents: {found}°");
    assert!(found < SAME, "{found}");
    for scale in [0.0, -1.0] {
        let wrong = difference(&with_scale(&model, scale), MADE);
        println!("scale {scale}: {wrong}°");
        assert!(wrong > OTHER, "{wrong}");
    }
}

#[test]
fn normal_tangent_mirror_test() {
    let Some(model) = Model::read("NormalTangentMirrorTest") else { return };
    let made = model.edited(|document| {
        let attributes = &mut document["meshes"][0]["primitives"][0]["attributes"];
        attributes.as_object_mut().expect("attributes").remove("TANGENT");
    });
    for (name, model) in [("given", &model), ("made", &made)] {
        let found = difference(model, GIVEN);
        println!("{name} tangents: {found}°");
        assert!(found < SAME, "{name}: {found}");
    }
    let wrong = difference(&with_scale(&model, -1.0), GIVEN);
    assert!(wrong > OTHER, "{wrong}");
}

/// A mirrored node shows the mirrored picture: domes and paintings change alike.
#[test]
fn mirrored_instances() {
    let Some(model) = Model::read("NormalTangentTest") else { return };
    let mirrored = model.edited(|document| document["nodes"][1]["scale"] = json!([-1, 1, 1]));
    let pairs: Vec<(f64, [f64; 1])> = MADE.iter().map(|(dome, painted)| (-dome, [-painted[0]])).collect();
    let pairs: Vec<(f64, &[f64])> = pairs.iter().map(|(dome, painted)| (*dome, &painted[..])).collect();
    let found = difference(&mirrored, &pairs);
    assert!(found < SAME, "{found}");
}

/// The tangents that are made are those that the file's own baker made.
#[test]
fn made_tangents_are_the_bakers() {
    let Some(model) = Model::read("NormalTangentMirrorTest") else { return };
    let made = model.edited(|document| {
        let attributes = &mut document["meshes"][0]["primitives"][0]["attributes"];
        attributes.as_object_mut().expect("attributes").remove("TANGENT");
    });
    let [given, made] = [model.load(), made.load()];
    assert_eq!(given.triangles.len(), made.triangles.len());
    let (mut same, mut count) = (0, 0);
    for (a, b) in given.triangles.iter().zip(&made.triangles) {
        for (i, k) in [(a.a, b.a), (a.b, b.b), (a.c, b.c)] {
            let [i, k] = [i as usize, k as usize];
            assert_eq!(given.vertices[i], made.vertices[k]);
            let [given, made] = [given.vertex_extras[i].tangent, made.vertex_extras[k].tangent];
            count += 1;
            same += usize::from(given.w == made.w && given.truncate().dot(made.truncate()) > 0.99);
        }
    }
    println!("{same} of {count} corners agree");
    assert!(same * 100 > count * 98, "{same} of {count}");
    assert!(made.vertices.len() < made.triangles.len() * 2, "vertices are welded again");
    let ways = |way: f32| made.vertex_extras.iter().filter(|extra| extra.tangent.w == way).count();
    assert!(ways(1.0) > 20 && ways(-1.0) > 20, "some are mirrored");
}
