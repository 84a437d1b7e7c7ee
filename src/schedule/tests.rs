//! Small cases worked out by hand. What must hold of any work is in `tests/schedule_properties.rs`.

use std::collections::BTreeSet;

use super::*;

/// Items `a`, `b`, … of one cell each, with these starts.
fn items(starts: &[Start]) -> Vec<Item> {
    let name = |index: usize| char::from(b'a' + index as u8).to_string();
    let pool = Pool::Heap { heap: 0, alignment: 256 };
    let item = |(index, &start)| Item { name: name(index), cells: 1, bytes: 1024, start, pool };
    starts.iter().enumerate().map(item).collect()
}

fn cell(item: usize) -> Cell {
    Cell { item, cell: 0 }
}

fn task(path: &str, reads: &[usize], writes: &[usize], depends: &[u32]) -> Task {
    let read = reads.iter().map(|&item| Touch { cell: cell(item), read: true, write: false });
    let write = writes.iter().map(|&item| Touch { cell: cell(item), read: false, write: true });
    Task {
        path: path.to_owned(),
        touches: read.chain(write).collect(),
        depends: depends.iter().copied().collect(),
        off: None,
    }
}

fn all(varying: &[u32]) -> Options {
    Options { reuse: true, drop: true, keep: true, varying: varying.iter().copied().collect() }
}

/// By task, what makes it run again.
fn reruns(schedule: &Schedule) -> Vec<Vec<u32>> {
    let of = |fate: &Fate| match fate {
        Fate::Run { step } => schedule.steps[*step].reruns().iter().copied().collect(),
        Fate::Dropped(reason) => panic!("dropped: {reason}"),
    };
    schedule.fates.iter().map(of).collect()
}

#[test]
fn what_depends_on_less_is_kept_and_survives() {
    let work = Work {
        items: items(&[Start::Covered, Start::Covered, Start::Covered]),
        tasks: vec![
            task("build", &[], &[0], &[]),
            task("look", &[0], &[1], &[5]),
            task("show", &[1], &[2], &[]),
        ],
        outputs: vec![cell(2)],
    };
    let schedule = schedule(&work, &all(&[5])).unwrap();
    assert_eq!(reruns(&schedule), [vec![], vec![5], vec![5]]);
    // `b` is written whenever it is read; `a` is not, and `c` is shown in each frame.
    let retained: Vec<bool> = schedule.places.iter().map(|place| place.retained).collect();
    assert_eq!(retained, [true, false, true]);
    assert_eq!((schedule.memory.kept_bytes, schedule.memory.peak_bytes), (2048, 1024));

    let mut done = Vec::new();
    schedule.runs(Changed::Only(&BTreeSet::new()), &mut done);
    assert!(done.iter().all(|done| !done), "nothing changed");
    schedule.runs(Changed::All, &mut done);
    assert!(done.iter().all(|done| *done), "the first frame");
}

#[test]
fn who_reads_between_two_writes_brings_the_writers_back() {
    let work = Work {
        items: items(&[Start::Fill, Start::Covered]),
        tasks: vec![
            task("first", &[], &[0], &[]),
            task("between", &[0], &[1], &[5]),
            task("second", &[], &[0], &[]),
        ],
        outputs: vec![cell(0), cell(1)],
    };
    assert_eq!(reruns(&schedule(&work, &all(&[5])).unwrap()), [[5], [5], [5]]);
}

#[test]
fn who_reads_the_frame_before_runs_in_each_frame() {
    let history =
        |tasks| Work { items: items(&[Start::Kept, Start::Covered]), tasks, outputs: vec![cell(1)] };
    let before = history(vec![task("blend", &[0], &[1], &[]), task("remember", &[1], &[0], &[])]);
    assert_eq!(reruns(&schedule(&before, &all(&[])).unwrap()), [[FRAME], [FRAME]]);
    // What is read after all writes changes only with them.
    let after = history(vec![task("update", &[], &[0], &[5]), task("blend", &[0], &[1], &[])]);
    assert_eq!(reruns(&schedule(&after, &all(&[5])).unwrap()), [[5], [5]]);
}

