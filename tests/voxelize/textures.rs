//! A textured square: the means over its voxels against the areas' own.

use crate::lattice::Lattice;
use crate::model::{Model, Part};
use crate::oracle::{Point, Rule, VOXEL, number};
use crate::sums::Sums;
use crate::voxelizer::METHODS;
use fastrand::Rng;
use glam::DVec3;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use serde_json::json;

/// An image of random sRGB texels, row 0 on top.
struct Texture {
    side: usize,
    texels: Vec<[u8; 3]>,
}

impl Texture {
    fn random(side: usize, seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        Self { side, texels: (0..side * side).map(|_| [(); 3].map(|()| rng.u8(..))).collect() }
    }

    fn png(&self) -> Vec<u8> {
        let mut file = Vec::new();
        let side = self.side as u32;
        let content: Vec<u8> = self.texels.iter().flatten().copied().collect();
        let written = PngEncoder::new(&mut file).write_image(&content, side, side, ExtendedColorType::Rgb8);
        written.expect("a picture");
        file
    }

    /// Linear; beyond the edge its last texels.
    fn texel(&self, x: i64, y: i64) -> DVec3 {
        let [x, y] = [x, y].map(|i| i.clamp(0, self.side as i64 - 1) as usize);
        DVec3::from_array(self.texels[y * self.side + x].map(|code| {
            let c = f64::from(code) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        }))
    }

    fn bilinear(&self, u: f64, v: f64) -> DVec3 {
        let [x, y] = [u, v].map(|t| t * self.side as f64 - 0.5);
        let (i, j) = (x.floor() as i64, y.floor() as i64);
        let row = |j| self.texel(i, j).lerp(self.texel(i + 1, j), x - x.floor());
        row(j).lerp(row(j + 1), y - y.floor())
    }

    /// As voxels should see it: where texels are smaller than they, as texels, else smooth.
    fn seen(&self, u: f64, v: f64) -> DVec3 {
        if self.side <= 64 {
            return self.bilinear(u, v);
        }
        let [x, y] = [u, v].map(|t| (t * self.side as f64) as i64);
        self.texel(x, y)
    }

    /// Of the whole square: bilinear weights of each texel make up its area, at the clamped edge too.
    fn mean(&self) -> DVec3 {
        let side = self.side as i64;
        (0..side * side).map(|i| self.texel(i % side, i / side)).sum::<DVec3>() / (side * side) as f64
    }
}

/// A square in the grid, in units: a corner, and the sides along which u and v go from 0 to 1.
struct Square {
    corner: Point,
    u: Point,
    v: Point,
}

/// By voxel: the area's mean colour, and how much of the square, in voxels², lies in it.
fn areas(square: &Square, texture: &Texture, size: Point) -> Vec<(DVec3, f64)> {
    const SAMPLES: i64 = 1024;
    let mut sums = vec![(DVec3::ZERO, 0.0); size.into_iter().product::<i64>() as usize];
    let [corner, u, v] =
        [square.corner, square.u, square.v].map(|p| DVec3::from_array(p.map(|x| x as f64 / VOXEL as f64)));
    let area = u.cross(v).length() / (SAMPLES * SAMPLES) as f64;
    for i in 0..SAMPLES * SAMPLES {
        let [s, t] = [i % SAMPLES, i / SAMPLES].map(|k| (k as f64 + 0.5) / SAMPLES as f64);
        let voxel = (corner + s * u + t * v).floor().to_array().map(|x| x as i64);
        let sum = &mut sums[number(voxel, size)];
        sum.0 += area * texture.seen(s, t);
        sum.1 += area;
    }
    sums.into_iter().map(|(sum, area)| (sum / area, area)).collect()
}

