use crate::scene::{Bounds, Camera, Lens};
use glam::camera::rh;
use glam::{DVec3, Vec3, Vec4};
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;

fn close(a: Vec4, b: Vec4) -> bool {
    (a - b).abs().max_element() <= 1e-4 * (1.0 + b.abs().max_element())
}

#[test]
fn a_camera_by_hand() {
    let camera = Camera::looking("c", DVec3::new(1.0, 2.0, 3.0), -DVec3::Z, DVec3::Y).unwrap();
    let uniform =
        Camera { lens: Lens::Perspective { vertical_fov: FRAC_PI_2 }, near: 0.5, ..camera }.uniform(2.0);
    // From (1, 2, 3) the point is 4 to the right, 1 down, 8 ahead. A right angle makes the height 2 at distance 1, and
    // the width twice that.
    let clip = uniform.view_projection * Vec4::new(5.0, 1.0, -5.0, 1.0);
    assert_eq!(clip, Vec4::new(4.0 / 2.0, -1.0, 0.5, 8.0));
    assert_eq!((uniform.forward, uniform.near, uniform.aspect), (-Vec3::Z, 0.5, 2.0));
    assert!((uniform.right - Vec3::new(2.0, 0.0, 0.0)).length() < 1e-6);
    assert!((uniform.up - Vec3::Y).length() < 1e-6);
    // Depth is 1 at near and falls to 0.
    let depth = |distance: f32| {
        let clip = uniform.view_projection * Vec4::new(1.0, 2.0, 3.0 - distance, 1.0);
        clip.z / clip.w
    };
    assert_eq!(depth(0.5), 1.0);
    assert!(depth(1e6) > 0.0 && depth(1e6) < 1e-6);
}

#[test]
fn the_default_camera_sees_all_of_the_scene() {
    let bounds = Bounds { min: Vec3::new(-3.0, 0.0, 5.0), max: Vec3::new(4.0, 9.0, 6.0) };
    let uniform = Camera::framing(&bounds).uniform(1.0);
    for corner in bounds.corners() {
        let clip = uniform.view_projection * corner.as_vec3().extend(1.0);
        assert!(clip.x.abs() < clip.w && clip.y.abs() < clip.w && clip.z < clip.w, "{corner} {clip}");
    }
    let nothing = Camera::framing(&Bounds::default()).uniform(1.0);
    assert!(nothing.view_projection.is_finite() && nothing.inverse_view_projection.is_finite());
}

#[test]
fn a_camera_without_direction_is_none() {
    assert_eq!(Camera::looking("c", DVec3::ONE, DVec3::ZERO, DVec3::Y), None);
    // Straight up has no up of its own, but is a direction.
    let camera = Camera::looking("c", DVec3::ONE, DVec3::Y, DVec3::Y).unwrap();
    assert!(camera.up.dot(DVec3::Y).abs() < 1e-9 && (camera.up.length() - 1.0).abs() < 1e-9);
}

fn any_point(reach: f64) -> impl Strategy<Value = DVec3> {
    [-reach..reach, -reach..reach, -reach..reach].prop_map(DVec3::from)
}

proptest! {
    /// The matrices are glam's, and rays go where the matrices project.
    #[test]
    fn matrices_and_rays_agree(
        eye in any_point(10.0), to in any_point(10.0), fov in 0.2f64..2.8, aspect in 0.3f64..3.0,
        x in -1.0f32..1.0, y in -1.0f32..1.0, distance in 0.1f32..50.0,
    ) {
        prop_assume!((to - eye).length() > 0.1 && (to - eye).normalize().y.abs() < 0.99);
        let camera = Camera::looking("c", eye, to - eye, DVec3::Y).unwrap();
        let uniform = Camera { lens: Lens::Perspective { vertical_fov: fov }, near: 0.05, ..camera }.uniform(aspect);
        let view = rh::view::look_at_mat4(eye.as_vec3(), to.as_vec3(), Vec3::Y);
        let lens = rh::proj::directx::perspective_infinite_reverse(fov as f32, aspect as f32, 0.05);
        let point = uniform.position + (uniform.forward + x * uniform.right + y * uniform.up) * distance;
        let clip = uniform.view_projection * point.extend(1.0);
        prop_assert!(close(clip, lens * view * point.extend(1.0)));
        prop_assert!((clip.x / clip.w - x).abs() < 2e-3 && (clip.y / clip.w - y).abs() < 2e-3);
        let back = uniform.inverse_view_projection * clip;
        prop_assert!((back.truncate() / back.w - point).length() < 1e-2 * (1.0 + distance));
    }
}

/// Against glam's own orthographic projection, reversed: near and far change places.
#[test]
fn an_orthographic_camera() {
    let looking =
        Camera::looking("c", DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, -2.0, 0.5), DVec3::Y).unwrap();
    let lens = Lens::Orthographic { half_height: 2.0, far: 50.0 };
    let camera = Camera { lens, near: 0.5, ..looking };
    let uniform = camera.uniform(1.5);
    let view =
        rh::view::look_to_mat4(camera.position.as_vec3(), camera.forward.as_vec3(), camera.up.as_vec3());
    let projection = rh::proj::directx::orthographic(-3.0, 3.0, -2.0, 2.0, 50.0, 0.5);
    for point in [Vec3::ZERO, Vec3::new(3.0, -4.0, 5.0), Vec3::new(9.0, -12.0, 6.0)] {
        let (ours, theirs) =
            (uniform.view_projection * point.extend(1.0), projection * view * point.extend(1.0));
        assert!(close(ours, theirs), "{ours} {theirs}");
        // The distance that kernels find from the depth, and the ray that goes there.
        let c = uniform.distance;
        let distance = (c.x + c.y * ours.z) / (c.z + c.w * ours.z);
        let aside = ours.x * uniform.right + ours.y * uniform.up;
        let found = uniform.position + uniform.parallel * aside + distance * uniform.forward;
        assert!((found - point).length() < 1e-3, "{found} {point}");
    }
}
