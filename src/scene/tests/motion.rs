//! Motion against closed forms.

use crate::scene::motion::{Carried, Interpolation, Keys, Motion, MovingNode, Parent, Pose, Property, Track};
use crate::scene::{self, Scene, generate};
use glam::{DMat4, DQuat, DVec3, DVec4, Vec3};
use proptest::prelude::*;
use std::f64::consts::PI;

fn still() -> Pose {
    Pose::Parts { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
}

fn node(parent: Parent, tracks: Vec<Track>) -> MovingNode {
    MovingNode { parent, rest: still(), tracks, added: None, carries: Vec::new() }
}

fn track(property: Property, interpolation: Interpolation, keys: &[(f64, &[DVec4])]) -> Track {
    let times: Vec<f64> = keys.iter().map(|(time, _)| *time).collect();
    let values = keys.iter().flat_map(|(_, values)| values.iter().copied()).collect();
    let duration = times[times.len() - 1];
    Track { property, keys: Keys { interpolation, times, values }, duration }
}

fn at(motion: &Motion, node: usize, time: f64, point: DVec3) -> DVec3 {
    motion.to_world(time)[node].transform_point3(point)
}

fn close(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-9
}

#[test]
fn steps_lines_and_the_ends() {
    let keys: &[(f64, &[DVec4])] = &[(1.0, &[DVec4::X]), (3.0, &[DVec4::Y])];
    for (interpolation, middle) in
        [(Interpolation::Step, DVec3::X), (Interpolation::Linear, DVec3::new(0.75, 0.25, 0.0))]
    {
        let tracks = vec![track(Property::Translation, interpolation, keys)];
        let motion = Motion { nodes: vec![node(Parent::Still(DMat4::IDENTITY), tracks)] };
        assert_eq!(motion.duration(), 3.0);
        assert!(close(at(&motion, 0, 0.0, DVec3::ZERO), DVec3::X), "before the first key");
        assert!(close(at(&motion, 0, 1.5, DVec3::ZERO), middle), "{interpolation:?}");
        assert!(close(at(&motion, 0, 3.0, DVec3::ZERO), DVec3::Y), "at the last key");
        assert!(close(at(&motion, 0, 4.5, DVec3::ZERO), middle), "again after 3 s: {interpolation:?}");
    }
}

#[test]
fn turns_take_the_short_way_at_even_speed() {
    let quarter = DVec4::from(DQuat::from_rotation_y(PI / 2.0));
    // The same turn with the other sign.
    for end in [quarter, -quarter] {
        let keys: &[(f64, &[DVec4])] = &[(0.0, &[DVec4::W]), (1.0, &[end])];
        let tracks = vec![track(Property::Rotation, Interpolation::Linear, keys)];
        let motion = Motion { nodes: vec![node(Parent::Still(DMat4::IDENTITY), tracks)] };
        for part in [0.0, 0.25, 1.0 / 3.0, 0.9, 1.0] {
            let angle = part * PI / 2.0;
            let expected = DVec3::new(angle.cos(), 0.0, -angle.sin());
            assert!(close(at(&motion, 0, part, DVec3::X), expected), "{part}");
        }
    }
}

#[test]
fn children_are_carried_and_move_by_themselves() {
    let turning: &[(f64, &[DVec4])] = &[(0.0, &[DVec4::W]), (2.0, &[DQuat::from_rotation_z(PI).into()])];
    let growing: &[(f64, &[DVec4])] = &[(0.0, &[DVec4::ONE]), (2.0, &[DVec4::splat(3.0)])];
    let parent = Parent::Still(DMat4::from_translation(DVec3::new(10.0, 0.0, 0.0)));
    let mut child = node(Parent::Moving(0), vec![track(Property::Scale, Interpolation::Linear, growing)]);
    child.rest = Pose::Parts { translation: DVec3::Y, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
    let turn = track(Property::Rotation, Interpolation::Linear, turning);
    let motion = Motion { nodes: vec![node(parent, vec![turn]), child] };
    // After a second the parent has turned its y to −x, and the child is twice as large.
    assert!(close(at(&motion, 1, 1.0, DVec3::Y), DVec3::new(10.0 - 3.0, 0.0, 0.0)));
    assert!(close(at(&motion, 1, 0.0, DVec3::Y), DVec3::new(10.0, 2.0, 0.0)));
}

proptest! {
    /// Hermite splines through a cubic, with its derivatives as tangents, are that cubic.
    #[test]
    fn a_spline_is_the_cubic_it_is_taken_from(
        c in prop::array::uniform4(-3.0..3.0f64), start in 0.0..2.0f64, gaps in prop::array::uniform3(0.1..2.0f64),
        part in 0.0..1.0f64,
    ) {
        let value = |t: f64| c[0] + t * (c[1] + t * (c[2] + t * c[3]));
        let slope = |t: f64| c[1] + t * (2.0 * c[2] + t * 3.0 * c[3]);
        let times = [start, start + gaps[0], start + gaps[0] + gaps[1], start + gaps.iter().sum::<f64>()];
        let keys: Vec<(f64, [DVec4; 3])> =
            times.iter().map(|t| (*t, [slope(*t), value(*t), slope(*t)].map(DVec4::splat))).collect();
        let keys: Vec<(f64, &[DVec4])> = keys.iter().map(|(t, values)| (*t, &values[..])).collect();
        let tracks = vec![track(Property::Translation, Interpolation::Spline, &keys)];
        let motion = Motion { nodes: vec![node(Parent::Still(DMat4::IDENTITY), tracks)] };
        let time = start + part * (times[3] - start);
        let found = at(&motion, 0, time, DVec3::ZERO).x;
        prop_assert!((found - value(time)).abs() < 1e-6 * (1.0 + value(time).abs()), "{found} {}", value(time));
    }
}

/// The generated box with this added to its setting.
fn moving(more: &str) -> Scene {
    load(more).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn load(more: &str) -> crate::problem::Result<Scene> {
    let folder = tempfile::tempdir().unwrap();
    let (name, make) = generate::ALL[0];
    std::fs::write(folder.path().join(name), make()).unwrap();
    let path = folder.path().join("moving.ron");
    std::fs::write(&path, format!("Setting(gltf: \"cornell-box.glb\", {more})")).unwrap();
    scene::load(&path)
}

const BLOCK: &str = r#"motion: [(node: "tall_block", axis: (0, 2, 0), pivot: (0.3, 0, 0.3),
    keys: [(time: 0), (time: 2, offset: (0.1, 0.2, 0), degrees: 180)])],"#;

/// Where the corners of the moving triangles are now.
fn corners(scene: &Scene) -> Vec<Vec3> {
    let moving = &scene.triangles[scene.still_triangles..];
    let corner = |instance: u32, vertex: u32| {
        let [x, y, z, w] = scene.instances[instance as usize].to_world;
        let p = scene.vertices[vertex as usize].position;
        (x * p.x + y * p.y + z * p.z + w).truncate()
    };
    moving.iter().flat_map(|t| [t.a, t.b, t.c].map(|vertex| corner(t.instance, vertex))).collect()
}

#[test]
fn a_setting_moves_a_node() {
    let mut scene = moving(BLOCK);
    assert_eq!((scene.triangles.len(), scene.still_triangles), (38, 28), "the block has ten triangles");
    assert_eq!(scene.motion.duration(), 2.0);
    let before = corners(&scene);
    // A half turn about the pivot, half the offset later a quarter.
    for (time, expected) in [
        (2.0, (|p| Vec3::new(0.6 - p.x + 0.1, p.y + 0.2, 0.6 - p.z)) as fn(Vec3) -> Vec3),
        (1.0, |p| Vec3::new(0.3 + (p.z - 0.3) + 0.05, p.y + 0.1, 0.3 - (p.x - 0.3))),
        (0.0, |p| p),
    ] {
        let moved = scene.pose(time);
        assert!(moved.geometry && !moved.lights && !moved.cameras);
        for (found, start) in corners(&scene).iter().zip(&before) {
            assert!((*found - expected(*start)).length() < 1e-6, "{time}: {start} {found}");
        }
        assert!(!scene.pose(time).geometry, "nothing has moved since");
    }
}

#[test]
fn the_bounds_hold_all_times() {
    let still = moving("");
    let mut scene = moving(BLOCK);
    assert!(scene.bounds != still.bounds && scene.bounds.union(&still.bounds) == scene.bounds);
    let slack = 1e-3 * scene.bounds.diagonal() as f32;
    for i in 0..200 {
        scene.pose(f64::from(i) * 0.01);
        for corner in corners(&scene) {
            let (low, high) = (scene.bounds.min - slack, scene.bounds.max + slack);
            assert!(corner.cmpge(low).all() && corner.cmple(high).all(), "{i}: {corner}");
        }
    }
}

#[test]
fn lights_move_with_their_views() {
    let mut scene = moving(
        r#"lights: [
            Point(position: (0.1, 0.2, 0.3), intensity: (1, 1, 1)),
            Spot(position: (0.2, 0.5, 0.2), direction: (1, 0, 0), intensity: (1, 1, 1), inner_degrees: 5,
                 outer_degrees: 30, motion: (keys: [(time: 0), (time: 1, offset: (0, 0, 0.2), degrees: 90)])),
        ]"#,
    );
    assert!((scene.lights[1].direction - Vec3::X).length() < 1e-6);
    let before = scene.clone();
    assert!(scene.motion.nodes[0].carries == [Carried::Light(1)] && scene.still_triangles == 38);
    let moved = scene.pose(1.0);
    assert!(moved.lights && !moved.geometry);
    assert!((scene.lights[1].direction - Vec3::NEG_Z).length() < 1e-6, "{}", scene.lights[1].direction);
    assert!((scene.lights[1].position - Vec3::new(0.2, 0.5, 0.4)).length() < 1e-6);
    assert_eq!(scene.lights[0], before.lights[0]);
    assert_eq!(scene.views[..6], before.views[..6]);
    assert!((scene.views[6].direction - Vec3::NEG_Z).length() < 1e-6);
}

