//! Many triangles in one voxel: their number, and the means of what is known of them.

use crate::lattice::Lattice;
use crate::model::{Model, Part};
use crate::oracle::{self, Point, Rule, Ties, Triangle, VOXEL};
use crate::pieces::Piece;
use crate::random::Region;
use crate::sums::Sums;
use crate::voxelizer::{COUNT, METHODS, Way, counted};
use fastrand::Rng;
use glam::DVec3;

const CROWDED: Point = [7, 6, 8];
/// Weights of still triangles, or of moving ones, at which a sum is full.
const MOST_WEIGHT: u32 = 1 << 30;

fn lattice() -> Lattice {
    Lattice::cube(16)
}

/// The inside of the voxel: of odd units, so that nothing is snapped.
fn region() -> Region {
    Region { low: CROWDED.map(|i| i * VOXEL + 1), high: CROWDED.map(|i| (i + 1) * VOXEL - 1) }
}

/// The part with the fixing triangles, and one part for each crowd.
fn model(lattice: &Lattice, crowds: &[(&[Triangle], [f32; 3])]) -> Model {
    let part =
        |(triangles, color): &(&[Triangle], [f32; 3])| Part { color: *color, ..lattice.part(triangles) };
    let parts = std::iter::once(lattice.part(&lattice.fixed(&[]))).chain(crowds.iter().map(part)).collect();
    Model { parts, ..Model::default() }
}

/// Sums over fragments with their weights: weights, colours, normals and positions within the voxel.
fn expected(crowds: &[(Vec<Triangle>, [f32; 3])]) -> (f64, [DVec3; 3]) {
    let mut sums = (0.0, [DVec3::ZERO; 3]);
    for (triangles, color) in crowds {
        for triangle in triangles {
            let [a, b, c] = triangle.map(|corner| DVec3::from_array(corner.map(|x| x as f64)));
            let piece = Piece::of(triangle, CROWDED);
            let weight = piece.weight();
            sums.0 += weight;
            let terms =
                [DVec3::from_array(color.map(f64::from)), (b - a).cross(c - a).normalize(), piece.middle];
            sums.1.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * term);
        }
    }
    sums
}

/// Ten thousand triangles of two colours: every one counts by its area, to the rounding of the terms.
#[test]
fn ten_thousand_triangles_in_one_voxel() {
    let lattice = lattice();
    let mut rng = Rng::with_seed(10);
    // To one side of the middle, so that the means say which points were taken.
    let [low, high] = [region().low, region().low.map(|x| x + 2 * (VOXEL / 3))];
    let mut triangles = Region { low, high }.triangles(&mut rng, 30_000, high[0] - low[0], 2);
    // Of slivers single floats know the normal less well.
    triangles.retain(|t| {
        let [a, b, c] = t.map(|corner| DVec3::from_array(corner.map(|x| x as f64)));
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        (b - a).cross(c - a).length() > 0.2 * longest * longest
    });
    triangles.truncate(10_000);
    assert_eq!(triangles.len(), 10_000);
    let colors = [[0.8, 0.1, 0.2], [0.25, 0.5, 0.123]];
    let (some, others) = triangles.split_at(4_000);
    let scene = lattice.loaded(&model(&lattice, &[(some, colors[0]), (others, colors[1])]));
    for rule in Rule::BOTH {
        let meets =
            |t: &&Triangle| oracle::voxels(t, lattice.grid.size, VOXEL, rule, Ties::Count).count() == 1;
        let of = |all: &[Triangle]| all.iter().filter(meets).copied().collect::<Vec<_>>();
        let crowds = [(of(some), colors[0]), (of(others), colors[1])];
        let count = (crowds[0].0.len() + crowds[1].0.len()) as u32;
        assert!(rule == Rule::Thin || count == 10_000);
        let (weights, sums) = expected(&crowds);
        for method in METHODS {
            let way = Way { method, payload: COUNT, rule };
            let at = oracle::number(CROWDED, lattice.grid.size);
            assert_eq!(counted(&scene, &lattice.grid, &way)[at], count, "{method}, {rule:?}");
            let found = Sums::of(&scene, &lattice.grid, method, rule);
            assert!((f64::from(found.voxel(CROWDED)[0]) / weights - 1.0).abs() < 1e-5);
            let found = found.means(CROWDED);
            let errors = [found.albedo, found.normal, found.within];
            let errors: Vec<f64> =
                errors.iter().zip(sums).map(|(e, sum)| (*e - sum / weights).abs().max_element()).collect();
            println!("{method}, {rule:?}: {count} fragments, errors of colour, normal, position {errors:?}");
            assert!(errors.iter().all(|error| *error < 1e-5), "{errors:?}");
        }
    }
    // The control: equal weights are other ones.
    let (weights, sums) = expected(&[(some.to_vec(), colors[0]), (others.to_vec(), colors[1])]);
    let even = (4_000.0 * f64::from(colors[0][0]) + 6_000.0 * f64::from(colors[1][0])) / 10_000.0;
    assert!((sums[0].x / weights - even).abs() > 1e-4);
}

/// More than a sum takes: the rest is left out, and no word overflows; what moves has a sum of its own.
#[test]
fn sums_are_full_before_they_overflow() {
    let lattice = lattice();
    let region = region();
    let ([x, y, z], [far, ..]) = (region.low, region.high);
    // Reaches over the voxel's middle, its normal along -x; of its area the weight is a whole, even number.
    let triangle = [[x + 2048, y, z], [x + 2048, y, z + 4000], [x + 2048, y + 4000, z]];
    assert!(triangle.iter().flatten().all(|unit| unit % 2 == 1) && far > x + 2048);
    let weight = Piece::of(&triangle, CROWDED).weight() as u32;
    assert_eq!(weight, 31_250);
    let crowd = vec![triangle; 40_000];
    let one = model(&lattice, &[(&crowd, [1.0; 3])]);
    let mut two = model(&lattice, &[(&crowd, [1.0; 3]), (&crowd, [1.0; 3])]);
    two.motion =
        Some("(node: \"part2\", keys: [(time: 0), (time: 1, offset: (0.01, 0, 0)), (time: 2)])".to_owned());
    for (model, sums, moving) in [(one, 1, 0), (two, 2, 40_000)] {
        let scene = lattice.loaded(&model);
        assert_eq!(scene.triangles.len() - scene.still_triangles, moving);
        let full = sums * MOST_WEIGHT.next_multiple_of(weight);
        for method in METHODS {
            let words = Sums::of(&scene, &lattice.grid, method, Rule::Conservative).voxel(CROWDED);
            // Threads that begin at the same time as the last one still add.
            assert!((full..full + sums * 1000 * weight).contains(&words[0]), "{method}: {words:?}");
            assert!(
                words[0].is_multiple_of(weight) && words[0] < sums * 40_000 * weight,
                "{method}: {words:?}"
            );
            assert_eq!(words[1..4], [words[0]; 3], "{method}");
            let normal = [words[4], words[5], words[6]].map(u32::cast_signed);
            assert_eq!(normal, [-(words[0] / 2).cast_signed(), 0, 0], "{method}");
        }
    }
}
