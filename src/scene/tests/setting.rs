use crate::problem::Problems;
use crate::scene::{self, Scene, generate};
use glam::Vec3;

/// Loads a setting that stands beside the generated box.
fn load(text: &str) -> Result<Scene, Problems> {
    let folder = tempfile::tempdir().unwrap();
    let (name, make) = generate::ALL[0];
    std::fs::write(folder.path().join(name), make()).unwrap();
    let path = folder.path().join("evening.ron");
    std::fs::write(&path, text).unwrap();
    scene::load(&path)
}

#[test]
fn lights_and_cameras_come_first() {
    let scene = load(
        r#"Setting(
            gltf: "cornell-box.glb",
            cameras: [(name: "corner", eye: (0.1, 0.2, 0.3), look_at: (0.5, 0.2, 0.3), fov_degrees: 60)],
            lights: [
                Point(position: (1, 2, 3), intensity: (4, 5, 6)),
                Spot(position: (1, 2, 3), direction: (0, -2, 0), intensity: (1, 1, 1), inner_degrees: 0, outer_degrees: 60),
                Directional(direction: (0, 0, 3), irradiance: (7, 8, 9)),
            ],
        )"#,
    )
    .unwrap();
    assert_eq!(scene.name, "evening");
    let files: Vec<_> = scene.files.iter().map(|file| file.file_name().unwrap().to_string_lossy()).collect();
    assert_eq!(files, ["evening.ron", "cornell-box.glb"]);
    let names: Vec<_> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    assert_eq!(names, ["corner", "cornell"]);
    assert!((2.0 * scene.cameras[0].lens.half_height().atan().to_degrees() - 60.0).abs() < 1e-9);
    assert_eq!(scene.cameras[0].forward.as_vec3(), Vec3::X);
    let kinds: Vec<_> = scene.lights.iter().map(|light| light.kind).collect();
    assert_eq!(kinds, [0, 1, 2]);
    assert_eq!(scene.lights[0].intensity, Vec3::new(4.0, 5.0, 6.0));
    assert_eq!(scene.lights[1].direction, Vec3::NEG_Y);
    assert!((scene.lights[1].cos_outer - 0.5).abs() < 1e-6 && scene.lights[1].cos_inner == 1.0);
    assert_eq!(scene.lights[2].intensity, Vec3::new(7.0, 8.0, 9.0));
    assert_eq!(scene.views.len(), 6 + 1 + 1);
}

/// Each mistake: the piece of the text that the message points at, the code, and a word of message or help.
#[test]
fn mistakes_are_pointed_at() {
    let box_ = r#"gltf: "cornell-box.glb""#;
    for (text, piece, code, word) in [
        (format!("Setting({box_}, lihgts: [])"), "lihgts", "setting", "`lights`"),
        (format!("Setting({box_}, lights: [Pint(position: (0, 0, 0))])"), "Pint", "setting", "`Point`"),
        (
            format!("Setting({box_},\n lights: [ Point(posision: (0, 0, 0), intensity: (1, 1, 1))])"),
            "posision",
            "setting",
            "`position`",
        ),
        (format!("Setting({box_}, lights: [Point(position: (0, 0))])"), "", "setting", ""),
        ("Setting()".to_owned(), "", "setting", "gltf"),
        ("Setting(gltf: \"cornell-box.glb\"".to_owned(), "", "setting", ""),
        (r#"Setting(gltf: "../x.glb")"#.to_owned(), r#""../x.glb""#, "setting-file", "`..`"),
        (r#"Setting(gltf: "/etc/passwd")"#.to_owned(), r#""/etc/passwd""#, "setting-file", ""),
        (r#"Setting(gltf: "none.glb")"#.to_owned(), r#""none.glb""#, "setting-file", "VOXGI_SCENES"),
        (
            format!("Setting({box_}, lights: [Point(position: (0, 0, 0), intensity: (1, -1, 1))])"),
            "Point(position: (0, 0, 0), intensity: (1, -1, 1))",
            "setting-value",
            "negative",
        ),
        (
            format!("Setting({box_}, lights: [Directional(direction: (0, 0, 0), irradiance: (1, 1, 1))])"),
            "Directional(direction: (0, 0, 0), irradiance: (1, 1, 1))",
            "setting-value",
            "direction",
        ),
        (
            format!(
                "Setting({box_}, cameras: [ (name: \"ä\", eye: (0, 0, 0), look_at: (0, 0, 0), fov_degrees: 50)])"
            ),
            "(name: \"ä\", eye: (0, 0, 0), look_at: (0, 0, 0), fov_degrees: 50)",
            "setting-value",
            "same point",
        ),
    ] {
        let problems = load(&text).expect_err(&text);
        let problem = problems.iter().next().unwrap();
        assert_eq!(problem.code, code, "{text}: {problem:?}");
        let said = format!("{} {}", problem.message, problem.help.as_deref().unwrap_or_default());
        assert!(said.contains(word), "{text}: {said}");
        let (place, _) = &problem.labels[0];
        if !piece.is_empty() {
            assert_eq!(place.text(), piece, "{text}: {problem:?}");
        }
        assert_eq!(problems.exit_code(), 2);
    }
}

#[test]
fn all_mistakes_are_found() {
    let problems = load(
        r#"Setting(gltf: "none.glb", lights: [
            Point(position: (0, 0, 0), intensity: (-1, 0, 0)),
            Spot(position: (0, 0, 0), direction: (0, 1, 0), intensity: (1, 1, 1), inner_degrees: 30, outer_degrees: 20),
        ])"#,
    )
    .unwrap_err();
    assert_eq!(problems.iter().count(), 3);
}
