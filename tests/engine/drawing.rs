//! Raster stages: what they draw, depth, blending.

use crate::abilities::{Wrong, same, show};
use crate::bench::{Job, Run, scene};
use glam::{DMat3, DVec3};
use voxgi::scene::Scene;

/// The whole numbers of a picture with one channel.
fn shades(run: &Run<'_>) -> Vec<u32> {
    run.image("shade").data.into_iter().map(|x| x as u32).collect()
}

/// Each texel is written once, and twice where a second draw is added.
#[test]
fn the_whole_screen_and_blending() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        let expected: Vec<f32> = (0..5)
            .flat_map(|y| (0..9).flat_map(move |x| [2.0 * x as f32 + 1.0, 2.0 * y as f32 + 1.0, 2.0, 2.0]))
            .collect();
        same(run.image("color").data, expected)
    };
    show(&Job::new(&scene, "screen", [9, 5]), oracle, &[Wrong("blend: Add", "blend: Max")]);
}

/// Of two quads that overlap the nearer one is seen, though it is drawn first.
#[test]
fn depth_is_tested_and_written() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(shades(run), [1, 1, 1, 1, 1, 1, 2, 2].repeat(4))
    };
    let wrong = [
        Wrong("compare: Greater", "compare: Always"),
        Wrong("write: true", "write: false"),
        Wrong("(\"12\")", "(\"6\")"),
    ];
    show(&Job::new(&scene, "depth", [8, 4]), oracle, &wrong);
}

#[test]
fn as_many_vertices_as_a_kernel_says() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(shades(run), [1, 1, 1, 1, 1, 1, 0, 0].repeat(4))
    };
    show(&Job::new(&scene, "drawn_indirectly", [8, 4]), oracle, &[Wrong("offset: 1", "offset: 0")]);
}

/// Points whose places and shades vertices pull from a buffer that a kernel wrote.
#[test]
fn points_from_a_buffer() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(shades(run), vec![1, 4, 7, 10, 13, 0, 0, 0])
    };
    show(&Job::new(&scene, "points", [8, 1]), oracle, &[Wrong("Points(\"5\")", "Points(\"4\")")]);
}

/// In each pixel the number of the triangle that a ray through its centre meets first.
#[test]
fn the_scene_as_rays_see_it() {
    let scene = scene("cornell-point");
    let [width, height] = [24u32, 16];
    let seen: Vec<u32> = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let across = (f64::from(x) + 0.5) / f64::from(width) * 2.0 - 1.0;
            let down = (f64::from(y) + 0.5) / f64::from(height) * 2.0 - 1.0;
            first_hit(&scene, across, -down, f64::from(width) / f64::from(height))
        })
        .collect();
    assert!(seen.contains(&0) && seen.iter().filter(|n| **n > 0).count() > 100);
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        let wrong = shades(run).iter().zip(&seen).filter(|(a, b)| a != b).count();
        // A centre may lie on an edge, which two triangles share.
        if wrong <= 4 { Ok(()) } else { Err(format!("{wrong} pixels show another triangle")) }
    };
    let wrong =
        [Wrong("draw: Scene", "draw: Vertices(\"30\")"), Wrong("compare: Greater", "compare: Always")];
    show(&Job::new(&scene, "scene", [width, height]), oracle, &wrong);
}

/// The number of the nearest triangle on the ray through a point of [−1, 1]², from 1; 0 for none.
fn first_hit(scene: &Scene, x: f64, y: f64, aspect: f64) -> u32 {
    let camera = &scene.cameras[0];
    let tan = camera.lens.half_height();
    let direction = camera.forward + x * tan * aspect * camera.right + y * tan * camera.up;
    let mut nearest = (f64::INFINITY, 0);
    for (number, triangle) in (1..).zip(&scene.triangles) {
        let world = &scene.instances[triangle.instance as usize].to_world;
        let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|vertex| {
            let p = scene.vertices[vertex as usize].position;
            let place = world[0] * p.x + world[1] * p.y + world[2] * p.z + world[3];
            place.truncate().as_dvec3() - camera.position
        });
        let system = DMat3::from_cols(direction, a - b, a - c);
        let at: DVec3 = system.inverse() * a;
        let inside = at.y >= 0.0 && at.z >= 0.0 && at.y + at.z <= 1.0;
        if system.determinant() != 0.0 && inside && at.x > 0.0 && at.x < nearest.0 {
            nearest = (at.x, number);
        }
    }
    nearest.1
}
