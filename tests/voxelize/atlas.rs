//! The atlas voxelizer against the exact tests of overlap: nothing where surfaces are not, and how much is missed.

use crate::lattice::Lattice;
use crate::oracle::{HALF, Rule, Ties, VOXEL, count, filled, snapped};
use crate::random::{Region, hardened};
use crate::support::scenes;
use crate::voxelizer::{Grid, METHODS, Way, counted, run};
use fastrand::Rng;
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use voxgi::expr::Value;
use voxgi::frame::Image;
use voxgi::library::Library;
use voxgi::record;
use voxgi::scene::atlas::Atlas;
use voxgi::scene::{self, Scene};
use voxgi::session::{Request, prepare};

fn shipped(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A scene, unwrapped here rather than in the user's cache.
pub fn unwrapped(scene: Scene) -> Scene {
    assert!(scene.atlas.set(Arc::new(Atlas::of(&scene, None))).is_ok(), "it is not made yet");
    scene
}

fn loaded(path: &Path) -> Scene {
    unwrapped(scene::load(path).expect("the scene"))
}

/// Whether the atlas voxelizer fills each voxel.
pub fn through_atlas(scene: &Scene, grid: &Grid, texels_per_voxel: f64) -> Vec<u32> {
    through(scene, grid, "payload/sums", texels_per_voxel)
}

/// The same with another payload.
pub fn through(scene: &Scene, grid: &Grid, payload: &str, texels_per_voxel: f64) -> Vec<u32> {
    let image = shown("occupancy", scene, grid, payload, texels_per_voxel);
    image.data.into_iter().map(|filled| filled as u32).collect()
}

/// The picture that a pipeline of these tests makes, of its own name.
fn shown(pipeline: &str, scene: &Scene, grid: &Grid, payload: &str, texels_per_voxel: f64) -> Image {
    let mut sets: Vec<_> =
        grid.knobs.iter().map(|(knob, value)| ((*knob).to_owned(), value.clone())).collect();
    sets.push(("texels_per_voxel".to_owned(), format!("{texels_per_voxel:?}")));
    let parts = [("grid", grid.part), ("payload", payload), ("voxelize", "voxelize/atlas")];
    let parts = parts.map(|(role, part)| (role.to_owned(), part.to_owned())).to_vec();
    let request = Request { pipeline: pipeline.to_owned(), size: [8, 8], sets, parts, ..Request::default() };
    run(&request, pipeline, scene)
        .unwrap_or_else(|problems| panic!("{:?}", problems.iter().collect::<Vec<_>>()))
}

/// What the other voxelizers fill.
fn whole(scene: &Scene, grid: &Grid, rule: Rule) -> Vec<u32> {
    counted(scene, grid, &Way { method: METHODS[0], payload: "payload/bits", rule })
}

/// Voxels that `a` fills and `b` does not.
pub fn beyond(a: &[u32], b: &[u32]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| **a > 0 && **b == 0).count()
}

/// Loose triangles anywhere, just touching voxels, lying along their faces, and without area.
#[test]
fn points_lie_in_voxels_that_triangles_touch() {
    let lattice = Lattice::cube(32);
    let region = Region::scene(&lattice);
    let mut rng = Rng::with_seed(5);
    let mut of = |numbers: [usize; 3], steps: [i64; 3]| {
        let reach = [2, 8, 29];
        let sets = (0..3).map(|i| region.triangles(&mut rng, numbers[i], reach[i] * VOXEL, steps[i]));
        sets.collect::<Vec<_>>().concat()
    };
    let sets = [
        ("anywhere", of([2000, 600, 80], [1, 1, 1]), 80),
        ("on a lattice", of([2000, 500, 60], [1024, 2048, 4096]), 80),
        ("hard", hardened(of([800, 300, 60], [512, 1, 2048]), 512), 40),
    ];
    for (kind, triangles, least) in sets {
        let triangles = lattice.fixed(&triangles);
        let scene = unwrapped(lattice.scene(&triangles));
        let triangles = snapped(&triangles);
        let [thin, touched] = Rule::BOTH.map(|rule| count(&triangles, lattice.grid.size, rule, Ties::Count));
        let found = through_atlas(&scene, &lattice.grid, 4.0);
        println!("{kind}: {} of {} touched", filled(&found), filled(&touched));
        assert_eq!(beyond(&found, &touched), 0, "{kind}");
        assert!(filled(&found) * 100 > filled(&touched) * least, "{kind}: most that has an area is found");
        assert!(beyond(&found, &thin) > 100, "a control: not all of them are of the thin set");
    }
}

/// The weights of all points together are the area of what is voxelized.
#[test]
fn weights_of_points_are_their_share_of_the_surface() {
    let lattice = Lattice::cube(32);
    let mut rng = Rng::with_seed(6);
    let region = Region::scene(&lattice);
    for reach in [4, 20] {
        let triangles = region.triangles(&mut rng, 300, reach * VOXEL, 1);
        let scene = unwrapped(lattice.scene(&lattice.fixed(&triangles)));
        // Those that fix the grid lie in its corners.
        let all = snapped(&lattice.fixed(&triangles));
        let area: f64 = all
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|p| DVec3::from_array(p.map(|x| x as f64 / VOXEL as f64)));
                0.5 * (b - a).cross(c - a).length()
            })
            .sum();
        for texels in [2.0, 4.0] {
            let words = shown("words", &scene, &lattice.grid, "payload/sums", texels).bytes;
            let word = |at: usize| u32::from_le_bytes(words[4 * at..4 * at + 4].try_into().expect("a word"));
            let weights: f64 = (0..words.len() / 40).map(|voxel| f64::from(word(10 * voxel)) / 65536.0).sum();
            println!("triangles within {reach} voxels, {texels} texels: {weights:.3} of {area:.3}");
            assert!((weights / area - 1.0).abs() < 0.005, "{weights} of {area}");
        }
    }
}

