//! The table of `cargo bench --bench voxelizers`, from times that are made up.

#[path = "../benches/voxelizers/fit.rs"]
mod fit;
#[path = "../benches/voxelizers/rows.rs"]
mod rows;
#[path = "../benches/voxelizers/table.rs"]
mod table;

use fit::exponent;
use rows::{Cell, Row};

fn cell(method: &str, samples: &[f64], stages: &[(&str, f64)]) -> Cell {
    let stages = stages.iter().map(|(path, ms)| ((*path).to_owned(), vec![*ms]));
    Cell {
        method: method.to_owned(),
        cutoff: None,
        first_use_ms: 1000.0,
        samples_ms: samples.to_vec(),
        stages_ms: stages.collect(),
    }
}

fn row(scene: &str, triangles: usize, resolution: u32, cells: Vec<Cell>) -> Row {
    Row {
        scene: scene.to_owned(),
        triangles,
        resolution,
        separability: 6,
        filled: 1_234_567,
        differ: Vec::new(),
        cells,
    }
}

fn sample() -> Row {
    let passes = [("payload/clear", 5.0), ("voxelize/small_still", 1.0), ("voxelize/large_still", 3.0)];
    let cells = vec![
        cell("triangles", &[10.0, 20.0, 40.0], &[]),
        cell("fragments", &[300.0], &[]),
        cell("hybrid", &[8.0, 10.0, 16.0], &passes),
    ];
    row("ball", 1000, 128, cells)
}

#[test]
fn rows_name_what_was_measured() {
    // The ratios are of rounds: 8/10, 10/20 and 16/40, not 10/20 of the medians.
    let expected = "\
| scene (triangles) | grid | filled | triangles | fragments | hybrid | hybrid / better parent | hybrid: large | rounds |
| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| ball (1,000) | 128³ | 1,234,567 | 20.0 ± 15.0 | 300 | **10.0 ± 4.0** | 0.50 (0.40–0.80) | 75.0 % | 3; fragments: one sample |
";
    assert_eq!(table::table(&[&sample()]), expected);
    assert_eq!(table::table(&[]), "");
}

#[test]
fn methods_that_fill_other_voxels_are_named() {
    let mut other = sample();
    other.differ = vec!["hybrid".to_owned()];
    assert!(table::table(&[&other]).contains("| 1,234,567 (hybrid differ) |"));
    // Without both parents, none is the better one.
    other.cells.remove(0);
    assert!(!table::table(&[&other]).contains("parent"));
}

/// Times that grow as triangles^0.75 · resolution^1.5, but for one scene of a single triangle that takes as long as it
/// likes.
#[test]
fn fits_find_the_exponents_that_times_have() {
    let mut rows = Vec::new();
    for (scene, triangles) in [("single", 1), ("a", 1000), ("b", 20_000), ("c", 3_000_000)] {
        for resolution in [128_u32, 256, 512] {
            let work = if triangles == 1 { 777.0 } else { (triangles as f64).powf(0.75) };
            let ms = work * f64::from(resolution).powf(1.5);
            rows.push(row(scene, triangles, resolution, vec![cell("triangles", &[ms], &[])]));
        }
    }
    let text = table::fits(&rows.iter().collect::<Vec<_>>());
    let last = text.lines().last().expect("a line");
    assert_eq!(last, "| triangles | 0.75 ± 0.00 | 0.75 ± 0.00 | 0.75 ± 0.00 | 1.50 ± 0.00 |");
}

#[test]
fn fits_need_more_points_than_they_have_unknowns() {
    let line = |count: u32| vec![(1..=count).map(|x| (f64::from(x), f64::from(x * x))).collect()];
    assert_eq!([0, 1, 2].map(|count| exponent(&line(count))), [None; 3]);
    assert!(exponent(&line(3)).is_some_and(|slope| (slope.exponent - 2.0).abs() < 1e-12));
    assert_eq!(exponent(&[vec![(2.0, 1.0), (2.0, 3.0), (2.0, 4.0)]]), None);
}

/// Of exponents with noise on the logarithms, 95 of 100 intervals hold the true one.
#[test]
fn intervals_of_exponents_hold_the_true_one() {
    let mut random = fastrand::Rng::with_seed(3);
    let mut noise = || 0.3 * ((0..12).map(|_| random.f64()).sum::<f64>() - 6.0);
    for (groups, points, runs) in [(1, 5, 2000), (8, 3, 2000)] {
        let mut missed = 0;
        for _ in 0..runs {
            let data: Vec<Vec<(f64, f64)>> = (0..groups)
                .map(|group| {
                    let mut point = |x: f64| (x.exp(), (0.7 * x + f64::from(group) + noise()).exp());
                    (0..points).map(|x| point(f64::from(x))).collect()
                })
                .collect();
            let slope = exponent(&data).expect("a slope");
            missed += u32::from((slope.exponent - 0.7).abs() > slope.half);
        }
        // 100 of 2000, and four standard deviations to each side.
        assert!((61..=139).contains(&missed), "{missed} of {runs} with {groups} groups of {points}");
    }
}
