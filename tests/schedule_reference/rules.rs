//! The scheduler's rules by brute force.

use std::collections::{BTreeMap, BTreeSet};

use voxgi::schedule::{Cell, FRAME, Work};

use super::{goes_on, hash, on, reads, writes};

/// Whether an output changes when this task writes something else. Each write leaves part of what was there; as many
/// frames are run as a change can take to come through all that goes on from frame to frame.
pub fn is_needed(work: &Work, task: usize) -> bool {
    shown(work, None) != shown(work, Some(task))
}

fn shown(work: &Work, salted: Option<usize>) -> Vec<u64> {
    let on = on(work);
    let going_on: BTreeSet<Cell> =
        on.iter().flat_map(|&task| writes(work, task)).filter(|&cell| goes_on(work, cell)).collect();
    let mut held: BTreeMap<Cell, u64> = BTreeMap::new();
    let mut shown = Vec::new();
    for _ in 0..going_on.len() + 2 {
        held.retain(|cell, _| going_on.contains(cell));
        for &task in &on {
            let read: Vec<_> = reads(work, task).iter().map(|cell| held.get(cell).copied()).collect();
            for cell in writes(work, task) {
                let before = held.get(&cell).copied();
                held.insert(cell, hash((task, salted == Some(task), &read, before)));
            }
        }
        shown = work.outputs.iter().map(|cell| held.get(cell).copied().unwrap_or(0)).collect();
    }
    shown
}

/// For each task of those that run, what it depends on: the rules of `reruns` applied to pairs of tasks until nothing
/// changes. Only bits that may vary; `FRAME` alone where it is among them.
pub fn reruns(work: &Work, running: &[usize], varying: &BTreeSet<u32>) -> BTreeMap<usize, BTreeSet<u32>> {
    let varies = |bit: &u32| *bit == FRAME || varying.contains(bit);
    let own = |task: usize| work.tasks[task].depends.iter().copied().filter(varies).collect();
    let mut bits: BTreeMap<usize, BTreeSet<u32>> = running.iter().map(|&task| (task, own(task))).collect();
    loop {
        let before = bits.clone();
        for &writer in running {
            for cell in writes(work, writer) {
                for &other in running {
                    let both_write = writes(work, other).contains(&cell);
                    let reads = reads(work, other).contains(&cell);
                    let reads_it = reads && (writer < other || goes_on(work, cell));
                    let sees_what_goes = reads && other <= writer;
                    if both_write || reads_it {
                        let more = bits[&writer].clone();
                        bits.get_mut(&other).unwrap().extend(more);
                    }
                    if sees_what_goes {
                        let more = bits[&other].clone();
                        bits.get_mut(&writer).unwrap().extend(more);
                        if goes_on(work, cell) {
                            bits.get_mut(&other).unwrap().insert(FRAME);
                        }
                    }
                }
            }
        }
        if bits == before {
            break;
        }
    }
    for set in bits.values_mut().filter(|set| set.contains(&FRAME)) {
        *set = BTreeSet::from([FRAME]);
    }
    bits
}
