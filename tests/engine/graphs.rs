//! Random graphs of one kernel over lists, against an interpreter that runs them as they are listed: whatever shares
//! memory and however independent stages are listed.

use crate::bench::{Job, gpu, messages, scene};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use std::fmt::Write;
use std::sync::OnceLock;
use voxgi::scene::Scene;

/// Lists and the stages over them.
#[derive(Clone, Debug)]
struct Mixing {
    /// Elements, and what they begin with; `None`: undefined.
    lists: Vec<(usize, Option<u32>)>,
    stages: Vec<Stage>,
}

/// Reads three lists, which may be the same, and writes all of another.
#[derive(Clone, Copy, Debug)]
struct Stage {
    reads: [usize; 3],
    writes: usize,
}

impl Stage {
    fn conflicts(&self, other: &Self) -> bool {
        let touches = |stage: &Self, list| stage.reads.contains(&list) || stage.writes == list;
        touches(self, other.writes) || touches(other, self.writes)
    }
}

/// Elements of the output: the last list that was written, round and round.
const SHOWN: usize = 64;

impl Mixing {
    /// What the kernel `mix` does, one stage after another.
    fn interpret(&self) -> Vec<u32> {
        let mut lists: Vec<Vec<u32>> =
            self.lists.iter().map(|(count, fill)| vec![fill.unwrap_or(0xdead); *count]).collect();
        for stage in &self.stages {
            let [a, b, c] = stage.reads.map(|list| &lists[list]);
            let element = |i: usize| {
                let (a, b, c) = (a[i % a.len()], b[(i + 1) % b.len()], c[(2 * i) % c.len()]);
                (a.wrapping_mul(3).wrapping_add(b.rotate_left(7)) ^ c.wrapping_mul(2_654_435_761))
                    .wrapping_add(i as u32)
            };
            let count = self.lists[stage.writes].0;
            lists[stage.writes] = (0..count).map(element).collect();
        }
        let last = &lists[self.last()];
        (0..SHOWN).map(|i| last[i % last.len()]).collect()
    }

    fn last(&self) -> usize {
        self.stages.last().map_or(0, |stage| stage.writes)
    }

    /// The pipeline's file, with the stages listed in this order; names stay with the stages.
    fn text(&self, order: &[usize]) -> String {
        let mut text = "Pipeline(about: \"Random.\", resources: {\n".to_owned();
        for (i, (count, fill)) in self.lists.iter().enumerate() {
            let start = fill.map_or("Covered".to_owned(), |value| format!("Fill({value})"));
            let _infallible = writeln!(text, "\"l{i}\": Buffer(count: \"{count}\", start: {start}),");
        }
        let _infallible = writeln!(
            text,
            "\"shown\": Texture(format: \"r32uint\", size: [\"{SHOWN}\", \"1\"], start: Covered)}}, stages: ["
        );
        for number in order {
            let Stage { reads: [a, b, c], writes } = self.stages[*number];
            let _infallible = writeln!(
                text,
                "Compute(name: \"s{number}\", kernel: \"mix\", over: Count(\"{}\"), \
                 bind: {{\"a\": \"l{a}\", \"b\": \"l{b}\", \"c\": \"l{c}\", \"result\": \"l{writes}\"}}),",
                self.lists[writes].0
            );
        }
        let last = self.last();
        let _infallible = writeln!(
            text,
            "Compute(kernel: \"shown_round\", over: Texels(\"shown\"), bind: {{\"list\": \"l{last}\"}})], \
             outputs: {{\"shown\": \"shown\"}})"
        );
        text
    }

    /// Another listing that means the same: neighbours that touch nothing in common change places.
    fn shuffled(&self, seeds: &[prop::sample::Index]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.stages.len()).collect();
        for seed in seeds.iter().filter(|_| self.stages.len() > 1) {
            let i = seed.index(order.len() - 1);
            if !self.stages[order[i]].conflicts(&self.stages[order[i + 1]]) {
                order.swap(i, i + 1);
            }
        }
        order
    }
}

