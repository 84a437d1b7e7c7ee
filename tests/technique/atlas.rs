//! The atlas voxelizer against the exact tests of overlap: nothing where surfaces are not, and how much is missed.

use super::program::{render, shipped};
use super::scenes::Studio;
use super::support::scenes;
use super::voxels::{Rule, Ties, count, counted, filled, hard, random, scene, snapped};
use std::path::Path;
use std::sync::Arc;
use voxgi::expr::Value;
use voxgi::library::Library;
use voxgi::scene::atlas::Atlas;
use voxgi::session::{Request, prepare};

/// For each voxel how many points the atlas voxelizer puts there; `more`: options.
fn through_atlas(scene: &Path, resolution: i64, texels_per_voxel: f64, more: &str) -> Vec<u32> {
    let atlas = format!("--part voxelize=voxelize/atlas --set texels_per_voxel={texels_per_voxel:?}");
    let [picture] =
        render(scene, "occupancy", &format!("{atlas} --set resolution={resolution} {more}"), ["occupancy"]);
    picture.texels().map(|texel| texel[0] as u32).collect()
}

/// Voxels that `a` fills and `b` does not.
fn beyond(a: &[u32], b: &[u32]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| **a > 0 && **b == 0).count()
}

/// Loose triangles anywhere, just touching voxels, lying along their faces, and without area.
#[test]
fn points_lie_in_voxels_that_triangles_touch() {
    let studio = Studio::new();
    let sets = [
        ("anywhere", [random(2000, 2, 1), random(600, 8, 1), random(80, 29, 1)].concat(), 80),
        ("on a lattice", [random(2000, 2, 1024), random(500, 8, 2048), random(60, 29, 4096)].concat(), 80),
        (
            "hard",
            [hard(random(800, 2, 512)), hard(random(300, 8, 1)), hard(random(60, 29, 2048))].concat(),
            40,
        ),
    ];
    for (kind, triangles, least) in sets {
        let path = scene(&studio, &triangles);
        let triangles = snapped(&triangles);
        let touched = count(&triangles, 32, Rule::Conservative, Ties::Count);
        let thin = count(&triangles, 32, Rule::Thin, Ties::Count);
        let found = through_atlas(&path, 32, 4.0, "");
        println!(
            "{kind}: {} of {} touched, {} beyond, {} beyond thin",
            filled(&found),
            filled(&touched),
            beyond(&found, &touched),
            beyond(&found, &thin)
        );
        assert_eq!(beyond(&found, &touched), 0, "{kind}");
        assert!(filled(&found) * 100 > filled(&touched) * least, "{kind}: most that has an area is found");
        assert!(beyond(&found, &thin) > 100, "a control: not all of them are of the thin set");
    }
}

/// Holes in the thin set, as shares of it, by texels for each voxel. Half as many texels as voxels can't do.
fn check_holes(path: &Path, resolution: i64, bounds: [(f64, f64); 2]) {
    let touched = counted(path, resolution, Rule::Conservative);
    let thin = counted(path, resolution, Rule::Thin);
    for (texels, bound) in bounds {
        let found = through_atlas(path, resolution, texels, "");
        let missed = beyond(&thin, &found) as f64 / filled(&thin) as f64;
        println!("{} at {resolution}³, {texels} texels: {missed:.5} of the thin set missed", path.display());
        assert_eq!(beyond(&found, &touched), 0);
        assert!(missed <= bound, "{missed}");
    }
    let coarse = through_atlas(path, resolution, 0.5, "");
    assert!(beyond(&thin, &coarse) * 2 > filled(&thin), "a control");
}

#[test]
fn walls_have_no_holes() {
    check_holes(&shipped("scenes/cornell-box.glb"), 64, [(2.0, 0.0), (4.0, 0.0)]);
}

#[test]
fn scans_have_few_holes() {
    let Some(folder) = scenes() else { return };
    check_holes(&folder.join("bunny.glb"), 64, [(2.0, 0.01), (4.0, 0.001)]);
    check_holes(&folder.join("bunny.glb"), 128, [(2.0, 0.005), (4.0, 0.0005)]);
}

/// What moves is found where it is, by the layout made before it moved.
#[test]
fn what_moves_is_found_where_it_is() {
    let path = shipped("scenes/cornell-moving.ron");
    let at = |more: &str| {
        let options = format!("--set separability=26 --set resolution=64 {more}");
        let [picture] = render(&path, "occupancy", &options, ["occupancy"]);
        picture.texels().map(|texel| texel[0] as u32).collect::<Vec<_>>()
    };
    // Half a second, asked for at once and come to by playing: the first frame is not counted.
    let later = at("--time 0.5");
    let found = ["--time 0.5", "--play 4 --frames 2"].map(|more| through_atlas(&path, 64, 2.0, more));
    for found in &found {
        assert_eq!(beyond(found, &later), 0);
        assert!(beyond(found, &at("")) > 100, "a control: it has moved");
    }
    assert!(beyond(&found[0], &found[1]) + beyond(&found[1], &found[0]) < 50);
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
