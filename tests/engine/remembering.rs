//! What lives from frame to frame, what resets it, and what need not run again.

use crate::abilities::{Wrong, same, show};
use crate::bench::{Job, Run, differences, gpu, scene, shipped};
use voxgi::document::Cause;
use voxgi::record::{self, Samples};

/// 100, and then the number of each frame from 1; the camera's change starts again.
#[test]
fn sums_over_frames_until_a_reset() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        let none = |run: &mut Run<'_>| run.frame_after(&[]).map_err(|p| format!("{p:?}"));
        (0..3).try_for_each(|_| none(run))?;
        same(run.words("shown"), vec![100 + 1 + 2 + 3])?;
        run.frame_after(&[Cause::Lights]).map_err(|p| format!("{p:?}"))?;
        same(run.words("shown"), vec![100 + 1 + 2 + 3 + 4])?;
        run.frame_after(&[Cause::Camera]).map_err(|p| format!("{p:?}"))?;
        same(run.words("shown"), vec![100 + 5])?;
        run.frame.reset();
        (0..2).try_for_each(|_| none(run))?;
        same(run.words("shown"), vec![100 + 1 + 2])
    };
    let wrong = [
        Wrong("Kept(value: 100, reset: [Camera])", "Fill(100)"),
        Wrong("value: 100", "value: 0"),
        Wrong("reset: [Camera]", "reset: [Lights]"),
    ];
    show(&Job::new(&scene, "accumulated", [1, 1]), oracle, &wrong);
}

/// Fibonacci's numbers: each frame reads what the one before wrote, in the other slot.
#[test]
fn histories_change_places_each_frame() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        for expected in [[2, 1], [3, 2], [5, 3], [8, 5], [13, 8]] {
            run.frames(1).map_err(|p| format!("{p:?}"))?;
            same(run.words("shown"), expected.to_vec())?;
            same(run.image("picture").data, vec![expected[0] as f32; 4])?;
        }
        run.frame.reset();
        run.frames(2).map_err(|p| format!("{p:?}"))?;
        same(run.words("shown"), vec![3, 2])
    };
    let wrong = [
        Wrong("\"series@previous\"", "\"ones\""),
        Wrong("\"picture@previous\"", "\"one\""),
        Wrong("Kept(value: 1, reset: [])", "Kept(value: 2, reset: [])"),
    ];
    show(&Job::new(&scene, "history", [2, 2]), oracle, &wrong);
}

/// Only the camera moves: what does not depend on it is kept, and that does not show.
#[test]
fn still_voxels_are_kept_under_a_moving_camera() {
    let scene = scene("cornell-box");
    for pipeline in shipped() {
        let job = Job::new(&scene, &pipeline, [32, 32]).small("16", "16");
        if job.adds_up() {
            continue; // Every frame is another.
        }
        let kept = job.clone().keep(&[Cause::Camera]);
        let mut run = kept.start(gpu()).expect("a run");
        let mut samples = Samples::default();
        for _ in 0..3 {
            samples.frames.push(run.frame.run(run.gpu, &run.changes).expect("a frame").clone());
        }
        let found = differences(&job.outputs(gpu(), 3), &run.outputs());
        assert!(found.is_empty(), "{pipeline}: {found:?}");

        let stages = record::stages(&run.frame, &samples);
        let with = |word: &str| {
            // A grid has an odd or an even number of mip levels, and no stages for the other.
            stages.iter().filter(|s| s.path.contains(word) && s.status != "dropped").collect::<Vec<_>>()
        };
        let still: Vec<_> = ["voxelize/", "storage/", "light/", "mipmap_reflected/"].map(with).concat();
        assert!(!still.is_empty(), "{pipeline}");
        for stage in still {
            let reason = stage.reason.as_deref().unwrap_or_default();
            assert_eq!(stage.status, "kept", "{pipeline}: {}", stage.path);
            assert!(reason.contains("change"), "{pipeline}: {}: {reason}", stage.path);
            assert!(stage.samples_ms[0].is_some() && stage.samples_ms[1..] == [None, None], "{stage:?}");
        }
        // The control: what looks through the camera runs in each frame.
        let seen = stages.iter().filter(|s| s.status == "run").map(|s| s.path.as_str()).collect::<Vec<_>>();
        assert!(seen.iter().any(|path| path.starts_with("display/")), "{pipeline}: {seen:?}");
        assert!(stages.iter().all(|s| s.status != "dropped" || s.reason.is_some()));
    }
}
