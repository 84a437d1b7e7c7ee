//! Parts and roles, named values, and libraries that are somewhere else.

use crate::abilities::{Refused, Wrong, same, show};
use crate::bench::{Job, Run, root, scene};
use std::path::Path;
use voxgi::library::Library;

/// A part called twice, each time bound to another resource; the module behind its role has a binding of its own.
#[test]
fn a_part_is_called_twice_and_imports_a_role() {
    let scene = scene("cornell-point");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(run.floats("a_shown"), vec![3.0, 4.0, 5.0, 6.0])?;
        same(run.floats("b_shown"), vec![3.0, 4.0, 5.0])
    };
    let wrong = [
        Wrong("\"shade\": \"shade/plus\"", "\"shade\": \"shade/times\""),
        Wrong("bind: {\"ramp_to\": \"b\"}", "bind: {\"ramp_to\": \"c\"}"),
        Refused("name: \"second\"", "name: \"first\"", "duplicate-name"),
    ];
    let job = Job::new(&scene, "parts", [1, 1]);
    show(&job, oracle, &wrong);

    // The same by `--part`.
    let mut other = job;
    other.request.parts.push(("shade".to_owned(), "shade/times".to_owned()));
    let times = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(run.floats("a_shown"), vec![0.0, 3.0, 6.0, 9.0])
    };
    show(&other, times, &[]);
}

#[test]
fn named_values_follow_the_scene() {
    let scene = scene("cornell-point");
    let bounds = [scene.bounds.min, scene.bounds.max].map(glam::DVec3::from);
    let middle = 0.5 * (bounds[0] + bounds[1]);
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        let expected = [middle.x, middle.y, middle.z, 2.0 * middle.y].map(|x| x as f32);
        same(run.floats("shown"), expected.to_vec())
    };
    show(&Job::new(&scene, "values", [1, 1]), oracle, &[Wrong("0.5 * (scene", "0.25 * (scene")]);
}

/// A technique that the binary has never seen, in a folder somewhere else.
#[test]
fn a_library_may_be_anywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    for file in ["kernels/shade/plus.wgsl", "kernels/ramp.wgsl", "kernels/shown.wgsl"] {
        copy(file, folder.path(), file);
    }
    copy("pipelines/parts/shade/plus.ron", folder.path(), "pipelines/parts/elsewhere/plus.ron");
    copy("pipelines/parts/ramp/line.ron", folder.path(), "pipelines/parts/ramp/line.ron");
    let text = std::fs::read_to_string(root("tests/library-engine/pipelines/parts.ron")).expect("a file");
    let text = text.replace("shade/plus", "elsewhere/plus");
    std::fs::write(folder.path().join("pipelines/elsewhere.ron"), text).expect("a file");

    let scene = scene("cornell-point");
    let mut job = Job::new(&scene, "elsewhere", [1, 1]);
    job.library = Library::new(Vec::new()).expect("the built-in library");
    assert!(job.prepare().is_err(), "the built-in library knows it");
    job.library = Library::new(vec![folder.path().to_owned()]).expect("a library");
    let oracle = |run: &mut Run<'_>| {
        run.frames(1).map_err(|p| format!("{p:?}"))?;
        same(run.floats("a_shown"), vec![3.0, 4.0, 5.0, 6.0])
    };
    show(&job, oracle, &[Refused("elsewhere/plus", "shade/plus", "unknown-part")]);
}

fn copy(from: &str, folder: &Path, to: &str) {
    let to = folder.join(to);
    std::fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
    std::fs::copy(root("tests/library-engine").join(from), to).expect("a copy");
}
