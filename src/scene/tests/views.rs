use crate::scene::layout::{Light, View};
use crate::scene::views::{NEAREST, fit};
use crate::scene::{Bounds, lights};
use glam::{DVec3, Vec3};
use proptest::prelude::*;

fn any_point(reach: f64) -> impl Strategy<Value = DVec3> {
    [-reach..reach, -reach..reach, -reach..reach].prop_map(DVec3::from)
}

/// Boxes of all proportions, flat ones and single points among them, not about the origin.
fn any_bounds() -> impl Strategy<Value = Bounds> {
    let side = prop_oneof![Just(0.0), 0.01..30.0];
    (any_point(20.0), [side.clone(), side.clone(), side])
        .prop_map(|(min, size)| Bounds { min: min.as_vec3(), max: (min + DVec3::from(size)).as_vec3() })
}

/// A point of the box, from three numbers of 0..1.
fn within(bounds: &Bounds, t: [f32; 3]) -> Vec3 {
    bounds.min + (bounds.max - bounds.min) * Vec3::from(t)
}

fn inside() -> impl Strategy<Value = [f32; 3]> {
    [0.0f32..1.0, 0.0f32..1.0, 0.0f32..1.0]
}

fn make(light: Result<Light, String>, bounds: &Bounds) -> Vec<View> {
    let mut lights = [light.unwrap()];
    let views = fit(&mut lights, bounds);
    assert_eq!((lights[0].first_view, lights[0].view_count as usize), (0, views.len()));
    views
}

/// Whether the view shows the point, and its depth there.
fn depth(view: &View, point: Vec3) -> Option<f32> {
    let clip = view.view_projection * point.extend(1.0);
    (clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w).then(|| clip.z / clip.w)
}

#[test]
fn views_are_numbered_through_all_lights() {
    let bounds = Bounds { min: Vec3::ZERO, max: Vec3::ONE };
    let mut list = [
        lights::directional(DVec3::NEG_Y, Vec3::ONE).unwrap(),
        lights::point(DVec3::ONE, Vec3::ONE).unwrap(),
        lights::spot(DVec3::ONE, DVec3::NEG_Y, Vec3::ONE, 0.1, 0.5).unwrap(),
    ];
    let views = fit(&mut list, &bounds);
    let ranges: Vec<_> = list.iter().map(|light| (light.first_view, light.view_count)).collect();
    assert_eq!(ranges, [(0, 1), (1, 6), (7, 1)]);
    let owners: Vec<_> = views.iter().map(|view| (view.light, view.face)).collect();
    assert_eq!(owners, [(0, 0), (1, 0), (1, 1), (1, 2), (1, 3), (1, 4), (1, 5), (2, 0)]);
    let faces: Vec<_> = views[1..7].iter().map(|view| view.direction).collect();
    assert_eq!(faces, [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z]);
    // A right angle is 2 wide at distance 1; a cone of half angle 0.5 is 2 tan 0.5.
    assert!((views[1].texel - 2.0).abs() < 1e-6);
    assert!((views[7].texel - 2.0 * 0.5f32.tan()).abs() < 1e-5);
}

#[test]
fn a_view_from_above_by_hand() {
    let bounds = Bounds { min: Vec3::new(0.0, 0.0, 0.0), max: Vec3::new(4.0, 2.0, 8.0) };
    let [view] = make(lights::directional(DVec3::NEG_Y, Vec3::ONE), &bounds)[..] else { panic!("one view") };
    assert!((view.texel - 8.0).abs() < 0.02, "{}", view.texel);
    assert!((view.far - 2.0).abs() < 0.02 && view.near == 0.0);
    let top = depth(&view, Vec3::new(1.0, 2.0, 1.0)).unwrap();
    let floor = depth(&view, Vec3::new(1.0, 0.0, 1.0)).unwrap();
    assert!((top - 1.0).abs() < 2e-3 && floor.abs() < 2e-3, "{top} {floor}");
    // Nothing outside by more than the margin is shown.
    assert_eq!(depth(&view, Vec3::new(-0.1, 1.0, 1.0)), None);
    assert_eq!(depth(&view, Vec3::new(1.0, 1.0, 8.1)), None);
}

