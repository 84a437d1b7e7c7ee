//! Many triangles in one voxel: their number, and the means of what is known of them.

use crate::lattice::Lattice;
use crate::model::{Model, Part};
use crate::oracle::{self, Point, Rule, Ties, Triangle, VOXEL};
use crate::random::Region;
use crate::sums::{Sums, WORDS};
use crate::voxelizer::{METHODS, Way, counted};
use fastrand::Rng;
use glam::DVec3;

const CROWDED: Point = [7, 6, 8];
/// Fragments of still triangles, or of moving ones, that are summed.
const MOST_TERMS: u32 = 32767;

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

/// The triangle's point that is nearest to `p`; all in voxels. By trying all its features: face, edges, corners.
fn nearest(t: [DVec3; 3], p: DVec3) -> DVec3 {
    let n = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
    let foot = p - n * n.dot(p - t[0]);
    let inside = (0..3).all(|i| n.dot((t[(i + 1) % 3] - t[i]).cross(foot - t[i])) >= 0.0);
    let along = |i: usize| {
        let (a, edge) = (t[i], t[(i + 1) % 3] - t[i]);
        a + edge * (edge.dot(p - a) / edge.length_squared()).clamp(0.0, 1.0)
    };
    let of_edges = (0..3).map(along).min_by(|a, b| a.distance(p).total_cmp(&b.distance(p)));
    if inside { foot } else { of_edges.unwrap_or(foot) }
}

/// Sums over fragments of one colour: normals and positions within the voxel.
fn expected(triangles: &[Triangle]) -> (DVec3, DVec3) {
    let first = DVec3::from_array(CROWDED.map(|i| i as f64));
    let sums = triangles.iter().map(|triangle| {
        let t = triangle.map(|corner| DVec3::from_array(corner.map(|x| x as f64 / VOXEL as f64)) - first);
        let normal = (t[1] - t[0]).cross(t[2] - t[0]).normalize();
        (normal, nearest(t, DVec3::splat(0.5)))
    });
    sums.fold((DVec3::ZERO, DVec3::ZERO), |sum, term| (sum.0 + term.0, sum.1 + term.1))
}

/// Ten thousand triangles of two colours: every one counts, colours to the last bit, normals and positions to the
/// rounding of a term, 2^-16 and 2^-17, and of the single floats before it.
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
        let meets = |t: &&Triangle| oracle::voxels(t, lattice.grid.size, rule, Ties::Count).count() == 1;
        let of = |all: &[Triangle]| all.iter().filter(meets).copied().collect::<Vec<_>>();
        let crowds = [of(some), of(others)];
        let all = crowds.concat();
        assert!(rule == Rule::Thin || all.len() == 10_000);
        let fixed = |c: f32| u64::from((c * 65536.0).round() as u32);
        let count = all.len() as f64;
        let (normal, within) = expected(&all);
        for method in METHODS {
            let sums = Sums::of(&scene, &lattice.grid, method, rule);
            let words = sums.voxel(CROWDED);
            assert_eq!(words[0] as usize, all.len(), "{method}, {rule:?}");
            for i in 0..3 {
                let color: u64 = (0..2).map(|k| crowds[k].len() as u64 * fixed(colors[k][i])).sum();
                assert_eq!(u64::from(words[1 + i]), color, "{method}, {rule:?}: colour {i}");
            }
            let found = sums.means(CROWDED);
            let errors = [found.normal - normal / count, found.within - within / count];
            let errors = errors.map(|e| e.abs().max_element());
            println!("{method}, {rule:?}: {count} fragments, errors of normal and position {errors:?}");
            assert!(errors[0] < 1.0 / 65536.0 && errors[1] < 1.0 / 131_072.0, "{errors:?}");
            // The control: the triangles' centres are not what is meant.
            let center = expected_of_centers(&all) / count;
            assert!((found.within - center).abs().max_element() > 0.001);
        }
    }
}

fn expected_of_centers(triangles: &[Triangle]) -> DVec3 {
    let first = DVec3::from_array(CROWDED.map(|i| i as f64));
    let center = |t: &Triangle| {
        let corners = t.map(|corner| DVec3::from_array(corner.map(|x| x as f64 / VOXEL as f64)) - first);
        corners.into_iter().sum::<DVec3>() / 3.0
    };
    triangles.iter().map(center).sum()
}

/// More fragments than a sum takes: the rest is left out, and no word overflows; what moves has a sum of its own.
#[test]
fn sums_are_full_before_they_overflow() {
    let lattice = lattice();
    let region = region();
    let ([x, y, z], [far, ..]) = (region.low, region.high);
    // Reaches over the voxel's middle, its normal along -x.
    let triangle = [[x + 2048, y, z], [x + 2048, y, z + 4000], [x + 2048, y + 4000, z]];
    assert!(triangle.iter().flatten().all(|unit| unit % 2 == 1) && far > x + 2048);
    let crowd = vec![triangle; 40_000];
    let one = model(&lattice, &[(&crowd, [1.0; 3])]);
    let mut two = model(&lattice, &[(&crowd, [1.0; 3]), (&crowd, [1.0; 3])]);
    two.motion =
        Some("(node: \"part2\", keys: [(time: 0), (time: 1, offset: (0.01, 0, 0)), (time: 2)])".to_owned());
    for (model, still, moving) in [(one, 40_000, 0), (two, 40_000, 40_000)] {
        let scene = lattice.loaded(&model);
        assert_eq!(scene.triangles.len() - scene.still_triangles, moving);
        let terms = MOST_TERMS * (1 + u32::from(moving > 0));
        for method in METHODS {
            let way = Way { method, payload: "payload/sums", rule: Rule::Conservative };
            let at = oracle::number(CROWDED, lattice.grid.size);
            assert_eq!(counted(&scene, &lattice.grid, &way)[at], terms, "{method}");
            let sums = Sums::of(&scene, &lattice.grid, method, Rule::Conservative);
            let words: [u32; WORDS] = sums.voxel(CROWDED);
            assert_eq!(words[0] as usize, still + moving, "{method}: all are counted");
            assert_eq!(words[1..4], [terms * 65536; 3], "{method}");
            let normal = [words[4], words[5], words[6]].map(u32::cast_signed);
            assert_eq!(normal, [-(terms.cast_signed() * 32768), 0, 0], "{method}");
        }
    }
}
