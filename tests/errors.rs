//! Every mistake has a message that says where it is, what is wrong and a way out: `tests/errors/` has an example of
//! each, with the message as a document.
//!
//! A case is a folder: `case.txt` (what the mistake is and the command line), `expected.txt` (exit code and standard
//! error, to the letter) and the files that the command reads. It runs in a copy of that folder, beside which lies the
//! Cornell box. What `case.txt` can say, a line each:
//!
//! | line | means |
//! |---|---|
//! | `# …` | what the mistake is |
//! | `command: voxgi …` | the command line, its words separated by spaces |
//! | `repair: FILE: OLD => NEW` | this takes the mistake away; `FILE` may be `command` |
//! | `device: yes` | the mistake is found by a device; without this line the command sees no driver at all |
//! | `leaves: FILE` | a run that fails leaves this file; otherwise it leaves nothing |
//!
//! A repaired case must succeed without a message, so that the mistake is the one that is meant, and the only one.
//!
//! `VOXGI_BLESS=1` writes the expected files anew, to be read before they are committed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::{env, fs, thread};
use tempfile::TempDir;

/// What has to be covered, by names of cases.
const REQUIRED: [&str; 52] = [
    "syntax",
    "unknown-field",
    "duplicate-key",
    "unknown-pipeline",
    "unknown-kernel",
    "unknown-part",
    "unknown-part-option",
    "unknown-role",
    "unknown-role-option",
    "unknown-resource",
    "unknown-knob",
    "unknown-knob-expression",
    "unknown-knob-option",
    "unknown-output",
    "unknown-camera",
    "formats-read",
    "formats-written",
    "sampled-while-written",
    "read-before-written",
    "swap-unlike",
    "swap-kept",
    "previous-not-kept",
    "size-zero-option",
    "size-zero-expression",
    "over-limit",
    "over-memory",
    "bad-condition",
    "knob-out-of-range",
    "wgsl-type",
    "missing-binding",
    "unused-binding",
    "no-such-adapter",
    "no-adapter",
    "lacks-feature",
    "lacks-feature-storage",
    "import-ring",
    "import-unknown",
    "numbered-binding",
    "exported-twice",
    "hostile-kernel",
    "hostile-kernel-there",
    "hostile-part",
    "hostile-pipeline",
    "scene-missing",
    "scene-broken",
    "part-lacks",
    "part-role",
    "override-value",
    "override-missing",
    "sampler-comparison",
    "buffer-layout",
    "output-folder",
];

/// Cases without a repair: what is asked for is a picture, and making one takes a device.
const UNREPAIRED: [&str; 6] =
    ["no-adapter", "no-adapter-devices", "output-folder", "output-kind", "unknown-dump", "unknown-output"];

/// Cases whose message is its own way out: what it points at is to be changed to what it says.
const SAYS_ITSELF: [&str; 12] = [
    "bad-expression",
    "entry-point",
    "missing-field",
    "output-taken",
    "override-value",
    "part-is-pipeline",
    "part-role",
    "part-role-option",
    "setting-camera",
    "syntax",
    "unknown-mip",
    "value-ring",
];

struct Repair {
    file: String,
    old: String,
    new: String,
}

struct Case {
    name: String,
    folder: PathBuf,
    command: String,
    device: bool,
    leaves: BTreeSet<PathBuf>,
    repairs: Vec<Repair>,
}

/// How a command ended: exit code, what it said, and what it left behind.
struct Outcome {
    code: i32,
    said: String,
    left: BTreeSet<PathBuf>,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/errors")
}

fn cases() -> Vec<Case> {
    let entries = fs::read_dir(folder()).expect("tests/errors is a folder");
    let mut folders: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    folders.sort();
    folders.into_iter().map(Case::read).collect()
}

