//! How an ability of pipelines is shown: a small pipeline that needs it, an oracle for what must come out, and changes
//! of the pipeline's file that the oracle must notice.

use crate::bench::{Job, Run, differences, gpu, messages};
use voxgi::frame::Poison;
use voxgi::library::Shelf;

/// What an oracle says: what is wrong, if anything.
pub type Verdict = Result<(), String>;

/// Equality, as an oracle says it.
pub fn same<T: PartialEq + std::fmt::Debug>(found: T, expected: T) -> Verdict {
    if found == expected { Ok(()) } else { Err(format!("found {found:?}, expected {expected:?}")) }
}

/// A change of the pipeline's file.
pub enum Mutation {
    /// It runs, and the oracle notices.
    Wrong(&'static str, &'static str),
    /// It is refused before it runs, with this code.
    Refused(&'static str, &'static str, &'static str),
}

pub use Mutation::{Refused, Wrong};

/// Holds the job's pipeline against `oracle` in every way it can be run, and then its mutations.
pub fn show(job: &Job<'_>, oracle: impl Fn(&mut Run<'_>) -> Verdict, mutations: &[Mutation]) {
    let name = &job.request.pipeline;
    let result = |job: &Job<'_>| {
        let mut run = job.start(gpu()).map_err(|problems| messages(&problems))?;
        oracle(&mut run).map(|()| run.outputs())
    };
    let plain = result(job).unwrap_or_else(|why| panic!("{name}: {why}"));
    for (way, job) in job.ways() {
        let outputs = result(&job).unwrap_or_else(|why| panic!("{name}, {way}: {why}"));
        let found = differences(&plain, &outputs);
        assert!(found.is_empty(), "{name}, {way}: {found:?}");
    }
    for mutation in mutations {
        let (Wrong(from, to) | Refused(from, to, _)) = mutation;
        let folder = tempfile::tempdir().expect("a folder");
        let mutated = mutate(job, from, to, folder.path());
        match (mutated.prepare(), mutation) {
            (Ok(_), Wrong(..)) => {
                let noticed = result(&mutated);
                assert!(noticed.is_err(), "{name}: the oracle does not notice {to} in place of {from}");
            }
            (Err(problems), Refused(_, _, code)) => {
                assert!(problems.iter().any(|p| p.code == *code), "{name}: {to}: {}", messages(&problems));
            }
            (Ok(_), Refused(..)) => panic!("{name}: {to} in place of {from} is not refused"),
            (Err(problems), Wrong(..)) => panic!("{name}: {to} in place of {from}: {}", messages(&problems)),
        }
    }
}

/// The job with another text in its file, and with what is undefined filled, so that it can't be right by chance.
fn mutate<'a>(job: &Job<'a>, from: &str, to: &str, folder: &std::path::Path) -> Job<'a> {
    let name = &job.request.pipeline;
    let source = job.library.find(Shelf::Pipelines, name).expect("the pipeline");
    assert_eq!(source.text().matches(from).count(), 1, "{name}: `{from}` must be there once");
    let path = folder.join("mutated.ron");
    std::fs::write(&path, source.text().replace(from, to)).expect("a file");
    let mut mutated = job.clone();
    mutated.request.pipeline = path.display().to_string();
    mutated.poison = Some(Poison::Pattern);
    mutated
}