/// Holes in the thin set, as shares of it, by texels for each voxel. Half as many texels as voxels can't do.
fn check_holes(scene: &Scene, resolution: i64, bounds: [(f64, f64); 2]) {
    let grid = Grid::cube(resolution);
    let [thin, touched] = Rule::BOTH.map(|rule| whole(scene, &grid, rule));
    for (texels, bound) in bounds {
        let found = through_atlas(scene, &grid, texels);
        let missed = beyond(&thin, &found) as f64 / filled(&thin) as f64;
        println!("{resolution}³, {texels} texels: {missed:.5} of the thin set missed");
        assert_eq!(beyond(&found, &touched), 0);
        assert!(missed <= bound, "{missed}");
    }
    let coarse = through_atlas(scene, &grid, 0.5);
    assert!(beyond(&thin, &coarse) * 2 > filled(&thin), "a control");
}

#[test]
fn walls_have_no_holes() {
    check_holes(&loaded(&shipped("scenes/cornell-box.glb")), 64, [(2.0, 0.0), (4.0, 0.0)]);
}

#[test]
fn scans_have_few_holes() {
    let Some(folder) = scenes() else { return };
    let bunny = loaded(&folder.join("bunny.glb"));
    check_holes(&bunny, 64, [(2.0, 0.01), (4.0, 0.001)]);
    check_holes(&bunny, 128, [(2.0, 0.005), (4.0, 0.0005)]);
}

/// What moves is found where it is, by the layout made before it moved.
#[test]
fn what_moves_is_found_where_it_is() {
    let scene = loaded(&shipped("scenes/cornell-moving.ron"));
    let mut later = scene.clone();
    later.pose(0.5);
    let grid = Grid::cube(64);
    let [at_first, there] = [&scene, &later].map(|scene| whole(scene, &grid, Rule::Conservative));
    let found = through_atlas(&later, &grid, 2.0);
    assert_eq!(beyond(&found, &there), 0);
    assert!(beyond(&found, &at_first) > 100, "a control: it has moved");
    assert!(Arc::ptr_eq(later.atlas.get().expect("it is made"), scene.atlas.get().expect("it is made")));
}

/// Unwrapping is for those who ask.
#[test]
fn only_who_asks_has_surfaces_unwrapped() {
    let scene = voxgi::scene::load(&shipped("scenes/cornell-box.glb")).expect("the scene");
    let library = Library::new(Vec::new()).expect("the library");
    let mut request = Request { pipeline: "voxels".to_owned(), ..Request::default() };
    prepare(&request, &library, Some(&scene)).expect("it is right");
    assert!(scene.atlas.get().is_none());
    let atlas = Atlas::of(&scene, None);
    let largest = (scene.bounds.max.as_dvec3() - scene.bounds.min.as_dvec3()).max_element();
    let side = (atlas.extent / (largest / 61.0) * 2.0).ceil();
    scene.atlas.set(Arc::new(atlas)).expect("it is not made yet");
    request.parts.push(("voxelize".to_owned(), "voxelize/atlas".to_owned()));
    let prepared = prepare(&request, &library, Some(&scene)).expect("it is right");
    let found = prepared.graph.plan.values.iter().find(|value| value.path.ends_with("atlas_side"));
    assert_eq!(found.expect("the part's value").value, Value::Number(side));
    // Far beyond any device.
    request.sets.push(("texels_per_voxel".to_owned(), "32.0".to_owned()));
    request.sets.push(("resolution".to_owned(), "256".to_owned()));
    let prepared = prepare(&request, &library, Some(&scene)).expect("no device is asked");
    let problem = voxgi::graph::check::limits(&prepared.graph, &wgpu_types::Limits::default(), "WebGPU");
    assert!(format!("{problem:?}").contains("still_map"), "{problem:?}");
    // Without a scene it stays open.
    prepare(&request, &library, None).expect("it is right");
}

/// Triangles without area have no place in the atlas, and other voxelizers fill what they meet: a scene with some is
/// told what it loses.
#[test]
fn what_has_no_place_in_the_atlas_is_said() {
    let lattice = Lattice::cube(32);
    let [flat, line] = [[9, 5, 1], [9, 1, 1]].map(|last| {
        let corners = [[1, 1, 1], [5, 1, 1], last];
        corners.map(|corner| corner.map(|i| i * VOXEL + HALF))
    });
    let [whole, losing] =
        [vec![flat], vec![flat, line]].map(|t| unwrapped(lattice.scene(&lattice.fixed(&t))));
    let library = Library::new(Vec::new()).expect("the library");
    let lacks = |part: String, scene: Option<&Scene>| {
        let parts = vec![("voxelize".to_owned(), part)];
        let request = Request { pipeline: "voxels".to_owned(), parts, ..Request::default() };
        let prepared = prepare(&request, &library, scene).expect("it is right");
        let listed = prepared.graph.plan.lacks.len();
        (listed, scene.map_or(0, |scene| record::lacks(scene, &prepared.graph).len()))
    };
    assert_eq!(lacks("voxelize/atlas".to_owned(), Some(&losing)), (1, 1));
    assert_eq!(lacks("voxelize/atlas".to_owned(), Some(&whole)), (0, 0));
    assert_eq!(lacks("voxelize/atlas".to_owned(), None), (1, 0), "it may be so");
    METHODS
        .iter()
        .for_each(|method| assert_eq!(lacks(method.to_string(), Some(&losing)), (0, 0), "{method}"));
}
