//! Sweeps: from a pipeline and lists of values to what is compared.

use super::Subject;
use crate::problem::{Problem, Result};

/// Along what a sweep goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Its name and values.
    Knob(String, Vec<String>),
    /// A role, and the parts that take it.
    Part(String, Vec<String>),
    /// The flag of an effect, which is simulated and left out.
    Effect(String),
}

impl Axis {
    pub fn key(&self) -> &str {
        match self {
            Self::Knob(key, _) | Self::Part(key, _) | Self::Effect(key) => key,
        }
    }

    /// How many values it has.
    fn count(&self) -> usize {
        match self {
            Self::Knob(_, values) | Self::Part(_, values) => values.len(),
            Self::Effect(_) => 2,
        }
    }

    fn set(&self, value: usize, subject: &mut Subject) {
        match self {
            Self::Knob(key, values) => subject.sets.push((key.clone(), values[value].clone())),
            Self::Part(key, values) => subject.parts.push((key.clone(), values[value].clone())),
            Self::Effect(key) => subject.effects.push((key.clone(), value == 0)),
        }
    }
}

/// Which of all settings are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Every combination of values.
    Grid,
    /// The first value of each axis, and from there one axis at a time.
    OneAtATime,
}

/// Settings that a sweep may have.
const MOST: usize = 10_000;

/// All settings of the axes, on top of `base`; each once.
pub fn expand(base: &Subject, axes: &[Axis], order: Order) -> Result<Vec<Subject>> {
    let count = match order {
        Order::Grid => axes.iter().try_fold(1_usize, |count, axis| count.checked_mul(axis.count())),
        Order::OneAtATime => Some(axes.iter().map(Axis::count).sum()),
    };
    if count.is_none_or(|count| count > MOST) {
        let message = format!("the sweep has more than {MOST} settings");
        return Err(Problem::input("long-sweep", message)
            .help("give fewer values, or `--one-at-a-time`")
            .into());
    }
    let mut settings = vec![vec![0; axes.len()]];
    for (index, axis) in axes.iter().enumerate() {
        let from = match order {
            Order::Grid => std::mem::take(&mut settings),
            Order::OneAtATime => vec![vec![0; axes.len()]],
        };
        let skipped = usize::from(order == Order::OneAtATime);
        for setting in from {
            settings.extend((skipped..axis.count()).map(|value| {
                let mut setting = setting.clone();
                setting[index] = value;
                setting
            }));
        }
    }
    let subject = |setting: Vec<usize>| {
        let mut subject = base.clone();
        for (axis, value) in axes.iter().zip(setting) {
            axis.set(value, &mut subject);
        }
        subject
    };
    Ok(settings.into_iter().map(subject).collect())
}

/// Every `of`-th of all, from `number` on, which counts from 1: together the shards have each once.
pub fn shard(all: Vec<Subject>, number: usize, of: usize) -> Vec<Subject> {
    all.into_iter().skip(number - 1).step_by(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn axes() -> Vec<Axis> {
        let texts = |values: &[&str]| values.iter().map(|v| (*v).to_owned()).collect();
        vec![
            Axis::Knob("a".to_owned(), texts(&["1", "2", "3"])),
            Axis::Part("r".to_owned(), texts(&["x", "y"])),
            Axis::Knob("b".to_owned(), texts(&["7"])),
        ]
    }

    fn base() -> Subject {
        let sets = vec![("c".to_owned(), "0".to_owned())];
        Subject { pipeline: "p".to_owned(), sets, ..Subject::default() }
    }

    fn names(subjects: &[Subject]) -> Vec<String> {
        subjects.iter().map(Subject::name).collect()
    }

    #[test]
    fn grids_have_every_combination_once() {
        let all = expand(&base(), &axes(), Order::Grid).expect("a few");
        assert_eq!(all.len(), 6);
        assert_eq!(names(&all).iter().collect::<BTreeSet<_>>().len(), 6);
        assert!(names(&all).contains(&"p, r=y, c=0, a=3, b=7".to_owned()));
    }

    #[test]
    fn one_at_a_time_leaves_the_others_at_their_first() {
        let all = names(&expand(&base(), &axes(), Order::OneAtATime).expect("a few"));
        let expected = [
            "p, r=x, c=0, a=1, b=7",
            "p, r=x, c=0, a=2, b=7",
            "p, r=x, c=0, a=3, b=7",
            "p, r=y, c=0, a=1, b=7",
        ];
        assert_eq!(all, expected);
    }

    #[test]
    fn effects_are_simulated_and_left_out() {
        let axes = [axes()[1].clone(), Axis::Effect("scene.emissive".to_owned())];
        let all = names(&expand(&base(), &axes, Order::OneAtATime).expect("a few"));
        let expected = [
            "p, r=x, c=0, scene.emissive=true",
            "p, r=y, c=0, scene.emissive=true",
            "p, r=x, c=0, scene.emissive=false",
        ];
        assert_eq!(all, expected);
    }

    #[test]
    fn shards_share_out_all_of_them() {
        let all = expand(&base(), &axes(), Order::Grid).expect("a few");
        let shards: Vec<Subject> = (1..=4).flat_map(|number| shard(all.clone(), number, 4)).collect();
        let sorted = |subjects: &[Subject]| names(subjects).into_iter().collect::<BTreeSet<_>>();
        assert_eq!((shards.len(), sorted(&shards)), (6, sorted(&all)));
    }

    #[test]
    fn endless_sweeps_are_refused() {
        let mut axes = axes();
        for axis in &mut axes {
            *axis = Axis::Knob(axis.key().to_owned(), (0..100).map(|v| v.to_string()).collect());
        }
        assert!(expand(&base(), &axes, Order::Grid).is_err());
        assert!(expand(&base(), &axes, Order::OneAtATime).is_ok());
    }
}
