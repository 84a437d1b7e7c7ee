//! Pictures of a model from far in front of it, so that depth does not shift anything.

use super::models::Model;
use glam::{DVec2, DVec3};
use std::process::Command;
use voxgi::picture::{Picture, read_exr};

const SIZE: u32 = 512;
const DISTANCE: f64 = 1000.0;

/// One output of a pipeline, as seen from +z, y upwards.
pub struct Shot {
    picture: Picture,
    center: DVec2,
    reach: f64,
}

impl Shot {
    /// What lies within `reach` metres of `center` along x and y.
    pub fn new(model: &Model, output: &str, center: [f64; 2], reach: f64) -> Self {
        let (folder, _) = model.write();
        let degrees = 2.0 * (reach / DISTANCE).atan().to_degrees();
        let [x, y] = center;
        let setting = format!(
            "Setting(gltf: \"model.glb\", cameras: [(name: \"front\", eye: ({x}, {y}, {DISTANCE}), \
             look_at: ({x}, {y}, 0), fov_degrees: {degrees})])"
        );
        let path = folder.path().join("front.ron");
        std::fs::write(&path, setting).expect("the setting can be written");
        let target = folder.path().join("picture.exr");
        let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
        command.arg("render").arg(&path).args(["-p", "cones", "--size", &format!("{SIZE}x{SIZE}")]);
        command.arg("--output").arg(format!("{output}={}", target.display()));
        let run = command.output().expect("the program starts");
        assert!(run.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&run.stderr));
        let mut layers = read_exr(&target).expect("the picture can be read");
        let picture = layers.pop().expect("a picture has a layer").1;
        Self { picture, center: center.into(), reach }
    }

    /// The first three numbers of the pixel that shows the point (x, y, 0).
    pub fn at(&self, point: DVec2) -> DVec3 {
        let place = (point - self.center) / self.reach * DVec2::new(0.5, -0.5) + 0.5;
        let [x, y] = (place * f64::from(SIZE)).to_array().map(|c| c.floor() as u32);
        let texel = self.picture.texel(x, y).expect("the point lies in the picture");
        DVec3::new(texel[0].into(), texel[1].into(), texel[2].into())
    }

    /// A square's points on a grid, with what is seen there.
    pub fn square(&self, center: DVec2, half: f64) -> Vec<(DVec2, DVec3)> {
        const COUNT: u32 = 80;
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(COUNT) * 2.0 - 1.0;
        let points = (0..COUNT * COUNT).map(|i| DVec2::new(place(i % COUNT), place(i / COUNT)) * half);
        points.map(|offset| (offset, self.at(center + offset))).collect()
    }
}

pub fn mean(seen: &[(DVec2, DVec3)]) -> DVec3 {
    seen.iter().map(|(_, color)| *color).sum::<DVec3>() / seen.len() as f64
}

/// The part of what is seen for which `is` holds.
pub fn part(seen: &[(DVec2, DVec3)], is: impl Fn(DVec3) -> bool) -> f64 {
    seen.iter().filter(|(_, color)| is(*color)).count() as f64 / seen.len() as f64
}
