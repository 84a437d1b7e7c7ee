//! One file in a process of its own, with limits.

use serde_json::Value;
use std::fs::File;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Most memory of a process in KiB: 1 GiB.
pub const MOST_KIB: i64 = 1 << 20;
/// Longest time of a process, on a machine that may be busy with others.
pub const MOST_TIME: Duration = Duration::from_secs(30);

#[derive(Debug)]
pub struct Outcome {
    pub status: ExitStatus,
    pub time: Duration,
    /// Most resident memory.
    pub kib: i64,
    /// What `--json` printed.
    pub json: Value,
    pub stderr: String,
}

impl Outcome {
    /// Code and message of each problem.
    pub fn problems(&self) -> Vec<(String, String)> {
        let list = self.json["problems"].as_array().cloned().unwrap_or_default();
        let text = |problem: &Value, name: &str| problem[name].as_str().unwrap_or_default().to_owned();
        list.iter().map(|problem| (text(problem, "code"), text(problem, "message"))).collect()
    }

    /// Panics unless the process kept to what every file can expect. Returns whether the file loaded.
    pub fn harmless(&self, name: &str) -> bool {
        assert!(self.time < MOST_TIME, "{name} takes {:?}", self.time);
        assert!(self.kib < MOST_KIB, "{name} takes {} KiB", self.kib);
        let code = self.status.code();
        assert!(matches!(code, Some(0 | 2)), "{name}: {:?}\n{}", self.status, self.stderr);
        let problems = self.problems();
        assert_eq!(code == Some(2), !problems.is_empty(), "{name}: {}", self.json);
        for (code, message) in &problems {
            assert!(message.len() < 2000, "{name}: {} bytes of message", message.len());
            let file = Path::new(name).file_name().unwrap().to_string_lossy();
            assert!(self.json.to_string().contains(&*file), "{name} is not named: {message}");
            // What is no document has no places in it.
            let whole = ["gltf-container", "gltf-json", "gltf-version", "scene-file", "setting"];
            let place = message.contains(" at /") || self.json.to_string().contains("\"line\"");
            assert!(
                place || whole.contains(&&**code) || message.contains("the whole document"),
                "{name}: {message}"
            );
        }
        problems.is_empty()
    }
}

/// `voxgi scenes PATH --json`.
pub fn load(path: &Path) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_voxgi"));
    command.args(["scenes".as_ref(), path.as_os_str(), "--json".as_ref()]);
    run(command)
}

/// Runs the command to its end, or kills it when it takes too long.
pub fn run(mut command: Command) -> Outcome {
    let folder = tempfile::tempdir().unwrap();
    let [out, err] = ["out", "err"].map(|name| folder.path().join(name));
    command.stdin(Stdio::null()).stdout(File::create(&out).unwrap()).stderr(File::create(&err).unwrap());
    let start = Instant::now();
    let mut child = command.spawn().unwrap();
    let mut kib = 0;
    let status = loop {
        // The most so far; what is gone with the process is a millisecond.
        kib = resident(child.id()).unwrap_or(0).max(kib);
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if start.elapsed() > MOST_TIME {
            child.kill().unwrap();
            break child.wait().unwrap();
        }
        std::thread::sleep(Duration::from_millis(1));
    };
    let json = std::fs::read(&out).unwrap();
    Outcome {
        status,
        time: start.elapsed(),
        kib,
        json: serde_json::from_slice(&json).unwrap_or_default(),
        stderr: String::from_utf8_lossy(&std::fs::read(&err).unwrap()).into_owned(),
    }
}

/// Most resident memory so far of a process in KiB; `None` once it has ended.
fn resident(process: u32) -> Option<i64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.parse().ok()
}

/// A control: a process that ends badly, one that takes memory, and one that hangs are seen.
#[test]
fn harm_is_seen() {
    let shell = |script: &str| {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        run(command)
    };
    let harmless = |outcome: &Outcome| std::panic::catch_unwind(|| outcome.harmless("x.glb")).is_ok();
    assert!(harmless(&shell("exit 0")));
    for script in ["exit 1", "exit 101", "exit 2", "kill -9 $$", "kill -6 $$"] {
        assert!(!harmless(&shell(script)), "{script}");
    }
    let outcome = shell("exec dd if=/dev/zero of=/dev/null bs=200M count=1");
    assert!(outcome.kib > 190_000, "{} KiB", outcome.kib);
    let slow = Outcome { time: MOST_TIME, ..shell("exit 0") };
    assert!(!harmless(&slow));
    let large = Outcome { kib: MOST_KIB, ..shell("exit 0") };
    assert!(!harmless(&large));
}