fn mixings() -> impl Strategy<Value = Mixing> {
    let list = (1..600usize, proptest::option::of(any::<u16>().prop_map(u32::from)));
    let stage = (any::<[prop::sample::Index; 3]>(), any::<prop::sample::Index>());
    (prop::collection::vec(list, 3..9), prop::collection::vec(stage, 1..14)).prop_map(
        |(mut lists, choices)| {
            lists[0].1 = Some(1);
            let mut defined: Vec<usize> = (0..lists.len()).filter(|i| lists[*i].1.is_some()).collect();
            let stages = choices.iter().map(|(reads, writes)| {
                let reads = reads.map(|seed| *seed.get(&defined));
                let free: Vec<usize> = (0..lists.len()).filter(|i| !reads.contains(i)).collect();
                let writes = if free.is_empty() { None } else { Some(*writes.get(&free)) };
                defined.extend(writes.filter(|list| !defined.contains(list)));
                writes.map(|writes| Stage { reads, writes })
            });
            let stages = stages.collect::<Vec<_>>().into_iter().flatten().collect();
            Mixing { lists, stages }
        },
    )
}

fn point_lit() -> &'static Scene {
    static SCENE: OnceLock<Scene> = OnceLock::new();
    SCENE.get_or_init(|| scene("cornell-point"))
}

/// What the device makes of a pipeline's text.
fn shown(text: &str, reuse: bool) -> Vec<u32> {
    let file = tempfile::Builder::new().suffix(".ron").tempfile().expect("a file");
    std::fs::write(file.path(), text).expect("a file");
    let mut job = Job::new(point_lit(), &file.path().display().to_string(), [1, 1]);
    job.request.reuse = reuse;
    let mut run = job.start(gpu()).unwrap_or_else(|problems| panic!("{}\n{text}", messages(&problems)));
    run.frames(2).expect("frames");
    run.words("shown")
}

#[test]
fn random_graphs_mean_what_their_order_says() {
    let config = ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() };
    let orders = prop::collection::vec(any::<prop::sample::Index>(), 40);
    let mut shared = 0;
    TestRunner::new(config)
        .run(&(mixings(), orders), |(mixing, seeds)| {
            prop_assume!(!mixing.stages.is_empty());
            let expected = mixing.interpret();
            let listed: Vec<usize> = (0..mixing.stages.len()).collect();
            let text = mixing.text(&listed);
            prop_assert_eq!(&shown(&text, true), &expected, "with reuse");
            prop_assert_eq!(&shown(&text, false), &expected, "without reuse");
            prop_assert_eq!(&shown(&mixing.text(&mixing.shuffled(&seeds)), true), &expected, "shuffled");
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
    // Random graphs share memory often enough for this to say something.
    let mut runner = TestRunner::deterministic();
    for _ in 0..50 {
        let mixing = mixings().new_tree(&mut runner).expect("a graph").current();
        let order: Vec<usize> = (0..mixing.stages.len()).collect();
        let file = tempfile::Builder::new().suffix(".ron").tempfile().expect("a file");
        std::fs::write(file.path(), mixing.text(&order)).expect("a file");
        let prepared = Job::new(point_lit(), &file.path().display().to_string(), [1, 1]).prepare();
        let memory = prepared.unwrap_or_else(|problems| panic!("{}", messages(&problems))).schedule.memory;
        shared += usize::from(memory.peak_bytes < memory.without_reuse_bytes);
    }
    assert!(shared >= 5, "only {shared} of 50 graphs share memory");
}

/// The control: stages that do touch something in common can't change places unnoticed.
#[test]
fn the_order_of_stages_that_conflict_shows() {
    let lists = vec![(50, Some(1)), (70, Some(2)), (90, Some(3))];
    let stages = vec![Stage { reads: [0, 0, 1], writes: 2 }, Stage { reads: [2, 1, 2], writes: 0 }];
    let stages = [stages, vec![Stage { reads: [0, 2, 0], writes: 1 }]].concat();
    let mixing = Mixing { lists, stages };
    assert_eq!(shown(&mixing.text(&[0, 1, 2]), true), mixing.interpret());
    assert_ne!(shown(&mixing.text(&[1, 0, 2]), true), mixing.interpret());
}
