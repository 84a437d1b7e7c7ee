//! Who is told how far the unwrapping is, which can take seconds.

use super::mesh::Mesh;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

type Watch = Box<dyn Fn(f64) + Send + Sync>;

static WATCH: OnceLock<Watch> = OnceLock::new();

/// From now on `watch` is told, with how much is done: from 0 to 1, which is said once at the end. Only the first that
/// asks is.
pub fn watch(watch: impl Fn(f64) + Send + Sync + 'static) {
    // There is one standard error for all who might ask.
    let _first = WATCH.set(Box::new(watch));
}

/// Counts triangles.
pub struct Watched {
    all: usize,
    done: AtomicU64,
}

impl Watched {
    pub fn new(meshes: &[Mesh]) -> Self {
        Self { all: meshes.iter().map(|mesh| mesh.triangles.len()).sum(), done: AtomicU64::new(0) }
    }

    /// A share of this mesh is done, and all that was said to be.
    pub fn part(&self, mesh: &Mesh, share: f64) {
        self.tell(self.done.load(Ordering::Relaxed) as f64 + share * mesh.triangles.len() as f64);
    }

    pub fn done(&self, mesh: &Mesh) {
        let count = mesh.triangles.len() as u64;
        self.tell((self.done.fetch_add(count, Ordering::Relaxed) + count) as f64);
    }

    pub fn end(&self) {
        if let Some(watch) = WATCH.get() {
            watch(1.0);
        }
    }

    fn tell(&self, triangles: f64) {
        let share = triangles / self.all.max(1) as f64;
        if let Some(watch) = WATCH.get().filter(|_| share < 1.0) {
            watch(share);
        }
    }
}
