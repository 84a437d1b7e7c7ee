//! Slices of time that nest.

/// Something with a begin and an end, in ns, and how many slices it lies in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slice {
    pub name: String,
    pub begin: i64,
    pub end: i64,
    pub depth: usize,
}

impl Slice {
    pub fn new(name: &str, begin: i64, end: i64) -> Self {
        Self { name: name.to_owned(), begin, end, depth: 0 }
    }
}

/// A track: slices in the order in which they begin, outer ones before inner ones.
#[derive(Clone, Debug, Default)]
pub struct Lane {
    pub slices: Vec<Slice>,
}

impl Lane {
    fn end(&self) -> Option<i64> {
        self.slices.iter().rev().find(|slice| slice.depth == 0).map(|slice| slice.end)
    }
}

/// Adds the steps of a frame to the tracks. A step that begins before the one before it has ended goes to the next
/// track, where it fits. On each track its steps lie in a slice for the frame, `name`.
pub fn lanes(name: &str, mut steps: Vec<Slice>, lanes: &mut Vec<Lane>) {
    steps.sort_by_key(|slice| (slice.begin, slice.end));
    let mut apart: Vec<Vec<Slice>> = Vec::new();
    for step in steps {
        let free = |(index, lane): (usize, &Vec<Slice>)| {
            let after = lane.last().map(|last| last.end).or(lanes.get(index).and_then(Lane::end));
            after.is_none_or(|end| step.begin >= end)
        };
        match apart.iter().enumerate().position(free) {
            Some(lane) => apart[lane].push(step),
            None => {
                // Tracks that are busy with an earlier frame are passed by.
                while lanes.get(apart.len()).and_then(Lane::end).is_some_and(|end| step.begin < end) {
                    apart.push(Vec::new());
                }
                apart.push(vec![step]);
            }
        }
    }
    for (index, steps) in apart.into_iter().enumerate() {
        if lanes.len() <= index {
            lanes.push(Lane::default());
        }
        let ends = steps.first().zip(steps.last()).map(|(first, last)| (first.begin, last.end));
        if let Some((begin, end)) = ends {
            lanes[index].slices.extend(nested(Some(Slice::new(name, begin, end)), in_parts(steps)));
        }
    }
}

/// `inner` one level down in `outer`.
pub fn nested(outer: Option<Slice>, inner: Vec<Slice>) -> Vec<Slice> {
    let inner = inner.into_iter().map(|slice| Slice { depth: slice.depth + 1, ..slice });
    outer.into_iter().chain(inner).collect()
}

/// Puts steps that follow one another and whose paths begin alike into a slice of that name.
fn in_parts(steps: Vec<Slice>) -> Vec<Slice> {
    let mut slices = Vec::new();
    let mut rest = steps.into_iter().peekable();
    while let Some(step) = rest.next() {
        let Some((part, name)) =
            step.name.split_once('/').map(|(part, name)| (part.to_owned(), name.to_owned()))
        else {
            slices.push(step);
            continue;
        };
        let mut members = vec![Slice { name, ..step }];
        let same = |next: &Slice| next.name.split_once('/').is_some_and(|(other, _)| other == part);
        while let Some(next) = rest.next_if(same) {
            let name = next.name[part.len() + 1..].to_owned();
            members.push(Slice { name, ..next });
        }
        let ends = members.first().zip(members.last()).map(|(first, last)| (first.begin, last.end));
        let outer = ends.map(|(begin, end)| Slice::new(&part, begin, end));
        slices.extend(nested(outer, in_parts(members)));
    }
    slices
}
