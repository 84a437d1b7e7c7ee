//! Camera paths against closed forms, and their mistakes.

use glam::DVec3;
use proptest::prelude::*;
use voxgi::problem::Source;
use voxgi::profile::path::{CameraPath, orbit, spline::curve};
use voxgi::scene::{Bounds, Camera, Lens};

fn base() -> Camera {
    Camera::looking("base", DVec3::new(0.0, 1.0, 4.0), -DVec3::Z, DVec3::Y).expect("a direction")
}

fn fov(camera: &Camera) -> f64 {
    match camera.lens {
        Lens::Perspective { vertical_fov } => vertical_fov,
        Lens::Orthographic { .. } => panic!("an orthographic camera"),
    }
}

fn path(text: &str) -> CameraPath {
    CameraPath::parse(Source::new("path.ron", text)).unwrap_or_else(|p| panic!("{p:?}"))
}

/// Code and text of each mistake, with what the first label points at.
fn mistakes(text: &str) -> Vec<(&'static str, String)> {
    let problems = CameraPath::parse(Source::new("path.ron", text)).expect_err("a mistake");
    problems
        .iter()
        .map(|p| (p.code, p.labels.first().map(|(place, _)| place.text().to_owned()).unwrap_or_default()))
        .collect()
}

/// Times that rise, with a point each.
fn points() -> impl Strategy<Value = Vec<(f64, [f64; 2])>> {
    let point = (0.1..5.0f64, -10.0..10.0f64, -10.0..10.0f64);
    prop::collection::vec(point, 2..8).prop_map(|steps| {
        let mut time = 0.0;
        let step = |(span, x, y)| {
            time += span;
            (time, [x, y])
        };
        steps.into_iter().map(step).collect()
    })
}

proptest! {
    #[test]
    fn goes_through_all_points_without_a_kink(points in points()) {
        let at = |time: f64| curve(&points, time).expect("points");
        for (time, point) in &points {
            let found = at(*time);
            prop_assert!((0..2).all(|i| (found[i] - point[i]).abs() < 1e-9), "{found:?}, {point:?}");
        }
        let step = 1e-6;
        for (time, _) in &points[1..points.len() - 1] {
            let (before, here, after) = (at(time - step), at(*time), at(time + step));
            for i in 0..2 {
                let (left, right) = ((here[i] - before[i]) / step, (after[i] - here[i]) / step);
                prop_assert!((left - right).abs() < 0.01 * left.abs().max(1.0), "{left}, {right}");
            }
        }
        let (first, last) = (points[0], points[points.len() - 1]);
        prop_assert_eq!(at(first.0 - 1.0), first.1);
        prop_assert_eq!(at(last.0 + 1.0), last.1);
    }

    /// Points of a parabola give that parabola, whatever their spacing.
    #[test]
    fn parabolas_are_exact(times in points(), a in -2.0..2.0f64, b in -2.0..2.0f64, part in 0.0..1.0f64) {
        prop_assume!(times.len() > 2);
        let parabola = |t: f64| [a * t * t + b * t + 1.0, 3.0 - b * t];
        let points: Vec<_> = times.iter().map(|(t, _)| (*t, parabola(*t))).collect();
        let at = points[0].0 + part * (points[points.len() - 1].0 - points[0].0);
        let (found, expected) = (curve(&points, at).expect("points"), parabola(at));
        prop_assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-6 * expected[i].abs().max(1.0)));
    }

    #[test]
    fn an_orbit_keeps_distance_height_and_what_is_seen(degrees in -720.0..720.0f64, frames in 1..50u32) {
        let bounds = Bounds { min: glam::Vec3::new(-1.0, 0.0, -1.0), max: glam::Vec3::new(2.0, 3.0, 1.0) };
        let (base, center) = (base(), DVec3::new(0.5, 1.5, 0.0));
        let cameras = orbit(&base, &bounds, degrees, frames);
        prop_assert_eq!(cameras.len(), frames as usize);
        let flat = |camera: &Camera| (camera.position - center) * DVec3::new(1.0, 0.0, 1.0);
        for (index, camera) in cameras.iter().enumerate() {
            prop_assert!((camera.position.y - 1.0).abs() < 1e-9);
            // The middle stays where it was in the picture.
            let seen = |c: &Camera| [c.right, c.up, c.forward].map(|axis| axis.dot(center - c.position));
            let (now, before) = (seen(camera), seen(&base));
            prop_assert!((0..3).all(|i| (now[i] - before[i]).abs() < 1e-9));
            let turned = degrees.to_radians() * index as f64 / f64::from(frames);
            let (start, here) = (flat(&base), flat(camera));
            let expected = DVec3::new(
                start.x * turned.cos() + start.z * turned.sin(),
                0.0,
                start.z * turned.cos() - start.x * turned.sin(),
            );
            prop_assert!((here - expected).length() < 1e-9);
        }
    }
}

