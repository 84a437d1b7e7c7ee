//! The generated scenes, the settings, and the scenes that `VOXGI_SCENES` names.

#[path = "support/scenes.rs"]
mod support;

use glam::Vec3;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use support::scenes;
use voxgi::scene::layout::{DIRECTIONAL, POINT};
use voxgi::scene::listing::list;
use voxgi::scene::{Scene, generate, load};

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)
}

/// Triangles as material and corners in the world, in micrometres, sorted, the first corner the least.
fn geometry(scene: &Scene) -> Vec<([i64; 3], [[i64; 3]; 3])> {
    let micrometres = |v: Vec3| v.as_dvec3().to_array().map(|x| (x * 1e6).round() as i64);
    let mut list: Vec<_> = scene
        .triangles
        .iter()
        .map(|t| {
            let instance = &scene.instances[t.instance as usize];
            let [x, y, z, w] = instance.to_world.map(|column| column.truncate());
            let mut corners = [t.a, t.b, t.c].map(|corner| {
                let p = scene.vertices[corner as usize].position;
                micrometres(x * p.x + y * p.y + z * p.z + w)
            });
            let least = (0..3).min_by_key(|i| corners[*i]).unwrap();
            corners.rotate_left(least);
            (micrometres(scene.materials[instance.material as usize].base_color), corners)
        })
        .collect();
    list.sort_unstable();
    list
}

#[test]
fn generated_scenes_are_those_in_the_repository() {
    assert_eq!(generate::ALL.map(|(name, _)| name), ["cornell-box.glb", "cornell-point.glb"]);
    for (name, make) in generate::ALL {
        let bytes = make();
        assert_eq!(bytes, make(), "{name} differs from run to run");
        assert!(
            bytes == std::fs::read(own(name)).unwrap(),
            "{name}: run `voxgi generate` and look at what differs"
        );
    }
}

/// A generated scene, loaded; and the hash of its file.
fn generated(name: &str) -> (Scene, String) {
    let (file, make) = generate::find(name).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(file);
    let bytes = make();
    std::fs::write(&path, &bytes).unwrap();
    (load(&path).unwrap(), blake3::hash(&bytes).to_hex()[..16].to_owned())
}

#[test]
fn the_large_triangle_spans_its_scene_and_lies_along_no_axis() {
    let (scene, hash) = generated("triangle");
    assert_eq!(hash, "d820a15f07a490e4");
    assert_eq!((scene.triangles.len(), scene.vertices.len()), (1, 3));
    assert_eq!(scene.bounds.max - scene.bounds.min, Vec3::new(2.0, 2.0, 0.8));
    let [a, b, c] = [0, 1, 2].map(|i| scene.vertices[i].position);
    let face = (b - a).cross(c - a);
    assert!((face.normalize() - scene.vertices[0].normal).length() < 1e-6);
    assert!(face.abs().cmpgt(Vec3::splat(0.5)).all(), "{face}");
}

/// Each triangle has the length of a step, and an area; its height is a ribbon's width, or less where that turns.
#[test]
fn the_hairball_is_a_ball_of_thin_triangles() {
    let (scene, hash) = generated("hairball");
    // The same bytes on every machine: were it otherwise, figures of it would not compare.
    assert_eq!(hash, "18367c34b105c835");
    assert!(scene.triangles.len() >= 1_000_000);
    assert_eq!(scene.triangles.len(), generate::hairball::TRIANGLES as usize);
    // Shared by the triangles of a strand: about one vertex for each.
    assert!(scene.vertices.len() * 100 < scene.triangles.len() * 102, "{}", scene.vertices.len());
    let radius = generate::hairball::RADIUS as f32;
    let (low, high) = (scene.bounds.min, scene.bounds.max);
    assert!(low.cmpgt(Vec3::splat(-radius)).all() && low.cmplt(Vec3::splat(-0.9 * radius)).all(), "{low}");
    assert!(high.cmplt(Vec3::splat(radius)).all() && high.cmpgt(Vec3::splat(0.9 * radius)).all(), "{high}");
    for vertex in &scene.vertices {
        assert!(
            vertex.position.length() < radius && (vertex.normal.length() - 1.0).abs() < 1e-4,
            "{vertex:?}"
        );
    }
    for triangle in &scene.triangles {
        let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|i| scene.vertices[i as usize].position);
        let longest = [b - a, c - b, a - c].map(Vec3::length).into_iter().fold(0.0, f32::max);
        let height = (b - a).cross(c - a).length() / longest;
        assert!((0.018..0.023).contains(&longest), "{longest}: {a} {b} {c}");
        assert!((0.0001..0.0009).contains(&height), "{height}: {a} {b} {c}");
    }
}

