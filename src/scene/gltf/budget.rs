//! How much a file may take: memory at any time, and work in all.
//!
//! A few bytes can ask for a lot: lists of zeros without a buffer, one mesh on ten thousand nodes, empty objects by the
//! million. Whoever makes something of a file says here first how many bytes it will be. Small files have [`LEAST`];
//! large ones [`TIMES`] as much as was read, which honest files stay far below.

use super::notes::Fault;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// What every file may take.
const LEAST: u64 = 768 << 20;
/// How much larger than what was read a scene may be in memory.
const TIMES: u64 = 32;
/// How often the whole budget may pass through memory.
const PASSES: u64 = 32;

#[derive(Default)]
pub struct Budget {
    /// Bytes of files.
    read: AtomicU64,
    /// Bytes in use until the scene is complete.
    held: AtomicU64,
    /// Bytes that were in use for a while, in all.
    passed: AtomicU64,
}

impl Budget {
    fn most(&self) -> u64 {
        LEAST.max(self.read.load(Relaxed).saturating_mul(TIMES))
    }

    /// A file of so many bytes was read.
    pub fn read(&self, bytes: u64) {
        self.read.fetch_add(bytes, Relaxed);
    }

    /// So many bytes more are needed until the scene is complete.
    pub fn hold(&self, bytes: u64) -> Result<(), Fault> {
        let held = add(&self.held, bytes);
        if held > self.most() { Err(self.exceeded(held)) } else { Ok(()) }
    }

    /// So many bytes are needed for a while.
    pub fn pass(&self, bytes: u64) -> Result<(), Fault> {
        let needed = self.held.load(Relaxed).saturating_add(bytes);
        if needed > self.most() {
            return Err(self.exceeded(needed));
        }
        if add(&self.passed, bytes) > self.most().saturating_mul(PASSES) {
            return Err(Fault::new("gltf-size", "the scene reads the same lists too many times over")
                .help("merge primitives that share their vertices"));
        }
        Ok(())
    }

    fn exceeded(&self, needed: u64) -> Fault {
        let [needed, most] = [needed, self.most()].map(|bytes| bytes >> 20);
        Fault::new("gltf-size", format!("the scene takes {needed} MiB so far, but at most {most} MiB"))
            .help("small files may take 768 MiB in memory, larger ones 32 times their size")
    }
}

fn add(counter: &AtomicU64, bytes: u64) -> u64 {
    let add = |old: u64| Some(old.saturating_add(bytes));
    let old = counter.fetch_update(Relaxed, Relaxed, add).unwrap_or(u64::MAX);
    old.saturating_add(bytes)
}
