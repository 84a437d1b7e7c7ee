//! What must hold of the schedule of any work.

mod schedule_reference;

use std::collections::{BTreeMap, BTreeSet};

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use schedule_reference::frames::{self, World};
use schedule_reference::generate::{
    changes, crowded, options, pipeline, rough_work, shuffled, wild_work, work,
};
use schedule_reference::machine::{self, share};
use schedule_reference::{conflict, order, reads, rules, running, step_cells, touches, writes};
use voxgi::schedule::{
    Cell, Changed, FRAME, Fate, Life, Options, Placement, Pool, Schedule, Start, Step, Work, schedule,
};

/// Schedules work that has no mistakes.
fn of(work: &Work, options: &Options) -> Schedule {
    schedule(work, options).expect("good work")
}

/// From the first to the last step that touches an item, read off the steps.
fn life(work: &Work, schedule: &Schedule, item: usize) -> Option<Life> {
    let touches = |step: &Step| step_cells(work, step).iter().any(|cell| cell.item == item);
    let mut at: Vec<usize> = (0..schedule.steps.len()).filter(|&i| touches(&schedule.steps[i])).collect();
    at.extend(work.outputs.iter().any(|cell| cell.item == item).then_some(schedule.steps.len()));
    Some(Life { first: *at.first()?, last: *at.last()? })
}

