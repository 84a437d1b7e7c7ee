//! Compute stages: over texels, counts, and counts that a kernel wrote; what they can write into, and how that begins.

use crate::abilities::{Refused, Verdict, Wrong, same, show};
use crate::bench::{Job, Run, scene};

#[test]
fn one_thread_for_each_texel() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        let grid = run.image("grid");
        same([grid.width, grid.height], [13, 7])?;
        let expected: Vec<f32> =
            (0..7).flat_map(|y| (0..13).flat_map(move |x| [x as f32, y as f32, 0.0, 1.0])).collect();
        same(grid.data, expected)
    };
    show(
        &Job::new(&scene, "texels", [13, 7]),
        oracle,
        &[
            Wrong("Texels(\"grid\")", "Count(\"8\", \"7\")"),
            Refused("\"grid\")", "\"gird\")", "unknown-resource"),
        ],
    );
}

/// More workgroups than one dimension takes are folded into rows.
#[test]
fn more_threads_than_one_dimension_takes() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        let numbers = run.words("shown");
        same(numbers.len(), 70_200)?;
        same((0..).zip(&numbers).find(|(i, number)| **number != 3 * i + 1), None)
    };
    show(&Job::new(&scene, "many", [1, 1]), oracle, &[Wrong("Count(\"70200\")", "Count(\"65535\")")]);
}

#[test]
fn as_many_workgroups_as_a_kernel_says() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(run.words("shown"), vec![1, 1, 1, 1, 1, 0, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0])
    };
    show(&Job::new(&scene, "indirect", [1, 1]), oracle, &[Wrong("offset: 1", "offset: 0")]);
}

#[test]
fn counters_are_in_the_record_and_keep_nothing_alive() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(2).map_err(|p| format!("{p:?}"))?;
        let counters = run.frame.counters(run.gpu).map_err(|p| p.message)?;
        let of = |stage: &str| -> Vec<(String, u32)> {
            counters.iter().filter(|(name, _)| name.starts_with(stage)).cloned().collect()
        };
        // Cleared before each frame: the second one does not go on counting.
        same(of("used"), vec![("used.evens".to_owned(), 50), ("used.all".to_owned(), 100)])
    };
    let job = Job::new(&scene, "counters", [1, 1]);
    show(&job, oracle, &[Wrong("Count(\"100\")", "Count(\"99\")")]);
    let prepared = job.prepare().expect("a schedule");
    let dropped: Vec<&str> = (prepared.graph.stages.iter().zip(&prepared.schedule.fates))
        .filter(|(_, fate)| matches!(fate, voxgi::schedule::Fate::Dropped(_)))
        .map(|(stage, _)| stage.path.as_str())
        .collect();
    assert_eq!(dropped, ["unused"]);
}

/// Every sort of resource, 0 and other values: what `fills` copies from the far end of each.
#[test]
fn resources_begin_with_what_they_are_filled_with() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        // Twice: what the frame before left must not show.
        run.frames(2).map_err(|p| format!("{p:?}"))?;
        let half = 128.0 / 255.0;
        same(run.floats("shown"), vec![0.0, half, 0.25, 0.0, 3.0, 0.625, 7.0, 0.75, 0.0, 0.125])
    };
    let wrong = [
        Wrong("Fill(0.5)", "Fill(0)"),
        Wrong("Fill(0.25)", "Fill(0.5)"),
        Wrong("Fill(3)", "Fill(4)"),
        Wrong("Fill(0.625)", "Fill(1)"),
        Wrong("Fill(7)", "Fill(8)"),
        Wrong("Fill(0.75)", "Fill(0)"),
        Wrong("Fill(0.125)", "Fill(0)"),
    ];
    show(&Job::new(&scene, "fills", [5, 5]), oracle, &wrong);
}

/// A knob reaches kernels as a uniform, as an override and as a condition.
#[test]
fn knobs_as_uniforms_overrides_and_conditions() {
    let scene = scene("cornell-point");
    fn oracle(run: &mut Run<'_>, threads: usize, value: f32) -> Verdict {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        let expected: Vec<f32> = (0..16).map(|i| if i < threads { value } else { 0.0 }).collect();
        same(run.floats("shown"), expected)
    }
    let job = Job::new(&scene, "knobs", [1, 1]);
    let wrong = [
        Wrong("default: 1.5", "default: 2.5"),
        Wrong("default: 8", "default: 4"),
        Wrong("default: \"red\"", "default: \"blue\""),
        Wrong("default: false", "default: true"),
        Refused("default: 8", "default: 5", "knob-out-of-range"),
    ];
    show(&job, |run| oracle(run, 8, 1.5), &wrong);
    let set = job.set("scale", "0.5").set("group", "4").set("mode", "blue").set("raised", "true");
    show(&set, |run| oracle(run, 4, 101.0), &[]);
}

/// The kernel declares rgba8unorm; the texture's format is what a knob says.
#[test]
fn formats_follow_a_knob() {
    let scene = scene("cornell-point");
    let third = 1.0f32 / 3.0;
    let formats: [(&str, [f32; 4]); 3] = [
        ("rgba8unorm", [85.0 / 255.0, 181.0 / 255.0, 1.0, 0.0]),
        ("rgba16float", [third, 0.71, 1.5, -2.0].map(|x| half::f16::from_f32(x).to_f32())),
        ("rgba32float", [third, 0.71, 1.5, -2.0]),
    ];
    for (format, expected) in formats {
        let oracle = |run: &mut Run<'_>| {
            run.frames(1).map_err(|p| format!("{p:?}"))?;
            let rounded = |x: f32| if format == "rgba8unorm" { (x * 255.0).round() } else { x };
            let found: Vec<f32> = run.image("copy").data.into_iter().map(rounded).collect();
            same(found, expected.map(rounded).to_vec())
        };
        let wrong = [Wrong("format: \"precision\"", "format: \"rgba8snorm\"")];
        show(&Job::new(&scene, "format", [1, 1]).set("precision", format), oracle, &wrong);
    }
}
