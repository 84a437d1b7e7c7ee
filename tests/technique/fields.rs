//! What must hold exactly, whatever the scene: fields of one radiance, and twice the light.

use super::program::{color, pixels, render, shipped};
use super::scenes::Studio;
use std::path::Path;
use voxgi::picture::Picture;

/// Smallest and largest `indirect` over `albedo` when every voxel has the given radiance and opacity. `indirect` holds
/// the albedo as the G-buffer rounded it, and so does the output `albedo`: their quotient is what the cones gathered.
fn gathered(hemisphere: &str, radiance: f64, opacity: f64) -> [f64; 2] {
    let options = format!(
        "--part light=light/uniform --part hemisphere={hemisphere} --set field_radiance={radiance} \
         --set field_opacity={opacity} --set bounces=1 --set resolution=32"
    );
    let [indirect, albedo] =
        render(&shipped("scenes/cornell-point.glb"), "cones", &options, ["indirect", "albedo"]);
    let of = |pixel| color(&indirect, pixel) / color(&albedo, pixel);
    let quotients: Vec<_> = pixels().map(of).filter(|q| !q.is_nan()).collect();
    assert!(quotients.len() > 3600, "the box fills the picture");
    let least = quotients.iter().map(|q| q.min_element()).fold(f64::MAX, f64::min);
    let most = quotients.iter().map(|q| q.max_element()).fold(f64::MIN, f64::max);
    [least, most]
}

/// The weights of the cones sum to 1, and a cone that meets nothing but radiance 1 brings 1.
#[test]
fn a_field_of_radiance_1_lights_a_surface_to_its_albedo() {
    for hemisphere in HEMISPHERES {
        for radiance in [1.0, 2.0] {
            let [least, most] = gathered(hemisphere, radiance, 1.0);
            println!("{hemisphere}: radiance {radiance} gives {least} to {most} of the albedo");
            assert!((least - radiance).abs() < 1e-6 && (most - radiance).abs() < 1e-6, "{least} to {most}");
        }
    }
}

const HEMISPHERES: [&str; 2] = ["hemisphere/six", "hemisphere/spiral"];

/// Fog of radiance 1 never brings more than 1, however it is cut into steps and levels; and the less the thinner it is.
#[test]
fn fog_brings_less_the_thinner_it_is() {
    let [_, thick] = gathered("hemisphere/six", 1.0, 0.5);
    let [_, thin] = gathered("hemisphere/six", 1.0, 0.0625);
    println!("fog {thick} {thin}");
    assert!(thick <= 1.0 + 1e-6 && thin < thick);
}

/// `direct`, `indirect` at a resolution that is quick.
fn lit(scene: &Path) -> [Picture; 2] {
    render(scene, "cones", "--set resolution=32", ["direct", "indirect"])
}

/// Largest difference from `factor` times the picture, over the picture's brightest number.
fn difference(picture: &Picture, factor: f32, of: &Picture) -> f32 {
    let brightest = picture.data().iter().fold(0.0f32, |a, b| a.max(*b));
    let pairs = picture.data().chunks_exact(4).zip(of.data().chunks_exact(4));
    let channels = pairs.flat_map(|(a, b)| a[..3].iter().zip(&b[..3]));
    channels.fold(0.0, |most: f32, (a, b)| most.max((a - factor * b).abs() / brightest))
}

/// All of light transport is linear, and a factor of two changes no bit of a float but its exponent. (Only numbers
/// below 6e-5 in the volumes, which are half floats there, are rounded otherwise.)
#[test]
fn twice_the_light_gives_twice_the_picture() {
    let studio = Studio::new();
    let point = ["/extensions/KHR_lights_punctual/lights/0/intensity"];
    let lamp = ["/materials/3/extensions/KHR_materials_emissive_strength/emissiveStrength"];
    for (scene, [pointer]) in [("cornell-point", point), ("cornell-box", lamp)] {
        let brighter = |name: &str, factor: f64| {
            studio.edited(scene, name, |document| {
                let power = document.pointer_mut(pointer).expect("the light's power");
                *power = (f64::from(power.as_f64().expect("a number") as f32) * factor).into();
            })
        };
        let once = lit(&brighter("once", 1.0));
        let twice = lit(&brighter("twice", 2.0));
        let more = lit(&brighter("more", 2.02));
        for (output, i) in [("direct", 0), ("indirect", 1)] {
            let error = difference(&twice[i], 2.0, &once[i]);
            println!("{scene} {output}: twice the light is off by {error:e}");
            assert!(error < 1e-5, "{scene} {output}: {error}");
            assert!(
                difference(&more[i], 2.0, &once[i]) > 1e-3,
                "1 % more light is told from twice the light"
            );
        }
    }
}
