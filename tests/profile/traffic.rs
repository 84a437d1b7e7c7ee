//! Bytes of small pipelines, against what they are by hand.

use crate::world::{gpu, prepared, scene};
use voxgi::frame::Clock;
use voxgi::profile::copy::measure;
use voxgi::profile::traffic::{Traffic, traffic};
use voxgi::record::StageProfile;
use voxgi::schedule::Step;

/// By stage in the order they run, bytes read and written; those of the fills before it under `fill`.
fn found(pipeline: &str, size: [u32; 2]) -> Vec<(String, u64, u64)> {
    let scene = scene();
    let prepared = prepared(&scene, pipeline, size, None);
    let bytes = traffic(&prepared.graph, &prepared.schedule, &scene);
    let named = prepared.schedule.steps.iter().zip(bytes).map(|(step, bytes)| {
        let bytes = bytes.expect("sizes are known");
        let name = match step {
            Step::Run { task, .. } => prepared.graph.stages[*task].path.clone(),
            Step::Start { .. } => "fill".to_owned(),
        };
        (name, bytes.read_bytes, bytes.written_bytes)
    });
    named.filter(|(_, read, written)| read + written > 0).collect()
}

fn expect(pipeline: &str, size: [u32; 2], expected: &[(&str, u64, u64)]) {
    let expected: Vec<_> = expected.iter().map(|(name, r, w)| ((*name).to_owned(), *r, *w)).collect();
    let mut found = found(pipeline, size);
    found.sort();
    let mut sorted = expected;
    sorted.sort();
    assert_eq!(found, sorted, "{pipeline}");
}

/// 8×8 texels of 16 bytes and three coarser mips, all filled first: each stage reads one and writes the next.
#[test]
fn mips_count_apart() {
    expect(
        "mip_chain",
        [8, 8],
        &[
            ("fill", 0, 1024),
            ("fill", 0, 256),
            ("fill", 0, 64),
            ("fill", 0, 16),
            ("position", 0, 1024),
            ("mean[0]", 1024, 256),
            ("mean[1]", 256, 64),
            ("mean[2]", 64, 16),
        ],
    );
}

/// Four words of arguments are written, of which a dispatch reads three; 16 marks are written, then shown.
#[test]
fn arguments_are_three_words() {
    let expected = [("arguments", 0, 16), ("fill", 0, 64), ("mark", 12, 64), ("shown", 64, 64)];
    expect("indirect", [8, 8], &expected);
}

/// Shade and depth, 4 bytes a texel each, are cleared by the pass itself: neither filled apart nor read.
#[test]
fn targets_that_a_pass_clears_are_written_once() {
    expect("depth", [8, 4], &[("quads", 0, 2 * 8 * 4 * 4)]);
}

/// The kernel reads vertices, triangles and instances of the scene, and none of its other lists.
#[test]
fn what_the_scene_gives_is_read_whole() {
    let scene = scene();
    let bytes = size_of_val(&scene.vertices[..])
        + size_of_val(&scene.triangles[..])
        + size_of_val(&scene.instances[..]);
    expect("scene", [8, 8], &[("triangles", bytes as u64, 2 * 8 * 8 * 4)]);
}

/// 3 MB in 2 ms are 1.5 GB/s: half of what a device copies at 3 GB/s.
#[test]
fn bandwidth_and_shares() {
    let traffic = Traffic { read_bytes: 1_000_000, written_bytes: 2_000_000 };
    let stage = StageProfile::new(Some(2.0), Some(8.0), Some(traffic), Some(3.0));
    assert_eq!((stage.share, stage.gb_per_s, stage.of_copy), (Some(0.25), Some(1.5), Some(0.5)));
    // What is not known makes nothing else known, and nothing is divided by 0.
    let unknown = StageProfile::new(None, Some(8.0), Some(traffic), None);
    assert_eq!((unknown.share, unknown.gb_per_s, unknown.of_copy), (None, None, None));
    assert_eq!(StageProfile::new(Some(0.0), Some(0.0), Some(traffic), Some(0.0)).gb_per_s, None);
}

/// The two clocks can't agree to the percent, but a factor would be a mistake in bytes or units.
#[test]
fn copies_are_as_fast_by_both_clocks() {
    let speeds = [Clock::Timestamps, Clock::Wall("for the test".to_owned())].map(|clock| {
        let speeds = measure(gpu(), &clock).expect("copies");
        for speed in [&speeds.buffer, &speeds.texture] {
            assert!(speed.bytes >= 16 << 20 && speed.samples_ms.len() == 9, "{speed:?}");
            assert!(speed.samples_ms.iter().all(|ms| *ms > 0.0), "{speed:?}");
            let least = speed.samples_ms.iter().copied().fold(f64::INFINITY, f64::min);
            let most = 2.0 * speed.bytes as f64 / least / 1e6;
            assert!(speed.gb_per_s.is_some_and(|speed| speed > 0.0 && speed <= most), "{speed:?}");
        }
        speeds.best().expect("a speed")
    });
    println!("by timestamps {:.2} GB/s, by the wall {:.2} GB/s", speeds[0], speeds[1]);
    assert!((0.33..3.0).contains(&(speeds[0] / speeds[1])), "{speeds:?}");
}
