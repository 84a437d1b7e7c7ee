//! Scenes that move: stages over still or moving triangles, and that only what changed is done again.

use crate::abilities::{Refused, Wrong, same, show};
use crate::bench::{Job, Run, differences, gpu, moving_scene, scene};
use std::collections::BTreeSet;
use voxgi::document::Cause;
use voxgi::frame::Changes;
use voxgi::graph::facts::bit;
use voxgi::play::{self, Play};
use voxgi::scene::Scene;

/// The box has 38 triangles, the block that moves ten of them.
#[test]
fn stages_go_over_still_or_moving_triangles() {
    let scene = moving_scene();
    let block: BTreeSet<u32> = (29..=38).collect();
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(run.words("shown"), [vec![28 + 38; 28], vec![10 + 38; 10]].concat())?;
        let seen: BTreeSet<u32> = run.image("shade").data.into_iter().map(|x| x as u32).collect();
        let only_the_block = seen.iter().all(|number| *number == 0 || block.contains(number));
        if only_the_block && seen.len() > 2 { Ok(()) } else { Err(format!("seen are {seen:?}")) }
    };
    let mutations = [
        Wrong("over: Triangles, geometry: Still", "over: Triangles, geometry: Moving"),
        Wrong("over: Triangles, geometry: Moving", "over: Triangles"),
        Wrong("draw: Scene, geometry: Moving", "draw: Scene"),
        Refused("draw: Scene, geometry: Moving", "draw: Scene, geometry: Slow", "unknown-variant"),
    ];
    show(&Job::new(&scene, "still_and_moving", [32, 32]), oracle, &mutations);
}

/// Without anything that moves, stages over moving triangles are left out, and say why.
#[test]
fn nothing_moves_in_a_still_scene() {
    let scene = scene("cornell-point");
    let prepared = Job::new(&scene, "still_and_moving", [8, 8]).prepare().expect("a graph");
    let reason = |path: &str| {
        let index = prepared.graph.stages.iter().position(|s| s.path == path).expect("the stage");
        match &prepared.schedule.fates[index] {
            voxgi::schedule::Fate::Dropped(reason) => Some(reason.clone()),
            voxgi::schedule::Fate::Run { .. } => None,
        }
    };
    assert_eq!(reason("moving").as_deref(), Some("the scene has no moving triangles"));
    assert_eq!((reason("still"), reason("all")), (None, None));
    let moves = bit(Cause::Moving);
    assert!(prepared.depends.iter().all(|bits| !bits.contains(&moves)), "nothing waits for motion");
}

/// What is told of one frame: the stages that ran.
type Ran = BTreeSet<String>;

fn ran(run: &Run<'_>) -> Ran {
    let graph = &run.frame.graph;
    let steps = run.frame.schedule.steps.iter().zip(run.frame.done());
    let tasks = steps.filter(|(_, done)| **done).filter_map(|(step, _)| match step {
        voxgi::schedule::Step::Run { task, .. } => Some(graph.stages[*task].path.clone()),
        voxgi::schedule::Step::Start { .. } => None,
    });
    tasks.collect()
}

fn small<'a>(scene: &'a Scene) -> Job<'a> {
    Job::new(scene, "cones", [24, 24]).set("resolution", "16").set("light_map_size", "64").set("bounces", "2")
}

/// Sixty frames in which a block and a light move, only what changed against everything anew: the same bits in each.
#[test]
fn sixty_frames_of_a_moving_scene() {
    let scene = moving_scene();
    let mut kept = small(&scene);
    (kept.request.keep, kept.request.varying) = (true, play::varies(&scene, 0));
    let all = small(&scene);
    let (mut kept, mut all) = (kept.start(gpu()).expect("a run"), all.start(gpu()).expect("a run"));
    let mut plays = [&kept, &all].map(|run| Play::new(scene.clone(), 0, [24, 24], &run.frame));
    let mut still_ran = 0;
    let mut pictures = BTreeSet::new();
    for frame in 0..60 {
        let time = f64::from(frame) / 15.0;
        let changed = plays[0].go_to(&mut kept.frame, gpu(), time).expect("a pose");
        plays[1].go_to(&mut all.frame, gpu(), time).expect("a pose");
        kept.frame.run(gpu(), &Changes::Only(changed)).expect("a frame");
        all.frame.run(gpu(), &Changes::All).expect("a frame");
        let found = differences(&all.outputs(), &kept.outputs());
        assert!(found.is_empty(), "frame {frame}: {found:?}");
        still_ran += usize::from(ran(&kept).contains("voxelize/still"));
        pictures.insert(kept.outputs()["display@mip0@layer0"].clone());
    }
    assert_eq!(still_ran, 1, "what is still is voxelized once");
    assert!(pictures.len() > 50, "the pictures differ: {}", pictures.len());
}

/// Of what moves, only what depends on it runs: a light, a block, or nothing at all.
#[test]
fn only_what_changed_runs() {
    let scene = moving_scene();
    let mut job = small(&scene);
    (job.request.keep, job.request.varying) =
        (true, [Cause::Moving, Cause::Lights, Cause::Camera].map(bit).into());
    let mut run = job.start(gpu()).expect("a run");
    run.frames(1).expect("a frame");
    let whole = ran(&run);
    let mut after = |cause: &[Cause]| {
        run.frame_after(cause).expect("a frame");
        ran(&run)
    };
    let with = |ran: &Ran, start: &str| ran.iter().any(|path| path.starts_with(start));
    assert!(after(&[]).is_empty());
    let light = after(&[Cause::Lights]);
    assert!(!with(&light, "voxelize/") && !with(&light, "storage/") && !with(&light, "surfaces/"));
    assert!(with(&light, "light_maps/") && with(&light, "light/") && with(&light, "trace/"));
    let block = after(&[Cause::Moving]);
    assert!(!block.contains("voxelize/still") && block.contains("voxelize/moving"));
    assert!(
        block.contains("payload/clear_sums_moving") && with(&block, "light/") && with(&block, "surfaces/")
    );
    let camera = after(&[Cause::Camera]);
    assert_eq!(
        camera.iter().map(String::as_str).collect::<Vec<_>>(),
        ["display/tone", "picture", "surfaces/surfaces", "trace/cones"]
    );
    let rest: Vec<_> = whole.difference(&block).collect();
    assert_eq!(rest, ["payload/clear_bits_still", "payload/clear_sums_still", "voxelize/still"]);
}

/// What rays go through and what gives light are made anew where something moves: a scene that is played to a time is
/// the scene as it is at that time.
#[test]
fn rays_meet_what_moved_where_it_is() {
    let scene = moving_scene();
    let mut later = scene.clone();
    later.pose(1.3);
    let job = |scene| Job::new(scene, "reference", [16, 16]).small("16", "16");
    let (at_first, there) = (job(&scene), job(&later));
    let plain = at_first.outputs(gpu(), 8);
    let expected = there.outputs(gpu(), 8);
    assert!(!differences(&plain, &expected).is_empty(), "the control: it moves");
    let mut run = at_first.start(gpu()).expect("a run");
    let mut play = Play::new(scene.clone(), 0, [16, 16], &run.frame);
    play.go_to(&mut run.frame, gpu(), 1.3).expect("a pose");
    run.frames(8).expect("frames");
    let found = differences(&expected, &run.outputs());
    assert!(found.is_empty(), "{found:?}");
}