/// How far sums are from what the areas are: of the mean over all fragments, and of voxels that at least a third of a
/// voxel's face lies in, the greatest.
fn errors(sums: &Sums, areas: &[(DVec3, f64)], mean: DVec3, size: Point) -> (f64, f64) {
    let (mut sum, mut weights, mut worst) = (DVec3::ZERO, 0.0, 0.0_f64);
    for voxel in sums.filled() {
        let (area_mean, area) = areas[number(voxel, size)];
        let (found, weight) = (sums.means(voxel).albedo, f64::from(sums.voxel(voxel)[0]));
        // The triangles that fix the grid lie elsewhere.
        if area > 0.0 {
            (sum, weights) = (sum + weight * found, weights + weight);
        }
        if area > 1.0 / 3.0 {
            worst = worst.max((found - area_mean).abs().max_element());
        }
    }
    ((sum / weights - mean).abs().max_element(), worst)
}

/// Texels of four voxels, and texels of a quarter of one, so that the fourth's mean is asked for; a square along the
/// axes, each voxel filled to its edges, and one turned by no simple angle.
#[test]
fn means_of_a_textured_square_are_those_of_its_areas() {
    let lattice = Lattice::cube(68);
    let size = lattice.grid.size;
    let full = 64 * VOXEL - 2;
    let straight =
        Square { corner: [2 * VOXEL + 1, 2 * VOXEL + 1, 30 * VOXEL + 901], u: [full, 0, 0], v: [0, full, 0] };
    // 42 voxels along each side; normal (-2, 3, 6) / 7.
    let turned = Square {
        corner: [6 * VOXEL + 1, 18 * VOXEL + 1, 24 * VOXEL + 1],
        u: [36 * VOXEL, -12 * VOXEL, 18 * VOXEL],
        v: [18 * VOXEL, 36 * VOXEL, -12 * VOXEL],
    };
    // Errors of the mean over all fragments, and of a voxel's. The straight square's texels are bent only where voxels meet,
    // or small enough for mip levels as wide as voxels. In voxels of the turned one, images are looked up at one point of
    // each triangle; random texels are the worst that can be there.
    for (name, square, side, mean_error, voxel_error) in [
        ("straight, coarse", &straight, 16, 0.1 / 255.0, 0.5 / 255.0),
        ("straight, fine", &straight, 256, 0.1 / 255.0, 1.0 / 255.0),
        ("turned", &turned, 12, 0.1 / 255.0, 15.0 / 255.0),
    ] {
        let texture = Texture::random(side, 14);
        let Square { corner, u, v } = square;
        let at = |s: i64, t: i64| [0, 1, 2].map(|i| corner[i] + s * u[i] + t * v[i]);
        let uvs = [(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)];
        let corners = uvs.iter().map(|(s, t)| lattice.metres(at(*s, *t))).collect();
        let quad =
            Part { uvs: uvs.iter().map(|(s, t)| [*s as f32, *t as f32]).collect(), ..Part::new(corners) };
        let clamped = json!({ "wrapS": 33071, "wrapT": 33071 });
        let parts = vec![lattice.part(&lattice.fixed(&[])), quad];
        let scene = lattice.loaded(&Model { parts, image: Some((texture.png(), clamped)), motion: None });
        let areas_of = |texture| areas(square, texture, size);
        let (expected, wrong) = (areas_of(&texture), areas_of(&Texture::random(side, 15)));
        for rule in Rule::BOTH {
            for method in METHODS {
                let sums = Sums::of(&scene, &lattice.grid, method, rule);
                let (of_all, of_voxel) = errors(&sums, &expected, texture.mean(), size);
                println!(
                    "{name}, {rule:?}, {method}: mean {:.2}/255, voxel {:.2}/255",
                    255.0 * of_all,
                    255.0 * of_voxel
                );
                assert!(of_all < mean_error, "{name}, {rule:?}, {method}: {of_all}");
                assert!(of_voxel < voxel_error, "{name}, {rule:?}, {method}: {of_voxel}");
                // The control: another texture.
                assert!(errors(&sums, &wrong, texture.mean(), size).1 > 0.3);
            }
        }
    }
}
