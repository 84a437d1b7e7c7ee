//! Fuzzing of what reads files that others made: scenes ([`scenes`]), and the text of pipelines and settings
//! ([`texts`]). Inputs are mutants of real files; those that are answered in a new way are mutated further.
//!
//! Each input must be answered within time and memory, without a panic, by a result that keeps its promises or by
//! problems that a user can read. A short campaign runs with a fixed seed, and one with a fresh seed, which is printed.
//!
//! `VOXGI_FUZZ_SECONDS=3600` makes the fresh campaigns longer, `VOXGI_FUZZ_SEED=N` repeats one. Each finding is kept as a
//! folder below `fuzz/` in the target folder; `VOXGI_FUZZ_REPLAY=FOLDER` runs one input again.

mod campaign;
mod glb;
mod memory;
mod promises;
mod ron_text;
mod scene_mutants;
mod scenes;
mod texts;

use campaign::{campaign, replay};

#[test]
fn scenes_are_answered() {
    campaign("scenes", &mut scenes::Scenes::new());
}

#[test]
fn pipelines_are_answered() {
    campaign("pipelines", &mut texts::Pipelines::new());
}

#[test]
fn settings_are_answered() {
    campaign("settings", &mut texts::Settings::new());
}

#[test]
fn one_input_again() {
    let Some(folder) = std::env::var_os("VOXGI_FUZZ_REPLAY") else { return };
    replay(
        folder.as_ref(),
        &mut [&mut scenes::Scenes::new(), &mut texts::Pipelines::new(), &mut texts::Settings::new()],
    );
}