impl Case {
    fn read(folder: PathBuf) -> Self {
        let name = folder.file_name().expect("a name").to_string_lossy().into_owned();
        let text = fs::read_to_string(folder.join("case.txt")).unwrap_or_else(|e| panic!("{name}: {e}"));
        let mut case = Self {
            name,
            folder,
            command: String::new(),
            device: false,
            leaves: BTreeSet::new(),
            repairs: Vec::new(),
        };
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let (key, value) = line.split_once(": ").unwrap_or_else(|| panic!("{}: {line}", case.name));
            match key {
                "command" => case.command = value.to_owned(),
                "device" => case.device = value == "yes",
                "leaves" => _ = case.leaves.insert(value.into()),
                "repair" => case.repairs.push(Repair::read(value)),
                _ => panic!("{}: `{key}` means nothing here", case.name),
            }
        }
        assert!(text.starts_with("# "), "{}: what is the mistake?", case.name);
        assert!(case.command.starts_with("voxgi "), "{}: no command", case.name);
        case
    }

    /// A copy of the case's files, with the Cornell box.
    fn copy(&self) -> TempDir {
        let copy = TempDir::new().expect("a temporary folder");
        for file in entries(&self.folder) {
            let (from, to) = (self.folder.join(&file), copy.path().join(&file));
            match from.is_dir() {
                true => fs::create_dir_all(to).expect("a folder"),
                false => _ = fs::copy(from, to).expect("a copy"),
            }
        }
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/cornell-box.glb");
        fs::copy(scene, copy.path().join("cornell-box.glb")).expect("a copy");
        copy
    }

    fn run(&self) -> Outcome {
        self.run_in(self.copy().path(), &self.command)
    }

    /// Runs the case without its mistake.
    fn run_repaired(&self) -> Outcome {
        let copy = self.copy();
        let mut command = self.command.clone();
        for Repair { file, old, new } in &self.repairs {
            let path = copy.path().join(file);
            let text = match file.as_str() {
                "command" => command.clone(),
                _ => fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {file}: {e}", self.name)),
            };
            assert!(text.contains(old), "{}: {file} has no `{old}`", self.name);
            match file.as_str() {
                "command" => command = text.replace(old, new),
                _ => fs::write(path, text.replace(old, new)).expect("a file"),
            }
        }
        self.run_in(copy.path(), &command)
    }

    fn run_in(&self, folder: &Path, command: &str) -> Outcome {
        let before = entries(folder);
        let mut process = voxgi();
        process.args(command.split(' ').skip(1)).current_dir(folder);
        if !self.device {
            process.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
        }
        let output = process.output().expect("voxgi runs");
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
        let mut said = text(&output.stderr);
        if self.device {
            said = without_adapters(said);
        }
        if command.ends_with("--json") && !output.status.success() {
            said += &format!("--- standard output\n{}", text(&output.stdout));
        }
        let left = entries(folder).difference(&before).cloned().collect();
        Outcome { code: output.status.code().expect("an exit code"), said, left }
    }

    /// What is not as expected, if anything.
    fn difference(&self, expected: &str, outcome: &Outcome) -> Option<String> {
        let actual = outcome.document();
        let same = match self.device {
            true => unwrapped(expected) == unwrapped(&actual),
            false => expected == actual,
        };
        if !same {
            return Some(format!("{}: expected\n{expected}\nbut it was\n{actual}", self.name));
        }
        let left = if outcome.code == 0 { &self.leaves } else { &outcome.left };
        (left != &self.leaves).then(|| format!("{}: it leaves {left:?}", self.name))
    }
}

impl Repair {
    fn read(line: &str) -> Self {
        let (file, change) = line.split_once(": ").expect("FILE: OLD => NEW");
        let (old, new) = change.split_once(" =>").expect("OLD => NEW");
        Self { file: file.to_owned(), old: old.to_owned(), new: new.trim_start().to_owned() }
    }
}

impl Outcome {
    fn document(&self) -> String {
        format!("exit code {}\n\n{}", self.code, self.said)
    }
}

fn voxgi() -> Command {
    let mut process = Command::new(env!("CARGO_BIN_EXE_voxgi"));
    process.env("NO_COLOR", "1").env_remove("VOXGI_SCENES");
    process
}

/// All files and folders below `folder` but the case's own documents, folders before what is in them.
fn entries(folder: &Path) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for path in fs::read_dir(next).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            found.insert(path.strip_prefix(folder).expect("a path below").to_path_buf());
            if path.is_dir() {
                folders.push(path);
            }
        }
    }
    found.remove(Path::new("case.txt"));
    found.remove(Path::new("expected.txt"));
    found
}