#[test]
fn the_lamp_and_the_point_light_have_the_same_power() {
    let area = load(&own("cornell-box.glb")).unwrap();
    let point = load(&own("cornell-point.glb")).unwrap();
    assert_eq!(geometry(&area), geometry(&point));
    assert!(point.materials.iter().all(|material| material.emission == Vec3::ZERO));
    assert_eq!((area.lights.len(), point.lights.len()), (0, 1));
    let lamp = area.materials.iter().find(|material| material.emission != Vec3::ZERO).unwrap();
    // π L A of a Lambertian lamp of 130 × 105 mm, against 4 π I.
    let power = std::f32::consts::PI * lamp.emission * 0.13 * 0.105;
    let light = &point.lights[0];
    assert!((4.0 * std::f32::consts::PI * light.intensity - power).length() < 1e-5);
    assert!((light.position - Vec3::new(0.278, 0.4988, 0.2795)).length() < 1e-6);
    // The published camera: 35 mm before a film of 25 mm, looking along +z.
    let camera = &area.cameras[0];
    assert!((2.0 * camera.lens.half_height().atan().to_degrees() - 39.3076).abs() < 1e-4);
    assert!((camera.position.as_vec3() - Vec3::new(0.278, 0.273, -0.8)).length() < 1e-6);
    assert!(
        (camera.forward.as_vec3() - Vec3::Z).length() < 1e-6
            && (camera.up.as_vec3() - Vec3::Y).length() < 1e-6
    );
    // +x is to the left.
    assert!((camera.right.as_vec3() + Vec3::X).length() < 1e-6);
}

/// Into the room, out of the blocks: from the middle of the room one sees no back.
#[test]
fn the_box_faces_its_inside() {
    let scene = load(&own("cornell-box.glb")).unwrap();
    let middle = Vec3::new(0.278, 0.45, 0.279);
    for triangle in &scene.triangles {
        let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|i| scene.vertices[i as usize]);
        let face = (b.position - a.position).cross(c.position - a.position).normalize();
        // The left wall's four published corners are not quite in one plane.
        assert!((face - a.normal).length() < 5e-3, "{face} {}", a.normal);
        let in_block = scene.instances[triangle.instance as usize].material == 0
            && a.position.y < 0.34
            && face.y.abs() < 0.5;
        assert!(in_block || face.dot(middle - a.position) > 0.0, "{:?}", a.position);
    }
}

#[test]
fn the_box_is_that_of_the_scenes_folder() {
    let Some(folder) = scenes() else { return };
    let theirs = load(&folder.join("cornell-box.glb")).unwrap();
    let ours = load(&own("cornell-box.glb")).unwrap();
    assert_eq!(geometry(&ours).len(), 38);
    assert_eq!(geometry(&ours), geometry(&theirs));
    let emission = |scene: &Scene| scene.materials.iter().map(|m| m.emission).fold(Vec3::ZERO, Vec3::max);
    assert_eq!(emission(&ours), emission(&theirs));
    assert_eq!(ours.cameras, theirs.cameras);
}

#[test]
fn triangles_and_bounds_are_as_published() {
    let Some(folder) = scenes() else { return };
    // Of the table in the folder's SOURCES.md.
    for (name, triangles, min, max) in [
        ("cornell-box", 38, [0., 0., 0.], [0.556, 0.5488, 0.5592]),
        ("sponza-crytek", 262_267, [-15.368, -1.012, -9.462], [14.399, 11.436, 8.843]),
        ("sponza-dabrovic", 66_450, [-17.403, -0.907, -7.799], [17.417, 15.653, 7.801]),
        ("sibenik", 73_564, [-20.141, -15.312, -8.497], [20.141, 15.300, 8.497]),
        ("living-room", 28_656, [-4.386, -1.975, -0.033], [4.938, 5.182, 9.669]),
        ("bunny", 69_666, [-1., -0.991, -0.775], [1., 0.991, 0.775]),
        ("dragon-100k", 100_000, [-7.047, 0., -3.151], [7.047, 9.940, 3.151]),
        ("dragon-202k", 202_520, [-0.108, 0.053, -0.050], [0.096, 0.197, 0.041]),
    ] {
        let scene = load(&folder.join(format!("{name}.glb"))).unwrap();
        assert_eq!(scene.triangles.len(), triangles, "{name}");
        let error =
            (scene.bounds.min - Vec3::from(min)).abs().max((scene.bounds.max - Vec3::from(max)).abs());
        assert!(error.max_element() <= 5.1e-4, "{name}: {:?}", scene.bounds);
    }
}