/// What is promised to be steady is kept where all that its readers write is so too; a reader that shows what it finds
/// there before it is written again shows another thing one frame later.
#[test]
fn steady_state_is_kept_but_not_what_shows_it_early() {
    let of = |tasks| Work {
        items: items(&[Start::Steady, Start::Steady, Start::Covered]),
        tasks,
        outputs: vec![cell(2)],
    };
    let clear = || task("clear", &[0, 1], &[0], &[]);
    let add = || task("add", &[], &[0, 1], &[5]);
    let kept = of(vec![clear(), add(), task("show", &[0], &[2], &[])]);
    assert_eq!(reruns(&schedule(&kept, &all(&[5])).unwrap()), [[5], [5], [5]]);
    let early = of(vec![task("show", &[0], &[2], &[]), clear(), add()]);
    assert_eq!(reruns(&schedule(&early, &all(&[5])).unwrap())[0], [FRAME]);
}

/// A stage that is off and could not be bound stays off without dropping.
#[test]
fn what_is_bound_to_nothing_never_runs() {
    let mut work = Work {
        items: items(&[Start::Fill]),
        tasks: vec![task("nothing", &[], &[], &[]), task("show", &[], &[0], &[])],
        outputs: vec![cell(0)],
    };
    work.tasks[0].off = Some("no elements".to_owned());
    let found = schedule(&work, &Options { drop: false, ..all(&[]) }).unwrap();
    let reason = "no elements, and there is nothing that it could be bound to";
    assert_eq!(found.fates[0], Fate::Dropped(reason.to_owned()));
}

#[test]
fn what_is_dropped_says_why() {
    let mut work = Work {
        items: items(&[Start::Fill, Start::Covered, Start::Fill]),
        tasks: vec![
            task("off", &[], &[0], &[]),
            task("idle", &[], &[1, 2], &[]),
            task("late", &[0], &[], &[]),
        ],
        outputs: vec![cell(0)],
    };
    work.tasks[0].off = Some("the scene has no lights".to_owned());
    let dropped = schedule(&work, &all(&[])).unwrap();
    let reasons = [
        "the scene has no lights",
        "nothing that an output needs reads what it writes (`b`, `c`)",
        "it writes nothing",
    ];
    assert_eq!(dropped.fates, reasons.map(|reason| Fate::Dropped(reason.to_owned())));
    // The output holds its start, which nothing writes over.
    assert_eq!(dropped.steps, [Step::Start { item: 0, cells: vec![0], reruns: BTreeSet::new() }]);

    let all_that_can = schedule(&work, &Options { drop: false, ..all(&[]) }).unwrap();
    let reason = "the scene has no lights, and running it all the same could change `a`";
    assert_eq!(all_that_can.fates[0], Fate::Dropped(reason.to_owned()));
    assert!(matches!(all_that_can.fates[1..], [Fate::Run { .. }, Fate::Run { .. }]));
}

#[test]
fn a_chain_needs_two_places() {
    let count = 12;
    let mut work = Work { items: items(&vec![Start::Covered; count]), ..Work::default() };
    work.tasks.push(task("0", &[], &[0], &[]));
    work.tasks.extend((1..count).map(|index| task(&index.to_string(), &[index - 1], &[index], &[])));
    work.outputs.push(cell(count - 1));
    let schedule = schedule(&work, &Options { keep: false, ..all(&[]) }).unwrap();
    assert_eq!(schedule.memory.peak_bytes, 2 * 1024);
    assert_eq!(schedule.memory.without_reuse_bytes, 12 * 1024);
}

#[test]
fn work_with_mistakes_is_refused() {
    let good = Work { items: items(&[Start::Fill]), tasks: vec![task("t", &[0], &[], &[])], outputs: vec![] };
    let refused = |change: fn(&mut Work)| {
        let mut work = good.clone();
        change(&mut work);
        schedule(&work, &all(&[])).unwrap_err()
    };
    assert_eq!(refused(|work| work.items[0].cells = 0), "t touches cell 0 of `a`, which has 0");
    assert_eq!(refused(|work| work.outputs.push(cell(7))), "an output touches item 7 of 1");
    let huge = refused(|work| work.items[0].bytes = u64::MAX);
    assert_eq!(huge, "the sizes of all items add up to more than 2^64 bytes");
}