proptest! {
    /// Wherever the light stands: each point of the scene lies in one face, within its depth.
    #[test]
    fn six_faces_divide_the_scene(bounds in any_bounds(), at in any_point(40.0), t in inside()) {
        let views = make(lights::point(at, Vec3::ONE), &bounds);
        prop_assert_eq!(views.len(), 6);
        let point = within(&bounds, t);
        let offset = (point - at.as_vec3()).abs();
        let mut sorted = offset.to_array();
        sorted.sort_by(f32::total_cmp);
        // On the border of two faces, and within the nearest distance, either answer is right.
        prop_assume!(sorted[2] - sorted[1] > 1e-3 * sorted[2]);
        prop_assume!(f64::from(sorted[2]) > 2.0 * NEAREST * (bounds.diagonal() + 1e-2));
        let shown: Vec<_> = views.iter().filter_map(|view| Some((view, depth(view, point)?))).collect();
        prop_assert_eq!(shown.len(), 1, "{} from {}", point, at);
        let (view, depth) = shown[0];
        prop_assert!((0.0..=1.0).contains(&depth), "depth {} in {:?}", depth, view);
        prop_assert!((point - at.as_vec3()).normalize().dot(view.direction) > 0.57);
    }

    /// What a spot light reaches, its view shows.
    #[test]
    fn a_spot_view_holds_its_cone(
        bounds in any_bounds(), at in any_point(40.0), to in any_point(20.0), outer in 0.02f64..1.48, t in inside(),
    ) {
        prop_assume!(at.distance(to) > 0.1);
        let light = lights::spot(at, to - at, Vec3::ONE, 0.0, outer).unwrap();
        let view = make(Ok(light), &bounds)[0];
        let point = within(&bounds, t);
        let toward = point - light.position;
        prop_assume!(toward.dot(light.direction) > 2.0 * NEAREST as f32 * (bounds.diagonal() as f32 + 1e-2));
        prop_assume!(toward.normalize().dot(light.direction) > (outer as f32 - 1e-3).cos());
        let depth = depth(&view, point);
        prop_assert!(depth.is_some_and(|depth| (0.0..=1.0).contains(&depth)), "{:?} in {:?}", depth, view);
    }

    /// A directional view shows the whole scene, and hardly more.
    #[test]
    fn a_directional_view_fits(bounds in any_bounds(), direction in any_point(1.0), t in inside()) {
        prop_assume!(direction.length() > 1e-3);
        let view = make(lights::directional(direction, Vec3::ONE), &bounds)[0];
        let shown = depth(&view, within(&bounds, t));
        prop_assert!(shown.is_some_and(|depth| (0.0..=1.0).contains(&depth)), "{:?}", shown);
        let corners = bounds.corners().map(|corner| view.view_projection * corner.as_vec3().extend(1.0));
        let widest = corners.iter().fold(0.0, |widest: f32, clip| widest.max(clip.x.abs()).max(clip.y.abs()));
        prop_assert!(widest <= 1.0);
        prop_assert!(widest > 0.99 || bounds.diagonal() < 0.1, "only {} of the view is used", widest);
    }

    /// Depth is 1 at near, 0 at far, and falls between.
    #[test]
    fn depth_is_reversed(bounds in any_bounds(), at in any_point(40.0), a in 0.0f32..1.0, b in 0.0f32..1.0) {
        let mut views = make(lights::point(at, Vec3::ONE), &bounds);
        views.extend(make(lights::directional(at, Vec3::ONE), &bounds));
        // Positions are only known to their rounding, which must be small beside what is looked at.
        let rounding = 1e-6 * (1.0 + at.length() as f32 + bounds.max.abs().max(bounds.min.abs()).max_element());
        for view in &views {
            let at = |t: f32| {
                let distance = view.near + (view.far - view.near) * t;
                depth(view, view.position + view.direction * distance)
            };
            if (view.near > 0.0 && view.near < 100.0 * rounding) || view.far - view.near < 100.0 * rounding {
                continue;
            }
            let (near, far) = (at(0.0).unwrap(), at(1.0).unwrap());
            prop_assert!((near - 1.0).abs() < 0.02 && far.abs() < 0.02, "{} {} {:?}", near, far, view);
            if b - a > 0.05 {
                prop_assert!(at(a).unwrap() > at(b).unwrap());
            }
        }
    }

    /// No light and no scene makes a matrix with a NaN or an infinity.
    #[test]
    fn matrices_are_finite(bounds in any_bounds(), at in any_point(1e4), direction in any_point(1.0)) {
        prop_assume!(direction.length() > 1e-6);
        let mut list = [
            lights::point(at, Vec3::ONE).unwrap(),
            lights::point(bounds.center(), Vec3::ONE).unwrap(),
            lights::spot(at, direction, Vec3::ONE, 0.0, std::f64::consts::FRAC_PI_2).unwrap(),
            lights::directional(direction, Vec3::ONE).unwrap(),
            lights::directional(DVec3::NEG_Y, Vec3::ONE).unwrap(),
        ];
        for view in fit(&mut list, &bounds) {
            prop_assert!(view.view_projection.is_finite(), "{:?}", view);
            prop_assert!(view.far > view.near && view.near >= 0.0 && view.texel > 0.0, "{:?}", view);
        }
    }
}