#[test]
fn frames_are_those_of_the_run_and_times_are_stretched() {
    let by_frame = path(
        "Path(keys: [(frame: 2, eye: (0, 0, 0), look_at: (0, 0, -9)), (frame: 6, eye: (4, 0, 0), look_at: (4, 0, -9))])",
    );
    assert_eq!(by_frame.frames(), Some(7));
    let x = |path: &CameraPath, frames| -> Vec<f64> {
        path.cameras(&base(), frames).expect("cameras").iter().map(|c| c.position.x).collect()
    };
    assert_eq!(x(&by_frame, 9), [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0]);
    let by_time = path(
        "Path(keys: [(time: 10, eye: (0, 0, 0), look_at: (0, 0, -9)), (time: 20, eye: (4, 0, 0), look_at: (4, 0, -9))])",
    );
    assert_eq!(by_time.frames(), None);
    assert_eq!(x(&by_time, 5), [0.0, 1.0, 2.0, 3.0, 4.0]);
    assert_eq!(x(&by_time, 1), [0.0]);
}

/// From 20° to 120° evenly in the logarithm of the half angle's tangent; the scene's own angle where none is said.
#[test]
fn the_angle_of_view_changes_evenly() {
    let key = |at: u32, fov: &str| format!("(frame: {at}, eye: (0, 0, 0), look_at: (0, 0, -1){fov})");
    let text = format!("Path(keys: [{}, {}])", key(0, ", fov_degrees: 20"), key(2, ", fov_degrees: 120"));
    let cameras = path(&text).cameras(&base(), 3).expect("cameras");
    let degrees: Vec<f64> = cameras.iter().map(|c| fov(c).to_degrees()).collect();
    let middle = 2.0 * (10f64.to_radians().tan() * 60f64.to_radians().tan()).sqrt().atan().to_degrees();
    let expected = [20.0, middle, 120.0];
    assert!((0..3).all(|i| (degrees[i] - expected[i]).abs() < 1e-9), "{degrees:?}, {expected:?}");
    let plain = path(&format!("Path(keys: [{}, {}])", key(0, ""), key(2, "")));
    let found = fov(&plain.cameras(&base(), 3).expect("cameras")[1]);
    assert!((found - fov(&base())).abs() < 1e-12);
}

#[test]
fn mistakes_are_shown_where_they_are() {
    let good = "(frame: 5, eye: (0, 0, 0), look_at: (0, 0, -9))";
    let with = |key: &str| mistakes(&format!("Path(keys: [{good}, {key}])"));
    let later = |fields: &str| format!("(frame: 9, {fields})");
    assert_eq!(with(good), [("path-keys", good.to_owned())]);
    let key = "(time: 9, eye: (0, 0, 0), look_at: (0, 0, -9))";
    assert_eq!(with(key), [("path-keys", key.to_owned())]);
    for fields in [
        "eye: (0, 0, 0), look_at: (0, 0, 0)",
        "eye: (1e300, 0, 0), look_at: (0, 0, 0)",
        "eye: (0, 0, 0), look_at: (0, NaN, 0)",
        "eye: (0, 0, 0), look_at: (0, 0, 1), fov_degrees: 180",
        "time: 9, eye: (0, 0, 0), look_at: (0, 0, 1)",
    ] {
        let key = later(fields);
        assert_eq!(with(&key), [("path-value", key.clone())], "{fields}");
    }
    let neither = "(eye: (0, 0, 0), look_at: (0, 0, 1))";
    assert_eq!(with(neither), [("path-value", neither.to_owned())]);
    // serde's own mistakes are placed within the key.
    let [(code, at)] = &with("(frame: 9, eye: (0, 0, 0), lookat: (0, 0, 1))")[..] else {
        panic!("one mistake")
    };
    assert_eq!((*code, at.contains("lookat") || !at.is_empty()), ("path", true), "{at}");
    assert_eq!(mistakes(&format!("Path(keys: [{good}])"))[0].0, "path-keys");
    assert_eq!(mistakes("Path(").first().map(|m| m.0), Some("path"));
    // All of them at once.
    let two = format!("{}, {}", later("eye: (0, 0, 0), look_at: (0, 0, 0)"), neither);
    assert_eq!(with(&two).len(), 2);
}

/// Between its keys a curve can lead the eye into the point that it looks at.
#[test]
fn an_eye_that_meets_what_it_sees_is_refused() {
    let crossing = "Path(keys: [(frame: 0, eye: (0, 0, 0), look_at: (0, 0, 2)), (frame: 2, eye: (0, 0, 2), look_at: (0, 0, 0))])";
    let problem = path(crossing).cameras(&base(), 3).expect_err("they meet at frame 1");
    assert_eq!(problem.code, "path-value");
    assert!(problem.labels[0].0.text().starts_with("(frame: 0"));
}