/// By heap and pool, the bytes of the largest set of shareable items alive at once; added.
fn largest_set(work: &Work, schedule: &Schedule) -> u64 {
    let mut pools: BTreeMap<Pool, Vec<u64>> = BTreeMap::new();
    let mut alone = 0;
    for (index, item) in work.items.iter().enumerate() {
        let (Some(life), false) = (life(work, schedule, index), schedule.places[index].retained) else {
            continue;
        };
        let pool = match item.pool {
            _ if item.start == Start::Given => continue,
            Pool::Alone => {
                alone += item.bytes;
                continue;
            }
            Pool::Heap { heap, .. } => Pool::Heap { heap, alignment: 0 },
            alike @ Pool::Alike(_) => alike,
        };
        let alive = pools.entry(pool).or_insert_with(|| vec![0; schedule.steps.len() + 1]);
        alive[life.first..=life.last].iter_mut().for_each(|bytes| *bytes += item.bytes);
    }
    alone + pools.into_values().map(|alive| alive.into_iter().max().unwrap_or(0)).sum::<u64>()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_order_is_a_permutation_of_what_runs_and_respects_every_conflict(
        work in rough_work(), options in options(),
    ) {
        let schedule = of(&work, &options);
        let order = order(&schedule);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        prop_assert_eq!(sorted, running(&schedule));
        for (at, &later) in order.iter().enumerate() {
            let Fate::Run { step } = schedule.fates[later] else { unreachable!("it runs") };
            let is_it = matches!(schedule.steps[step], Step::Run { task, .. } if task == later);
            prop_assert!(is_it);
            for &earlier in &order[..at] {
                prop_assert!(earlier < later || !conflict(&work, earlier, later), "{} {}", earlier, later);
            }
        }
        prop_assert_eq!(of(&work, &options), schedule);
    }

    #[test]
    fn each_cell_starts_once_directly_before_it_is_first_touched(work in rough_work(), options in options()) {
        let schedule = of(&work, &options);
        let mut touched: BTreeSet<Cell> = BTreeSet::new();
        let mut starting: BTreeSet<Cell> = BTreeSet::new();
        for step in &schedule.steps {
            let cells = step_cells(&work, step);
            if let Step::Start { item, .. } = step {
                prop_assert!(matches!(work.items[*item].start, Start::Fill | Start::Covered));
                prop_assert!(cells.is_disjoint(&touched));
                prop_assert!(cells.is_disjoint(&starting));
                starting.extend(cells);
            } else {
                prop_assert!(starting.is_subset(&cells), "started too early");
                let new = cells.difference(&touched);
                let need = new.filter(|c| matches!(work.items[c.item].start, Start::Fill | Start::Covered));
                prop_assert_eq!(need.copied().collect::<BTreeSet<_>>(), std::mem::take(&mut starting));
                touched.extend(cells);
            }
        }
        // Outputs that nothing touches start at the end.
        prop_assert!(starting.iter().all(|cell| work.outputs.contains(cell)));
        for cell in &work.outputs {
            let starts = matches!(work.items[cell.item].start, Start::Fill | Start::Covered);
            prop_assert!(!starts || touched.contains(cell) || starting.contains(cell));
        }
    }

    #[test]
    fn no_two_items_alive_at_once_share_memory(work in rough_work(), options in options()) {
        let schedule = of(&work, &options);
        for (index, (item, place)) in work.items.iter().zip(&schedule.places).enumerate() {
            let life_of = |item| life(&work, &schedule, item);
            prop_assert_eq!(place.life, life_of(index));
            prop_assert_eq!(place.placement == Placement::Given, item.start == Start::Given);
            let unmade = item.start != Start::Given && place.life.is_none();
            prop_assert_eq!(place.placement == Placement::Unmade, unmade);
            prop_assert!(item.start != Start::Kept || place.retained);
            match (place.placement, item.pool) {
                (Placement::Heap { heap, offset }, Pool::Heap { heap: own, alignment }) => {
                    prop_assert_eq!(heap, own);
                    prop_assert_eq!(offset % alignment, 0);
                    prop_assert!(offset + item.bytes <= schedule.memory.heaps[&heap]);
                }
                (Placement::Object { pool, object }, Pool::Alike(own)) => {
                    prop_assert_eq!(pool, own);
                    prop_assert!((object as usize) < schedule.memory.objects[&pool]);
                }
                (Placement::Heap { .. } | Placement::Object { .. }, _) => prop_assert!(false, "wrong pool"),
                (Placement::Alone, pool) => {
                    prop_assert!(!options.reuse || place.retained || pool == Pool::Alone);
                }
                (Placement::Unmade | Placement::Given, _) => {}
            }
            for other in (0..index).filter(|&other| share(&work, &schedule, index, other)) {
                prop_assert!(options.reuse);
                prop_assert!(!place.retained && !schedule.places[other].retained);
                let (a, b) = (life_of(index).unwrap(), life_of(other).unwrap());
                prop_assert!(a.last < b.first || b.last < a.first, "{} {}", index, other);
            }
        }
    }

    #[test]
    fn memory_adds_up(work in rough_work(), options in options()) {
        let schedule = of(&work, &options);
        let sum = |retained: bool| -> u64 {
            let made = schedule.places.iter().filter(|place| {
                place.retained == retained && !matches!(place.placement, Placement::Unmade | Placement::Given)
            });
            made.map(|place| place.bytes).sum()
        };
        let memory = &schedule.memory;
        prop_assert_eq!(memory.kept_bytes, sum(true));
        prop_assert_eq!(memory.without_reuse_bytes, sum(false));
        if options.reuse {
            prop_assert_eq!(memory.lower_bound_bytes, largest_set(&work, &schedule));
            // Sharing never costs more than it saves, up to what alignment costs.
            let padding = 256 * work.items.len() as u64;
            prop_assert!(memory.peak_bytes >= memory.lower_bound_bytes);
            prop_assert!(memory.peak_bytes <= memory.without_reuse_bytes + padding);
        } else {
            prop_assert_eq!(memory.peak_bytes, memory.without_reuse_bytes);
        }
    }

    #[test]
    fn a_task_is_dropped_exactly_when_no_output_needs_it(work in rough_work(), mut options in options()) {
        options.drop = true;
        let schedule = of(&work, &options);
        for task in 0..work.tasks.len() {
            let needed = work.tasks[task].off.is_none() && rules::is_needed(&work, task);
            match &schedule.fates[task] {
                Fate::Run { .. } => prop_assert!(needed, "{} runs", task),
                Fate::Dropped(reason) => {
                    prop_assert!(!needed, "{} is dropped", task);
                    let names = || writes(&work, task).into_iter().all(|c| reason.contains(&work.items[c.item].name));
                    let says = if work.tasks[task].off.is_some() { reason == "it is off" } else { names() };
                    prop_assert!(says, "{}", reason);
                }
            }
        }
        // Without dropping, all runs that harms nothing live, unless it is off and bound to nothing.
        options.drop = false;
        let all = of(&work, &options);
        let live = running(&schedule);
        let precious: BTreeSet<Cell> =
            live.iter().flat_map(|&task| touches(&work, task)).chain(work.outputs.iter().copied()).collect();
        for task in 0..work.tasks.len() {
            let harmless = live.contains(&task) || writes(&work, task).is_disjoint(&precious);
            let unbound = work.tasks[task].off.is_some() && work.tasks[task].touches.is_empty();
            prop_assert_eq!(matches!(all.fates[task], Fate::Run { .. }), harmless && !unbound);
        }
    }

    #[test]
    fn what_is_read_unwritten_is_told(work in rough_work(), mut options in options()) {
        options.drop = true;
        let told = of(&work, &options);
        options.drop = false;
        prop_assert_eq!(&of(&work, &options).unwritten, &told.unwritten);
        let live = running(&told);
        let covered = |cell: &Cell| work.items[cell.item].start == Start::Covered;
        let unwritten = |cell: &Cell, end: usize| {
            covered(cell) && !live.iter().any(|&task| task < end && writes(&work, task).contains(cell))
        };
        let in_tasks: Vec<(usize, Cell)> = live.iter()
            .flat_map(|&task| reads(&work, task).into_iter().map(move |cell| (task, cell)))
            .filter(|(task, cell)| unwritten(cell, *task))
            .collect();
        prop_assert_eq!(told.unwritten, in_tasks);
        let in_outputs: BTreeSet<Cell> =
            work.outputs.iter().copied().filter(|cell| unwritten(cell, usize::MAX)).collect();
        prop_assert_eq!(told.unwritten_outputs.into_iter().collect::<BTreeSet<_>>(), in_outputs);
    }

    #[test]
    fn a_task_is_kept_exactly_when_nothing_it_depends_on_changed(
        work in rough_work(), mut options in options(), changed in changes(),
    ) {
        options.keep = true;
        let schedule = of(&work, &options);
        let expected = rules::reruns(&work, &running(&schedule), &options.varying);
        let changed: BTreeSet<u32> = changed[0].intersection(&options.varying).copied().collect();
        for (&task, bits) in &expected {
            let Fate::Run { step } = schedule.fates[task] else { unreachable!("it runs") };
            prop_assert_eq!(schedule.steps[step].reruns(), bits, "task {}", task);
            prop_assert!(schedule.is_done(step, Changed::All));
            let again = bits.contains(&FRAME) || !bits.is_disjoint(&changed);
            prop_assert_eq!(schedule.is_done(step, Changed::Only(&changed)), again);
        }
        options.keep = false;
        let schedule = of(&work, &options);
        for step in 0..schedule.steps.len() {
            prop_assert!(schedule.is_done(step, Changed::Only(&BTreeSet::new())));
        }
    }

    #[test]
    fn nothing_that_the_scheduler_does_changes_the_outputs(
        work in work(), options in options(), changes in changes(), reset in any::<bool>(),
    ) {
        let changes: Vec<BTreeSet<u32>> =
            changes.iter().map(|set| set.intersection(&options.varying).copied().collect()).collect();
        let worlds = World::of(&changes);
        let expected = frames::outputs(&work, &worlds, 1);
        prop_assert_eq!(&expected, &frames::outputs(&work, &worlds, 2), "the work itself reads poison");
        let mut told = vec![Changed::All];
        told.extend(changes.iter().map(|bits| if reset { Changed::All } else { Changed::Only(bits) }));
        for switches in 0..8 {
            let (reuse, drop, keep) = (switches & 1 > 0, switches & 2 > 0, switches & 4 > 0);
            let schedule = of(&work, &Options { reuse, drop, keep, varying: options.varying.clone() });
            prop_assert!(schedule.unwritten.is_empty() && schedule.unwritten_outputs.is_empty());
            for poison in [1, 2] {
                let outputs = machine::outputs(&work, &schedule, &worlds, &told, poison);
                prop_assert_eq!(&outputs, &expected, "reuse {}, drop {}, keep {}", reuse, drop, keep);
            }
        }
    }

    #[test]
    fn the_listing_of_independent_tasks_does_not_matter(
        work in rough_work(), options in options(), choices in vec(any::<Index>(), 1..40),
    ) {
        let (shuffled, listed) = shuffled(&work, &choices);
        let (before, mut after) = (of(&work, &options), of(&shuffled, &options));
        for step in &mut after.steps {
            if let Step::Run { task, .. } = step {
                *task = listed[*task];
            }
        }
        let mut fates: Vec<(usize, Fate)> = listed.iter().copied().zip(after.fates).collect();
        fates.sort_by_key(|(task, _)| *task);
        after.fates = fates.into_iter().map(|(_, fate)| fate).collect();
        after.unwritten.iter_mut().for_each(|(task, _)| *task = listed[*task]);
        after.unwritten.sort_unstable();
        prop_assert_eq!(after, before);
    }

    #[test]
    fn sharing_comes_near_the_largest_set_alive_at_once(
        work in prop_oneof![work(), pipeline()], drop in any::<bool>(), keep in any::<bool>(),
    ) {
        let options = Options { reuse: true, drop, keep, varying: BTreeSet::from([1, 2]) };
        let schedule = of(&work, &options);
        let (peak, bound) = (schedule.memory.peak_bytes, largest_set(&work, &schedule));
        prop_assert!(peak * 10 <= bound * 11, "{} for {}", peak, bound);
    }

    #[test]
    fn no_work_makes_it_panic(work in wild_work(), options in options()) {
        if let Ok(schedule) = schedule(&work, &options) {
            prop_assert_eq!(schedule.fates.len(), work.tasks.len());
            prop_assert_eq!(schedule.places.len(), work.items.len());
        }
    }
}

/// A heap that is full of long lives has no place within a tenth of the bound that a short search always finds. One
/// graph in a hundred misses it; these are the same graphs each time.
#[test]
fn sharing_stays_near_the_largest_set_in_crowded_heaps() {
    let mut runner = TestRunner::deterministic();
    let ratios: Vec<f64> = (0..100)
        .map(|_| {
            let work = crowded().new_tree(&mut runner).expect("no filter").current();
            let all = Options { reuse: true, drop: true, keep: false, varying: BTreeSet::new() };
            let schedule = of(&work, &all);
            schedule.memory.peak_bytes as f64 / largest_set(&work, &schedule) as f64
        })
        .collect();
    let beyond = ratios.iter().filter(|ratio| **ratio > 1.1).count();
    assert!(beyond <= 3, "{beyond} of 100 graphs take more than 1.1 times the largest set");
    assert!(ratios.iter().all(|ratio| *ratio <= 1.2), "{ratios:?}");
}
