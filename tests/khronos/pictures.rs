//! Models that show check marks where they are drawn right.

use super::models::Model;
use super::shot::{Shot, mean, part};
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

type Verdict = Result<(), String>;

fn ensure(right: bool, what: impl FnOnce() -> String) -> Verdict {
    if right { Ok(()) } else { Err(what()) }
}

fn is_dark(color: DVec3) -> bool {
    color.max_element() < 0.03
}

/// Above, squares of green, blue and cyan with check marks, instead of one red with a cross; below, arrows that point
/// at a green marker, the node "… - Correct".
fn transforms(model: &Model) -> Verdict {
    let shot = Shot::new(model, "albedo", [0.0, 0.0], 1.8);
    let bright = 0.527;
    for (x, color) in [(-1.1, [0.0, bright, 0.0]), (0.0, [0.0, 0.0, bright]), (1.1, [0.0, bright, bright])] {
        let seen = shot.square(DVec2::new(x, 0.55), 0.45);
        let share = part(&seen, |c| (c - DVec3::from(color)).length() < 0.05);
        ensure(share > 0.7, || format!("{share} of the square at {x} is {color:?}"))?;
    }
    for (x, marker) in [(-1.1, [-0.079, -0.516]), (0.0, [0.0185, -0.0185]), (1.1, [-0.07, -0.25])] {
        let seen = shot.square(DVec2::new(x, -0.55), 0.48);
        let dark = seen.iter().filter(|(_, color)| is_dark(*color)).map(|(point, _)| *point);
        // Arrows begin near the upper left corner.
        let far = |point: &DVec2| point.distance_squared(DVec2::new(-0.5, 0.5));
        let tip = dark.max_by(|a, b| far(a).total_cmp(&far(b))).ok_or("no arrow")?;
        let distance = tip.distance(marker.into());
        ensure(distance < 0.2, || format!("the arrow at {x} ends {distance} from the marker"))?;
    }
    Ok(())
}

fn each_transform(document: &mut Value, edit: impl Fn(&mut Value)) {
    for material in document["materials"].as_array_mut().expect("materials") {
        if let Some(info) = material.pointer_mut("/pbrMetallicRoughness/baseColorTexture/extensions") {
            edit(&mut info["KHR_texture_transform"]);
        }
    }
}

#[test]
fn texture_transform_test() {
    let Some(model) = Model::read("TextureTransformTest") else { return };
    assert_eq!(transforms(&model), Ok(()));
    let ignored = model.edited(|document| each_transform(document, |transform| *transform = json!({})));
    assert!(transforms(&ignored).is_err());
    let turn = |transform: &mut Value| {
        if let Some(angle) = transform["rotation"].as_f64() {
            transform["rotation"] = json!(-angle);
        }
    };
    let turned = transforms(&model.edited(|document| each_transform(document, turn)));
    assert!(turned.is_err_and(|why| why.contains("arrow")), "the other way round");
}

/// Every square has its chequers in the corner that its label names.
fn coordinates(model: &Model) -> Verdict {
    let shot = Shot::new(model, "albedo", [0.0, 0.0], 1.3);
    let signs = [-1.0, 1.0].into_iter().flat_map(|x| [-1.0, 1.0].map(|y| DVec2::new(x, y)));
    for outwards in signs {
        let dark = |towards: DVec2| {
            let corner = shot.square(outwards * 0.7 + towards * 0.39, 0.08);
            part(&corner, |color| color.max_element() < 0.1)
        };
        let flipped = [DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0)].map(|flip| dark(outwards * flip));
        let (own, most) = (dark(outwards), flipped[0].max(flipped[1]));
        ensure(own > 0.2 && most < 0.05, || format!("at {outwards}: {own} in its corner, {most} beside"))?;
    }
    Ok(())
}

#[test]
fn texture_coordinate_test() {
    let Some(model) = Model::read("TextureCoordinateTest") else { return };
    assert_eq!(coordinates(&model), Ok(()));
    // Each shows what belongs to its neighbour.
    for offset in [[0.0, 0.6], [0.6, 0.0]] {
        let moved = model.edited(|document| {
            for material in document["materials"].as_array_mut().expect("materials") {
                let texture = material.pointer_mut("/pbrMetallicRoughness/baseColorTexture");
                if let Some(texture) = texture {
                    texture["extensions"] = json!({"KHR_texture_transform": {"offset": offset}});
                }
            }
        });
        assert!(coordinates(&moved).is_err(), "{offset:?}");
    }
}

/// Check marks that get their colours from the vertices look like those below, whose texture has them.
fn vertex_colors(model: &Model) -> Verdict {
    let shot = Shot::new(model, "albedo", [0.0, 0.0], 1.1);
    for (channel, x) in [-0.548, 0.0, 0.592].into_iter().enumerate() {
        let [above, below] = [0.34, -0.528].map(|y| mean(&shot.square(DVec2::new(x, y), 0.22)));
        ensure((above - below).abs().max_element() < 0.02, || format!("{above} above {below} at {x}"))?;
        let other = (0..3).filter(|i| *i != channel).map(|i| above[i]).fold(0.0, f64::max);
        let pure = above[channel] > 0.05 && other < 0.01;
        ensure(pure, || format!("{above} at {x} has other colours"))?;
    }
    Ok(())
}

#[test]
fn vertex_color_test() {
    let Some(model) = Model::read("VertexColorTest") else { return };
    assert_eq!(vertex_colors(&model), Ok(()));
    let without = model.edited(|document| {
        let attributes = &mut document["meshes"][1]["primitives"][0]["attributes"];
        attributes.as_object_mut().expect("attributes").remove("COLOR_0");
    });
    assert!(vertex_colors(&without).is_err());
}
