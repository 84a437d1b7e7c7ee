//! Light in grids that are turned: what follows in the pipeline sees the same scene.

use crate::turns::Turn;
use crate::voxelizer::run;
use std::path::Path;
use voxgi::frame::Image;
use voxgi::scene::{self, Scene};
use voxgi::session::Request;

fn cornell(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.glb"));
    scene::load(&path).expect("the scene")
}

type Knobs = Vec<(&'static str, String)>;

fn picture(pipeline: &str, shown: &str, scene: &Scene, part: &str, knobs: Knobs) -> Image {
    let sets = knobs.into_iter().map(|(knob, value)| (knob.to_owned(), value)).collect();
    let parts = vec![("grid".to_owned(), part.to_owned())];
    let request =
        Request { pipeline: pipeline.to_owned(), size: [64, 64], sets, parts, ..Request::default() };
    run(&request, shown, scene)
        .unwrap_or_else(|problems| panic!("{pipeline}: {:?}", problems.iter().collect::<Vec<_>>()))
}

/// All numbers but the fourth of each pixel.
fn numbers(image: &Image) -> impl Iterator<Item = f64> {
    image.data.chunks_exact(image.channels).flat_map(|pixel| pixel.iter().take(3)).map(|x| f64::from(*x))
}

/// Rays that walk through the grid, and through the lit volume, meet the cubes that are drawn from the list: directions go
/// one way into the grid, positions the other way out of it.
#[test]
fn walks_meet_what_is_drawn() {
    let scene = cornell("cornell-box");
    let shown = |pipeline, turn: &Turn| picture(pipeline, "color", &scene, "grid/turned", turn.knobs());
    let differing = |a: &[f64], b: &[f64]| {
        let pairs = a.iter().zip(b);
        pairs.filter(|(a, b)| (**a - **b).abs() > 0.01).count() as f64 / a.len() as f64
    };
    let sides = |image: &Image| numbers(image).step_by(3).collect::<Vec<_>>();
    // Whether anything is there.
    let mask = |image: &Image| {
        let numbers: Vec<f64> = numbers(image).collect();
        numbers.chunks_exact(3).map(|rgb| f64::from(rgb.iter().sum::<f64>() > 0.0)).collect::<Vec<_>>()
    };
    // Along one side only, so that the background shows.
    let turn = Turn { cover: [1.0, 0.5, 0.7], ..Turn::new(24, 30.0, 20.0, -50.0) };
    let other = Turn { pitch: 26.0, ..turn };
    let walked = shown("voxels", &turn);
    let [drawn, elsewhere] = [turn, other].map(|turn| shown("cubes", &turn));
    let lit = shown("volume", &turn);
    let off = [differing(&sides(&walked), &sides(&drawn)), differing(&mask(&lit), &mask(&drawn))];
    let control =
        [&sides as &dyn Fn(&Image) -> Vec<f64>, &mask].map(|of| differing(&of(&walked), &of(&elsewhere)));
    println!("{off:.4?} of the pixels differ; turned by 6° more {control:.4?}");
    assert!(off.iter().all(|off| *off < 0.02), "{off:?}");
    assert!(control[0] > 0.1 && control[1] > 0.03, "{control:?}");
}

/// Mean difference, relative to both means.
fn difference(a: &Image, b: &Image) -> f64 {
    let apart: f64 = numbers(a).zip(numbers(b)).map(|(a, b)| (a - b).abs()).sum();
    2.0 * apart / (numbers(a).sum::<f64>() + numbers(b).sum::<f64>())
}

/// The scene is as many voxels wide in all grids, or nearly.
const WIDE: i64 = 24;

/// Along the axes and shifted: by whole voxels, since coarse levels group others then, and by parts of one.
fn aligned(scene: &Scene, shown: &str) -> Vec<Image> {
    let shifts = [0.0, 0.5, 1.25, 2.5, 3.75];
    let image = |shift: f64| {
        let at = format!("{:?}", 0.5 + shift / WIDE as f64);
        let mut knobs =
            vec![("resolution", (WIDE / 3 * 5).to_string()), ("window", format!("{:?}", 5.0 / 3.0))];
        knobs.extend(["window_x", "window_y", "window_z"].map(|knob| (knob, at.clone())));
        picture("cones", shown, scene, "grid/window", knobs)
    };
    shifts.into_iter().map(image).collect()
}

/// Voxels and coarse levels that lie otherwise change pictures, in aligned grids too: by 0.09 to 0.23 of the mean (indirect
/// light), 0.25 to 0.86 (a small lamp seen by six wide cones). A grid that is turned gives a picture that is no farther
/// from the nearest of the aligned ones than they can be from each other.
#[test]
fn light_stays_as_it_is() {
    // A cube is so many times as long along axes that are turned by 30° about one of its own.
    let side = 0.75_f64.sqrt() + 0.5;
    let turn =
        |yaw, pitch, roll, sides: f64| Turn::new(3 + (WIDE as f64 * sides).round() as i64, yaw, pitch, roll);
    let turns = [
        turn(90.0, 0.0, 0.0, 1.0),
        turn(30.0, 0.0, 0.0, side),
        turn(0.0, 30.0, 0.0, side),
        turn(-130.0, 20.0, 65.0, 1.6),
    ];
    for (name, shown) in [("cornell-point", "indirect"), ("cornell-box", "emissive_light")] {
        let scene = cornell(name);
        let aligned = aligned(&scene, shown);
        let nearest = |image: &Image| {
            aligned.iter().map(|other| difference(image, other)).fold(f64::INFINITY, f64::min)
        };
        let pairs = aligned.iter().flat_map(|a| aligned.iter().map(|b| difference(a, b)));
        let bound = pairs.fold(0.0, f64::max);
        let off = |turn: &Turn| nearest(&picture("cones", shown, &scene, "grid/turned", turn.knobs()));
        let found = turns.map(|turn| off(&turn));
        let control = off(&Turn { cover: [0.5; 3], ..turn(30.0, 0.0, 0.0, side / 2.0) });
        println!("{name}, {shown}: {found:.3?} of {bound:.3}; without half of the scene {control:.3}");
        assert!(found.iter().all(|off| *off < bound), "{found:?} of {bound}");
        assert!(control > 1.5 * bound, "{control}");
    }
}