/// Names of this machine's adapters.
fn adapters() -> &'static [String] {
    static NAMES: OnceLock<Vec<String>> = OnceLock::new();
    NAMES.get_or_init(|| {
        let output = voxgi().args(["devices", "--json"]).output().expect("voxgi runs");
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let names = json["devices"].as_array().into_iter().flatten();
        let mut names: Vec<String> =
            names.filter_map(|device| device["adapter"]["name"].as_str().map(str::to_owned)).collect();
        // First the list of all, as messages show it.
        names.insert(0, names.join(", "));
        names
    })
}

/// A message in one line, without the names of adapters: where its lines end follows from how long those are.
fn unwrapped(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().filter(|word| *word != "│").collect();
    without_adapters(words.join(" "))
}

fn without_adapters(text: String) -> String {
    adapters().iter().fold(text, |text, name| text.replace(name, "<adapter>"))
}

/// `check` for each of `cases`, as many at once as there are processors; what they complain of, joined.
fn all(cases: &[Case], check: impl Fn(&Case) -> Option<String> + Sync) -> String {
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Some(complaint) = check(case) {
                found.lock().expect("no check panics").push(complaint);
            }
        }
    };
    let workers = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| (0..workers).for_each(|_| _ = scope.spawn(work)));
    let mut found = found.into_inner().expect("no check panics");
    found.sort();
    found.join("\n\n")
}

#[test]
fn messages_are_as_expected() {
    let bless = env::var_os("VOXGI_BLESS").is_some_and(|value| value == "1");
    let wrong = all(&cases(), |case| {
        let outcome = case.run();
        let path = case.folder.join("expected.txt");
        if bless {
            fs::write(&path, outcome.document()).expect("a file");
        }
        match fs::read_to_string(&path) {
            Ok(expected) => case.difference(&expected, &outcome),
            Err(error) => Some(format!("{}: expected.txt: {error}", case.name)),
        }
    });
    assert!(wrong.is_empty(), "{wrong}\n\nVOXGI_BLESS=1 writes the expected files anew");
}

#[test]
fn repaired_cases_succeed() {
    let wrong = all(&cases(), |case| {
        if case.repairs.is_empty() {
            return None;
        }
        let outcome = case.run_repaired();
        let quiet = outcome.said.is_empty() && outcome.code == 0;
        (!quiet).then(|| format!("{}: repaired, but\n{}", case.name, outcome.document()))
    });
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn all_that_is_required_is_there() {
    let cases = cases();
    let missing: Vec<_> = REQUIRED.iter().filter(|name| !cases.iter().any(|c| c.name == **name)).collect();
    assert!(missing.is_empty(), "no case {missing:?}");
    let unrepaired: Vec<_> = cases.iter().filter(|c| c.repairs.is_empty()).map(|c| c.name.as_str()).collect();
    assert_eq!(unrepaired, UNREPAIRED, "cases without a repair");
}

#[test]
fn every_failure_says_a_way_out() {
    let mut without = Vec::new();
    for case in cases() {
        let Ok(expected) = fs::read_to_string(case.folder.join("expected.txt")) else { continue };
        assert!(!expected.contains("panicked"), "{}: a panic", case.name);
        // Messages about options are clap's, those about WGSL naga's.
        let help = ["\n  help: ", "\nFor more information, try '--help'.", "\nwgsl\n"];
        if !help.iter().any(|help| expected.contains(help)) {
            without.push(case.name);
        }
    }
    assert_eq!(without, SAYS_ITSELF, "messages without help");
}

/// A control of the tests above: each sort of wrong expectation is seen.
#[test]
fn wrong_expectations_are_seen() {
    let case = Case::read(folder().join("unknown-kernel"));
    let expected = fs::read_to_string(case.folder.join("expected.txt")).expect("an expected file");
    let outcome = case.run();
    assert_eq!(case.difference(&expected, &outcome), None);
    for (right, wrong) in
        [("exit code 2", "exit code 1"), ("`pant`", "`paint`"), ("case.ron:7:", "case.ron:8:")]
    {
        let altered = expected.replacen(right, wrong, 1);
        assert_ne!(altered, expected, "the message has no {right:?}");
        assert!(case.difference(&altered, &outcome).is_some(), "{wrong:?} goes unseen");
    }
    let left = Outcome { left: BTreeSet::from(["out/color.png".into()]), ..case.run() };
    assert!(case.difference(&expected, &left).is_some(), "a file that is left behind goes unseen");
    assert_ne!(Case { repairs: Vec::new(), ..case }.run_repaired().code, 0, "a mistake passes as repaired");
}
