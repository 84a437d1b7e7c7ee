//! A campaign: inputs from dice, one after another, each watched.

use super::memory;
use fastrand::Rng;
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};

/// What an input may take. The time is on the wall, so that a machine with other work must not break it.
const MOST_BYTES: usize = 1 << 30;
const MOST_TIME: Duration = Duration::from_secs(20);
/// After this the process is ended: the input hangs.
const HANGS: Duration = Duration::from_secs(120);
const FIXED_SEED: u64 = 20_261;

/// How an input was answered, in short: answers to inputs of one sort have the same words.
pub struct Answer {
    pub accepted: bool,
    pub words: String,
}

pub trait Target {
    /// Writes an input that the dice choose into an empty folder.
    fn input(&mut self, dice: &mut Rng, folder: &Path);
    /// Feeds the folder's input. Panics where a promise is broken.
    fn feed(&mut self, folder: &Path) -> Answer;
    /// The last input was answered as none before: it is worth more mutants.
    fn keep(&mut self);
}

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Campaigns run one at a time: the memory in use is the process's.
static ONE: Mutex<()> = Mutex::new(());

fn env(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

fn home() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("fuzz")
}

/// One campaign with the fixed seed and one with a fresh one. Fails if there were findings, and if nearly all inputs
/// were refused in the same few ways, since then nothing was tested.
pub fn campaign(name: &str, target: &mut dyn Target) {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    listen();
    let since = std::time::SystemTime::UNIX_EPOCH.elapsed().map_or(0, |time| time.as_nanos() as u64);
    let seed = env("VOXGI_FUZZ_SEED").unwrap_or(since);
    let seconds = env("VOXGI_FUZZ_SECONDS").unwrap_or(2);
    let mut tally = Tally::default();
    run(name, target, FIXED_SEED, Duration::from_secs(2), &mut tally);
    run(name, target, seed, Duration::from_secs(seconds), &mut tally);
    println!("{}", tally.text(name, seed));
    assert!(tally.findings.is_empty(), "{}", tally.text(name, seed));
    assert!(tally.accepted > 0 && tally.answers.len() >= 10, "{}", tally.text(name, seed));
}

/// Runs the input in `folder` once more, by the target that made it.
pub fn replay(folder: &Path, targets: &mut [&mut dyn Target]) {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let names = ["scenes", "pipelines", "settings"];
    let target = names.iter().position(|target| name.starts_with(target)).expect("a folder of a finding");
    let start = Instant::now();
    let (answer, bytes) = memory::peak(|| targets[target].feed(folder));
    println!("{} after {:?}, {bytes} bytes: {}", answer.accepted, start.elapsed(), answer.words);
}

#[derive(Default)]
struct Tally {
    inputs: usize,
    accepted: usize,
    answers: BTreeSet<String>,
    /// By kind, the first input of it.
    findings: BTreeMap<String, String>,
    largest: usize,
    slowest: Duration,
}

impl Tally {
    fn text(&self, name: &str, seed: u64) -> String {
        let mut text = format!(
            "{name}: {} inputs, {} accepted, {} different answers, at most {} MiB and {:?}, seed {seed}",
            self.inputs,
            self.accepted,
            self.answers.len(),
            self.largest >> 20,
            self.slowest
        );
        for (kind, at) in &self.findings {
            let _infallible = write!(text, "\n  {kind}\n    kept in {at}");
        }
        text
    }
}

fn run(name: &str, target: &mut dyn Target, seed: u64, time: Duration, tally: &mut Tally) {
    let mut dice = Rng::with_seed(seed);
    let end = Instant::now() + time;
    // Threads of a test end with it, so the folder is this thread's alone.
    let folder = home().join(format!("{name}-now-{}", std::process::id()));
    let watch = watch(folder.clone());
    while Instant::now() < end {
        let _new = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        target.input(&mut dice, &folder);
        let start = Instant::now();
        let _seen = watch.send(start);
        let (answer, bytes) = memory::peak(|| quietly(|| target.feed(&folder)));
        let took = start.elapsed();
        (tally.largest, tally.slowest) = (tally.largest.max(bytes), tally.slowest.max(took));
        tally.inputs += 1;
        let finding = match answer {
            Err(panic) => Some(panic),
            _ if bytes > MOST_BYTES => Some(format!("an input takes more than {MOST_BYTES} bytes")),
            _ if took > MOST_TIME => Some(format!("an input takes longer than {MOST_TIME:?}")),
            Ok(answer) => {
                tally.accepted += usize::from(answer.accepted);
                // Refused ones are many, and lead to others that are refused.
                if tally.answers.insert(answer.words) && (answer.accepted || dice.usize(..4) == 0) {
                    target.keep();
                }
                None
            }
        };
        if let Some(finding) = finding.filter(|finding| !tally.findings.contains_key(finding)) {
            let kept = home().join(format!("{name}-{seed}-{}", tally.inputs));
            let _new = fs::remove_dir_all(&kept);
            fs::rename(&folder, &kept).unwrap();
            eprintln!("{name}: {finding}\n    kept in {}", kept.display());
            tally.findings.insert(finding, kept.display().to_string());
        }
    }
    let _gone = fs::remove_dir_all(&folder);
}

/// Takes the start of each input; where the next is too long in coming, says which input hangs and ends the process.
fn watch(folder: PathBuf) -> mpsc::Sender<Instant> {
    let (started, starts) = mpsc::channel();
    std::thread::spawn(move || {
        loop {
            match starts.recv_timeout(HANGS) {
                Ok(_) => {}
                Err(mpsc::RecvTimeoutError::Disconnected) => return,
                Err(mpsc::RecvTimeoutError::Timeout) => {
                    eprintln!("the input in {} hangs", folder.display());
                    std::process::abort();
                }
            }
        }
    });
    started
}

/// What a panic says and where, instead of printing it, in threads that are quiet.
fn listen() {
    let loud = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if QUIET.get() {
            let what = panic.payload_as_str().unwrap_or_default();
            // Without numbers, panics of one sort are one finding.
            let what: String = what.chars().filter(|c| !c.is_ascii_digit()).take(200).collect();
            let at = panic.location().map(ToString::to_string).unwrap_or_default();
            PANIC.set(format!("panic at {at}: {what}"));
        } else {
            loud(panic);
        }
    }));
}

/// A control: what is looked for is found.
#[test]
fn panics_and_memory_are_noticed() {
    let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    listen();
    let panic = quietly(|| assert_eq!(1 + 1, 3)).unwrap_err();
    assert!(panic.starts_with("panic at tests/fuzz/campaign.rs") && panic.contains("assertion"), "{panic}");
    let ((), bytes) = memory::peak(|| drop(std::hint::black_box(vec![1_u8; MOST_BYTES + 1])));
    assert!(bytes > MOST_BYTES);
}

fn quietly<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    QUIET.set(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    QUIET.set(false);
    result.map_err(|_| PANIC.take())
}
