//! Loops over what there is: ranges, lights, views, mips; and rounds that change names.

use crate::abilities::{Refused, Verdict, Wrong, same, show};
use crate::bench::{Job, Run, scene};
use voxgi::scene::layout::{DIRECTIONAL, Light, POINT, SPOT};
use voxgi::scene::{Scene, views};

/// The Cornell box with a spot light, its point light and a directional one, in this order.
fn three_lights() -> Scene {
    let mut scene = scene("cornell-point");
    let point = Light { kind: POINT, ..scene.lights[0] };
    let spot = Light { kind: SPOT, direction: glam::Vec3::NEG_Y, cos_outer: 0.7, cos_inner: 0.8, ..point };
    let sun = Light { kind: DIRECTIONAL, direction: glam::Vec3::new(0.6, -0.8, 0.0), ..point };
    scene.lights = vec![spot, point, sun];
    scene.views = views::fit(&mut scene.lights, &scene.bounds);
    assert_eq!(scene.views.len(), 8);
    scene
}

/// Each stage appends its index as a decimal digit, so that order shows as well as number.
fn digits(run: &mut Run<'_>, expected: &[u32]) -> Verdict {
    run.frames(1).map_err(|p| format!("{p:?}"))?;
    same(run.words("shown"), expected.to_vec())
}

#[test]
fn loops_over_ranges_in_each_other() {
    let scene = scene("cornell-point");
    let wrong = [
        Wrong("Range(\"2\", \"4\")", "Range(\"1\", \"3\")"),
        Wrong("Range(\"0\", \"2\")", "Range(\"1\", \"2\")"),
    ];
    show(&Job::new(&scene, "ranges", [1, 1]), |run| digits(run, &[2233, 101]), &wrong);
}

#[test]
fn loops_over_lights_of_a_kind() {
    let scene = three_lights();
    let wrong =
        [Wrong("Lights(\"all\")", "Lights(\"point\")"), Wrong("Lights(\"directional\")", "Lights(\"spot\")")];
    show(&Job::new(&scene, "lights", [1, 1]), |run| digits(run, &[102, 2]), &wrong);
}

/// Each view's own numbers reach its stage.
#[test]
fn loops_over_views() {
    let scene = three_lights();
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        let expected: Vec<f32> = scene.views.iter().flat_map(|view| [view.near, view.far]).collect();
        same(run.floats("shown"), expected)
    };
    let refused = [Refused("over: Views", "over: Range(\"0\", \"8\")", "unknown-field")];
    show(&Job::new(&scene, "views", [1, 1]), oracle, &refused);
}

#[test]
fn loops_over_mips() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        for mip in 0..4 {
            let image = run.image(&format!("chain@mip{mip}"));
            same([image.width, image.height], [8 >> mip, (6 >> mip).max(1)])?;
            same(image.data, vec![mip as f32 + 1.0; image.width as usize * image.height as usize])?;
        }
        Ok(())
    };
    show(&Job::new(&scene, "mips", [8, 6]), oracle, &[Wrong("@mip(level)", "@mip0")]);
}

/// A chain of means: each mip is written from the one before.
#[test]
fn mips_from_mips() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        for mip in 0..4u32 {
            let (size, texel) = (8 >> mip, f32::from(1u16 << mip));
            let centre = |i: u32| i as f32 * texel + (texel - 1.0) / 2.0;
            let expected: Vec<f32> = (0..size)
                .flat_map(|y| (0..size).flat_map(move |x| [centre(x), centre(y), 0.0, 1.0]))
                .collect();
            same(run.image(&format!("chain@mip{mip}")).data, expected)?;
        }
        Ok(())
    };
    let wrong = [Wrong("\"chain@mip(level)\"", "\"chain@mip0\""), Wrong("chain.mips - 1", "chain.mips - 2")];
    show(&Job::new(&scene, "mip_chain", [8, 8]), oracle, &wrong);
}

#[test]
fn layers_of_an_array() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(run.image("color").data, [1.0, 2.0, 7.0, 1.0].repeat(6))
    };
    show(&Job::new(&scene, "layers", [3, 2]), oracle, &[Wrong("@layer(level)", "@layer0")]);
}

/// Diffusion on a torus, in quarters of whole numbers, which floats hold exactly.
fn diffused(rounds: usize, [width, height]: [usize; 2]) -> Vec<f32> {
    let mut now: Vec<f32> = (0..width * height).map(|i| ((i % width) * (i / width)) as f32).collect();
    for _ in 0..rounds {
        let at = |x: usize, y: usize| now[(y % height) * width + x % width];
        now = (0..width * height)
            .map(|i| (i % width, i / width))
            .map(|(x, y)| 0.25 * (at(x + 1, y) + at(x + width - 1, y) + at(x, y + 1) + at(x, y + height - 1)))
            .collect();
    }
    now
}

#[test]
fn rounds_that_change_names() {
    let scene = scene("cornell-point");
    for rounds in [0, 1, 4, 5] {
        let oracle = |run: &mut Run<'_>| {
            run.frames(1).map_err(|p| format!("{p:?}"))?;
            let name = run.frame.graph.plan.outputs[0].1;
            let image = run.frame.read(run.gpu, &name).map_err(|p| p.message)?;
            same(image.data, diffused(rounds, [6, 5]))
        };
        let wrong =
            [Wrong("swap: [(\"heat\", \"next\")],", ""), Wrong("times: \"rounds\"", "times: \"rounds + 1\"")];
        let job = Job::new(&scene, "diffusion", [6, 5]).set("rounds", &rounds.to_string());
        show(&job, oracle, if rounds > 1 { &wrong } else { &wrong[1..] });
    }
}