#[test]
fn mistakes_in_motion_are_pointed_at() {
    for (more, code, word) in [
        (r#"motion: [(node: "tall block", keys: [(time: 0)])]"#, "setting-node", "`tall_block`"),
        (r#"motion: [(node: "floor", keys: [])]"#, "setting-value", "there must be a key"),
        (r#"motion: [(node: "floor", keys: [(time: 1), (time: 1)])]"#, "setting-value", "must grow"),
        (r#"motion: [(node: "floor", axis: (0, 0, 0), keys: [(time: 1)])]"#, "setting-value", "axis"),
        (r#"motion: [(node: "floor", keys: [(time: 1, degrees: 1e99)])]"#, "setting-value", "finite"),
        (r#"motion: [(node: "floor", keys: [(tiem: 1)])]"#, "setting", "`time`"),
    ] {
        let problems = load(more).unwrap_err();
        let problem = problems.iter().next().unwrap();
        let said = format!("{} {}", problem.message, problem.help.as_deref().unwrap_or_default());
        assert_eq!(problem.code, code, "{more}: {said}");
        assert!(said.contains(word) && !problem.labels.is_empty(), "{more}: {said}");
    }
}

/// A box that is followed up the hierarchy holds everything at any times of motions that don't keep step, mirrored and
/// grown from nothing too; and rest poses are what still nodes have.
#[test]
fn motions_out_of_step_stay_within_the_bounds() {
    let folder = tempfile::tempdir().unwrap();
    let document = serde_json::json!({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [
            {"scale": [1, -1, 1], "children": [1], "translation": [1, 0, 0]},
            {"name": "flag", "scale": [-1, -1, -1], "mesh": 0, "translation": [0, 2, 0]},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
            {"bufferView": 1, "componentType": 5126, "type": "SCALAR", "count": 2},
            {"bufferView": 2, "componentType": 5126, "type": "VEC3", "count": 2},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
            {"buffer": 0, "byteOffset": 44, "byteLength": 24},
        ],
        "buffers": [{"byteLength": 68, "uri": "data.bin"}],
        "animations": [{
            "samplers": [{"input": 1, "output": 2}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        }],
    });
    let numbers: [f32; 17] = [
        0., 0., 0., 1., 0., 0., 0., 1., 0., /* times */ 0., 2., /* from, to */ 1., 0., 0., 5., 0.,
        0.,
    ];
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    std::fs::write(folder.path().join("data.bin"), bytes).unwrap();
    std::fs::write(folder.path().join("flag.gltf"), document.to_string()).unwrap();
    let setting = r#"Setting(gltf: "flag.gltf", motion: [(node: "flag", axis: (0, 0, 1), pivot: (0, 0, 0),
        keys: [(time: 0), (time: 3, degrees: 170, offset: (0, 0, 1))])])"#;
    let path = folder.path().join("flag.ron");
    std::fs::write(&path, setting).unwrap();
    let mut scene = scene::load(&path).unwrap();
    // At rest: (x, y, z) → (−x, 2 − y, −z) in the parent, which mirrors y and stands at 1.
    let expected = [Vec3::new(1.0, -2.0, 0.0), Vec3::new(0.0, -2.0, 0.0), Vec3::new(1.0, -1.0, 0.0)];
    for (found, expected) in corners(&scene).iter().zip(expected) {
        assert!((*found - expected).length() < 1e-6, "{found} {expected}");
    }
    let slack = 1e-3 * scene.bounds.diagonal() as f32;
    let within = |corner: Vec3, bounds: &crate::scene::Bounds| {
        corner.cmpge(bounds.min - slack).all() && corner.cmple(bounds.max + slack).all()
    };
    let mut once: Option<crate::scene::Bounds> = None;
    let mut only_later = 0;
    for i in 0..600 {
        scene.pose(f64::from(i) * 0.01);
        for corner in corners(&scene) {
            assert!(within(corner, &scene.bounds), "{i}: {corner} {:?}", scene.bounds);
        }
        let seen = crate::scene::Bounds::around(corners(&scene)).unwrap();
        if i < 300 {
            once = Some(once.map_or(seen, |bounds| bounds.union(&seen)));
        } else {
            only_later += corners(&scene).iter().filter(|corner| !within(**corner, &once.unwrap())).count();
        }
    }
    // The control: going through the longest motion once does not find all places.
    assert!(only_later > 0, "some places are reached only when the motions are out of step");
}
