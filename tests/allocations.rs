//! A frame in steady state allocates nothing of the engine's own, and a thousand frames take no more memory than a few.
//!
//! A global allocator takes a backtrace of each allocation while it is asked to. Whose it is says the innermost frame in
//! the files of wgpu or of the engine: what wgpu allocates is wgpu's, unless it does so through a closure of the engine.

#[path = "support/job.rs"]
mod job;

use backtrace::Backtrace;
use job::Job;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

struct Watching;

thread_local! {
    static WATCHED: Cell<bool> = const { Cell::new(false) };
    static TRACES: RefCell<Vec<Backtrace>> = const { RefCell::new(Vec::new()) };
}

/// Notes the allocation if this thread is watched; taking the note is not watched itself.
fn note() {
    if WATCHED.try_with(|watched| watched.replace(false)).unwrap_or(false) {
        TRACES.with(|traces| traces.borrow_mut().push(Backtrace::new_unresolved()));
        WATCHED.with(|watched| watched.set(true));
    }
}

// SAFETY: every call is passed on to the system's allocator as it is.
unsafe impl GlobalAlloc for Watching {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        note();
        // SAFETY: as above.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        note();
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        note();
        // SAFETY: as above.
        unsafe { System.realloc(old, layout, size) }
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(old, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Watching = Watching;

/// How often each place of wgpu and of the engine allocates in `work`; "neither" where none of them does.
fn allocations(work: impl FnOnce()) -> BTreeMap<String, usize> {
    TRACES.with(|traces| traces.borrow_mut().clear());
    WATCHED.with(|watched| watched.set(true));
    work();
    WATCHED.with(|watched| watched.set(false));
    let mut found = BTreeMap::new();
    for mut trace in TRACES.with(RefCell::take) {
        *found.entry(owner(&mut trace)).or_insert(0) += 1;
    }
    found
}

/// The innermost place that is in wgpu's files or in the engine's. Names of inlined functions don't tell their crate.
fn owner(trace: &mut Backtrace) -> String {
    trace.resolve();
    let mut symbols = trace.frames().iter().flat_map(|frame| frame.symbols());
    let place = symbols.find_map(|symbol| {
        let file = symbol.filename()?.to_string_lossy().replace('\\', "/");
        if let Some(ours) = file.strip_prefix(env!("CARGO_MANIFEST_DIR")).or(file.strip_prefix("./")) {
            let ours = ours.trim_start_matches('/');
            return ours
                .starts_with("src/")
                .then(|| format!("voxgi {ours}:{}", symbol.lineno().unwrap_or(0)));
        }
        file.split('/').any(|piece| piece.starts_with("wgpu-")).then(|| "wgpu".to_owned())
    });
    place.unwrap_or_else(|| "neither".to_owned())
}

fn of_voxgi(found: &BTreeMap<String, usize>) -> Vec<(&String, &usize)> {
    found.iter().filter(|(place, _)| place.starts_with("voxgi ")).collect()
}

/// One test at a time: they look at what the whole process takes.
fn alone() -> impl Drop {
    static LOCK: Mutex<()> = Mutex::new(());
    LOCK.lock().unwrap_or_else(PoisonError::into_inner)
}

fn small<'a>(scene: &'a voxgi::scene::Scene, pipeline: &str) -> Job<'a> {
    Job::new(scene, pipeline, [16, 16]).small("16", "16")
}

#[test]
fn a_frame_in_steady_state_allocates_nothing_of_its_own() {
    let _alone = alone();
    let scene = job::scene("cornell-box");
    for pipeline in job::shipped() {
        let poison = Some(voxgi::frame::Poison::Ones);
        let jobs = [
            ("as it is", small(&scene, &pipeline)),
            ("keeping", small(&scene, &pipeline).keep(&[voxgi::document::Cause::Camera])),
            ("by the wall clock", Job { wall_clock: true, ..small(&scene, &pipeline) }),
            ("poisoned", Job { poison, ..small(&scene, &pipeline) }),
        ];
        for (way, job) in jobs {
            let mut run = job.start(job::gpu()).expect("a run");
            run.frames(3).expect("frames");
            let mut encode: Vec<f64> = Vec::new();
            let found = allocations(|| run.frames(2).expect("frames"));
            assert_eq!(of_voxgi(&found), [], "{pipeline} {way}");
            assert_eq!(found.keys().collect::<Vec<_>>(), ["wgpu"], "{pipeline} {way}: or the watch sleeps");
            for _ in 0..20 {
                encode.push(run.frame.run(run.gpu, &run.changes).expect("a frame").encode);
            }
            encode.sort_by(f64::total_cmp);
            println!(
                "{pipeline} {way}: {} steps, encode and submit {:.3} ms (median), {:.3} ms (least); \
                 {} allocations of others in 2 frames",
                run.frame.done().iter().filter(|done| **done).count(),
                encode[encode.len() / 2],
                encode[0],
                found.values().sum::<usize>(),
            );
        }
    }
}

/// The control: an allocation that the engine makes for another purpose, here behind a closure, has its name.
#[test]
fn an_allocation_of_the_engine_is_noticed() {
    let _alone = alone();
    let planted = || std::hint::black_box(voxgi::session::bytes(std::hint::black_box(5000)));
    let found = allocations(|| (0..3).for_each(|_| drop(planted())));
    let total: usize = of_voxgi(&found).iter().map(|(_, count)| **count).sum();
    assert!(total >= 3, "{found:?}");
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1u8; 100]))).get("neither"), Some(&1));
}

/// Pages of memory that this process holds.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn resident_bytes() -> u64 {
    let text = std::fs::read_to_string("/proc/self/statm").expect("/proc/self/statm");
    let pages: u64 = text.split(' ').nth(1).and_then(|pages| pages.parse().ok()).expect("a number of pages");
    4096 * pages
}

/// Returns free memory to the system: what was freed while starting would hide as much of a leak.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn give_back() {
    unsafe extern "C" {
        fn malloc_trim(pad: usize) -> i32;
    }
    // SAFETY: the C library's own function, of that type; any thread may call it at any time.
    unsafe { malloc_trim(0) };
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[test]
fn a_thousand_frames_take_no_more_memory_than_a_few() {
    let _alone = alone();
    let scene = job::scene("cornell-point");
    let mut run = small(&scene, "cones").set("bounces", "1").start(job::gpu()).expect("a run");
    run.frames(100).expect("frames");
    give_back();
    run.frames(100).expect("frames");
    let before = resident_bytes();
    run.frames(1000).expect("frames");
    let grown = resident_bytes().saturating_sub(before);
    println!("1000 frames took {grown} bytes more");
    // A single word leaked per pass would be 1000 × 40 × 8 B = 320 kB; an encoder's memory, far more.
    assert!(grown <= 256 << 10, "{grown} bytes");
    // The control: a leak of a kilobyte a frame shows in this figure.
    give_back();
    let before = resident_bytes();
    let leaked: Vec<Vec<u8>> = (0..1000).map(|_| std::hint::black_box(vec![1; 1024])).collect();
    assert!(resident_bytes().saturating_sub(before) > 512 << 10);
    drop(leaked);
}
