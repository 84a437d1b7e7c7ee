//! The files of `VOXGI_SCENES/bad`, with the verdicts of gltf-validator in `INDEX.tsv`.

use crate::process::load;
use crate::support::scenes;
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Files that the validator calls clean and that are refused, with the reason.
const CLEAN_BUT_REFUSED: [(&str, &str); 2] = [
    ("validator/root/named_objects.gltf", "it draws a mesh whose buffer has no content"),
    ("validator/root/unused_objects.gltf", "it draws a mesh whose buffer has no content"),
];

#[test]
fn no_file_does_harm_and_clean_ones_load() {
    let Some(folder) = scenes() else { return };
    let folder = folder.join("bad");
    let index = std::fs::read_to_string(folder.join("INDEX.tsv")).unwrap();
    let rows: Vec<Vec<&str>> = index.lines().skip(1).map(|line| line.split('\t').collect()).collect();
    assert!(rows.len() > 300, "the index has only {} files", rows.len());
    let (next, table, failures) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                while let Some(row) = rows.get(next.fetch_add(1, Relaxed)) {
                    let [name, _, verdict, ..] = row[..] else { panic!("{row:?}") };
                    let done = std::panic::catch_unwind(|| one(&folder, name, verdict));
                    match done {
                        Ok(done) => {
                            drop(table.lock().unwrap().insert((verdict, name), (done, row[row.len() - 1])))
                        }
                        Err(_) => failures.lock().unwrap().push(name),
                    }
                }
            });
        }
    });
    let table = table.into_inner().unwrap();
    for ((verdict, name), (done, codes)) in &table {
        println!("{verdict}\t{name}\t{done}\t{codes}");
    }
    let failures = failures.into_inner().unwrap();
    assert!(failures.is_empty(), "{failures:?}");
    let refused = |wanted: &str| {
        table.iter().filter(|((verdict, _), (done, _))| *verdict == wanted && done != "loads").count()
    };
    println!(
        "refused: {} REJECT, {} errors, {} warnings, {} clean",
        refused("REJECT"),
        refused("errors"),
        refused("warnings"),
        refused("clean")
    );
    assert_eq!(refused("REJECT"), 6, "what is no glTF at all is refused");
    assert!(refused("errors") >= 60, "broken files are refused");
    assert_eq!(refused("clean"), CLEAN_BUT_REFUSED.len(), "an exception that no longer is one");
}

/// What becomes of one file: `loads`, or its first problem.
fn one(folder: &std::path::Path, name: &str, verdict: &str) -> String {
    let outcome = load(&folder.join(name));
    if outcome.harmless(name) {
        return "loads".to_owned();
    }
    let (code, message) = outcome.problems().swap_remove(0);
    let excused = CLEAN_BUT_REFUSED.iter().any(|(file, _)| *file == name);
    assert!(excused || !matches!(verdict, "clean" | "warnings"), "{name} is {verdict}: {message}");
    let message = message.rsplit_once(&format!("{name}` ")).map_or(&*message, |(_, rest)| rest);
    format!("{code} {message}")
}
