//! What payloads make of many fragments in a voxel: sheets of all colours in one layer of voxels.

use crate::lattice::Lattice;
use crate::model::{Model, Part};
use crate::oracle::{HALF, Rule, VOXEL};
use crate::voxelizer::{METHODS, Method, Way, picture};
use fastrand::Rng;

const SHEETS: usize = 100;
const SIDE: i64 = 16;

/// Sheets across the grid, in the same layer of voxels, each of its own colour in bytes.
fn sheets() -> (Lattice, Vec<Part>, Vec<[u8; 3]>) {
    let mut rng = Rng::with_seed(3);
    let lattice = Lattice::cube(SIDE);
    let (low, high) = (3 * VOXEL + HALF, 12 * VOXEL + HALF);
    let mut parts = vec![lattice.part(&lattice.fixed(&[]))];
    let mut colors = Vec::new();
    for i in 0..SHEETS as i64 {
        let y = 8 * VOXEL + HALF / 4 + 16 * i;
        let at = |x: i64, z: i64| [x, y, z];
        let quad =
            [[at(low, low), at(low, high), at(high, high)], [at(low, low), at(high, high), at(high, low)]];
        let color = [rng.u8(..), rng.u8(..), rng.u8(..)];
        parts.push(Part { color: color.map(|byte| f32::from(byte) / 255.0), ..lattice.part(&quad) });
        colors.push(color);
    }
    (lattice, parts, colors)
}

fn luminance(color: [u8; 3]) -> f64 {
    let [r, g, b] = color.map(f64::from);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Albedo, in bytes, of the voxels that all sheets fill once.
fn albedos(payload: &'static str, method: Method) -> Vec<[f64; 3]> {
    let (lattice, parts, _) = sheets();
    let scene = lattice.loaded(&Model { parts, ..Model::default() });
    let way = Way { method, payload, rule: Rule::Thin };
    let image = picture("surfels", "surfels", &scene, &lattice.grid, &way);
    let texel = |x: i64, z: i64| {
        let first = 4 * (((z * SIDE + 8) * SIDE) + x) as usize;
        [0, 1, 2].map(|i| f64::from(image.data[first + i]) * 255.0)
    };
    // Off the diagonal, where each sheet's two triangles meet.
    (4..12)
        .flat_map(|x| (4..12).filter(move |z| *z != x).map(move |z| (x, z)))
        .map(|(x, z)| texel(x, z))
        .collect()
}

fn largest_difference(found: &[[f64; 3]], right: [f64; 3]) -> f64 {
    found.iter().flatten().zip(right.iter().cycle()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn sums_are_means() {
    let (_, _, colors) = sheets();
    let mean = [0, 1, 2].map(|i| colors.iter().map(|c| f64::from(c[i])).sum::<f64>() / SHEETS as f64);
    for method in METHODS {
        let off = largest_difference(&albedos("payload/sums", method), mean);
        assert!(off < 255.0 / 65536.0, "{}: {off}", method);
    }
}

/// Rounded at each step, in any order.
#[test]
fn running_averages_are_close_to_means() {
    let (_, _, colors) = sheets();
    let mean = [0, 1, 2].map(|i| colors.iter().map(|c| f64::from(c[i])).sum::<f64>() / SHEETS as f64);
    for method in METHODS {
        let found = albedos("payload/average", method);
        let off = largest_difference(&found, mean);
        let bias = found.iter().flatten().zip(mean.iter().cycle()).map(|(a, b)| a - b).sum::<f64>()
            / (3 * found.len()) as f64;
        println!("{}: off by {off:.2}, in the mean {bias:.3} of 255", method);
        // What is nearer to the average than half its count is lost, to both sides alike; cut, the mean of so many would
        // be too dark by 25 of 255.
        assert!(off < 8.0 && bias.abs() < 5.0, "{off} {bias}");
        assert!(off > 0.001, "bytes can't hold the mean");
    }
}

#[test]
fn the_brightest_fragment_wins() {
    let (_, _, colors) = sheets();
    let brightest = colors.iter().copied().max_by(|a, b| luminance(*a).total_cmp(&luminance(*b)));
    let right = brightest.expect("a colour").map(f64::from);
    for method in METHODS {
        let off = largest_difference(&albedos("payload/maximum", method), right);
        assert!(off < 0.01, "{}: {off}", method);
    }
    let darkest = colors.iter().copied().min_by(|a, b| luminance(*a).total_cmp(&luminance(*b)));
    let wrong = largest_difference(
        &albedos("payload/maximum", METHODS[0]),
        darkest.expect("a colour").map(f64::from),
    );
    assert!(wrong > 50.0, "the control: {wrong}");
}