#[test]
fn settings_of_the_repository() {
    let Some(_) = scenes() else { return };
    let sponza = load(&own("sponza.ron")).unwrap();
    assert_eq!(
        (sponza.triangles.len(), sponza.lights[0].kind, sponza.views.len()),
        (262_267, DIRECTIONAL, 1)
    );
    assert!((2.0 * sponza.cameras[0].lens.half_height().atan().to_degrees() - 70.0).abs() < 1e-9);
    let sibenik = load(&own("sibenik.ron")).unwrap();
    assert_eq!((sibenik.triangles.len(), sibenik.lights[0].kind, sibenik.views.len()), (73_564, POINT, 6));
    let others = ["sponza-dabrovic", "living-room"].map(|name| load(&own(&format!("{name}.ron"))).unwrap());
    for scene in [sponza, sibenik].iter().chain(&others) {
        let (eye, bounds) = (scene.cameras[0].position.as_vec3(), scene.bounds);
        assert!(eye.cmpge(bounds.min).all() && eye.cmple(bounds.max).all(), "the camera is inside");
    }
}

/// All malformed and odd files of the folder: each loads or says why not, and those without a fault load.
#[test]
fn bad_files_do_no_harm() {
    let Some(folder) = scenes() else { return };
    let index = std::fs::read_to_string(folder.join("bad/INDEX.tsv")).unwrap();
    // Their buffers have no content: right as documents, but nobody can draw them.
    let without_content = ["validator/root/named_objects.gltf", "validator/root/unused_objects.gltf"];
    let (mut loaded, mut refused) = (0, 0);
    for line in index.lines().skip(1) {
        let [name, _, verdict, ..] = line.split('\t').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let path = folder.join("bad").join(name);
        match catch_unwind(|| load(&path)) {
            Ok(Ok(scene)) => {
                let finite = scene.bounds.min.is_finite() && scene.bounds.max.is_finite();
                let in_range = scene.triangles.iter().all(|t| {
                    (t.instance as usize) < scene.instances.len()
                        && [t.a, t.b, t.c].iter().all(|corner| (*corner as usize) < scene.vertices.len())
                });
                assert!(finite && in_range && !scene.cameras.is_empty(), "{name}");
                loaded += 1;
            }
            Ok(Err(problems)) => {
                assert!(verdict != "clean" || without_content.contains(&name), "{name}: {problems}");
                assert!(!problems.to_string().is_empty());
                refused += 1;
            }
            Err(_) => panic!("{name} makes the loader panic"),
        }
    }
    assert!(loaded > 80 && refused > 50, "{loaded} loaded, {refused} refused");
}

/// Each setting says whose its model is and how one comes by it, with and without the model.
#[test]
fn settings_say_how_to_get_their_models() {
    let entries = list(&own("")).unwrap();
    let mut settings = 0;
    for (path, entry) in entries {
        let entry = entry.unwrap_or_else(|problems| panic!("{problems}"));
        // Others name a scene that is in the repository.
        let Some(about) = entry.about.filter(|about| !own(&about.gltf).is_file()) else { continue };
        settings += 1;
        assert!(!about.about.is_empty() && !about.licence.is_empty() && !about.get.is_empty(), "{path:?}");
        assert_eq!(entry.outline.is_some(), about.model.is_some(), "{path:?}");
        assert!(about.cameras > 0 && about.lights > 0, "{path:?}");
        // Without the model, the message tells.
        let folder = tempfile::tempdir().unwrap();
        let text = std::fs::read_to_string(&path).unwrap().replacen(&about.gltf, "there-is-none.glb", 1);
        std::fs::write(folder.path().join("alone.ron"), text).unwrap();
        let problems = load(&folder.path().join("alone.ron")).map(|_| ()).unwrap_err();
        assert!(
            problems.iter().any(|p| p.help.as_ref().is_some_and(|help| help.contains(&about.get))),
            "{problems}"
        );
    }
    assert_eq!(settings, 6);
}
