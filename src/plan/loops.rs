//! `Each` and `Repeat`: loops as the stages of all their rounds.

use super::walk::{Around, MAX_STAGES, Walk};
use super::world::Live;
use super::{Condition, Element, ElementOf, Named, ResourceId, ResourceKind, Start, resources};
use crate::document::{Cause, ExprText, Over, Spanned, Stage};
use crate::expr::Value;
use crate::problem::{Place, Problem};

/// The rounds of a loop.
struct Rounds {
    /// Where there is none, or it is unknown how many, one that stands for all.
    indices: Vec<u32>,
    /// Fails where there are none, unknown where that is.
    condition: Condition,
}

impl Rounds {
    /// `none` and `unknown` are what to say in the stage's condition.
    fn new(
        indices: Option<Vec<u32>>,
        first: u32,
        none: impl Into<String>,
        unknown: impl Into<String>,
    ) -> Self {
        match indices {
            None => Self { indices: vec![first], condition: Condition::Unknown(unknown.into()) },
            Some(none_of_them) if none_of_them.is_empty() => {
                Self { indices: vec![first], condition: Condition::Fails(none.into()) }
            }
            Some(indices) => Self { indices, condition: Condition::Holds },
        }
    }
}

impl<'a> Walk<'_, 'a> {
    pub fn each(
        &mut self,
        name: &Spanned<String>,
        over: &'a Spanned<Over>,
        when: Option<&ExprText>,
        stages: &'a [Spanned<Stage>],
        around: &Around,
    ) {
        let around = self.inside(when, around);
        let of = match over.value {
            Over::Range(..) | Over::Mips(_) => ElementOf::Range,
            Over::Lights(_) => ElementOf::Light,
            Over::Views => ElementOf::View,
        };
        let Some(rounds) = self.rounds_of(over, &around) else { return };
        let condition = around.condition.and(rounds.condition);
        for index in rounds.indices {
            self.rounds += 1;
            if self.full || self.exhausted(&over.place) {
                return;
            }
            let scope = self.world.add_scope(Some(around.scope));
            self.world.declare(scope, &name.value, Named::Index(Value::Number(index.into())), &name.place);
            let mut round = Around { scope, condition: condition.clone(), ..around.clone() };
            round.suffix += &format!("[{index}]");
            round.elements.push(Element { name: name.value.clone(), index, of });
            self.stages(stages, &round);
        }
    }

    fn rounds_of(&mut self, over: &Spanned<Over>, around: &Around) -> Option<Rounds> {
        let live = around.live();
        Some(match &over.value {
            Over::Range(from, to) => {
                let first = self.world.whole(from, around.scope, 0, live);
                let end = self.world.whole(to, around.scope, 0, live);
                let indices = match first.zip(end) {
                    Some((first, end)) => Some(self.range(first, end, &over.place)?),
                    None => None,
                };
                let first = u32::try_from(first.unwrap_or(0)).unwrap_or(0);
                let none = format!("no elements: nothing is from {first} to before {}", end.unwrap_or(0));
                let [from, to] = [from, to].map(|text| text.value.trim());
                Rounds::new(
                    indices,
                    first,
                    none,
                    format!("the number of elements from {from} to before {to}"),
                )
            }
            Over::Mips(text) => {
                let resource = self.reference(text, around.scope, around)?.resource;
                let ResourceKind::Texture { mips, .. } = self.world.resource(resource).0 else {
                    let problem = Problem::input("not-a-texture", format!("`{}` has no mips", text.value));
                    self.world.report(problem.at(&text.place, "a texture should be here"));
                    return None;
                };
                let indices = mips.map(|mips| (0..mips).collect());
                Rounds::new(indices, 0, "no elements", format!("the number of mips of {}", text.value))
            }
            Over::Lights(kind) => {
                let lights = self.world.setup.elements.as_ref().map(|elements| &elements.lights);
                let indices = lights.map(|lights| {
                    let wanted =
                        |i: &u32| matches!(&*kind.value, "all") || lights[*i as usize].name() == kind.value;
                    (0..lights.len() as u32).filter(wanted).collect()
                });
                let what =
                    if kind.value == "all" { "lights".to_owned() } else { format!("{} lights", kind.value) };
                let none = format!("no elements: there are 0 {what}");
                Rounds::new(indices, 0, none, format!("the number of {what}"))
            }
            Over::Views => {
                let views = self.world.setup.elements.as_ref().map(|elements| (0..elements.views).collect());
                Rounds::new(views, 0, "no elements: there are 0 views", "the number of views")
            }
        })
    }

    /// The numbers of a range, if they are not too many.
    fn range(&self, first: u64, end: u64, place: &Place) -> Option<Vec<u32>> {
        let last = u32::try_from(end.max(first)).ok();
        match last.filter(|_| end.saturating_sub(first) <= MAX_STAGES as u64) {
            Some(_) => Some((first..end).filter_map(|index| u32::try_from(index).ok()).collect()),
            None => {
                let message =
                    format!("a loop from {first} to {end} is too long: {MAX_STAGES} rounds are the most");
                let problem = Problem::input("too-many-stages", message).at(place, "this loop");
                self.world.report(problem.help("loops in kernels have no such limit"));
                None
            }
        }
    }

    pub fn repeat(
        &mut self,
        times: &'a ExprText,
        swap: &[(Spanned<String>, Spanned<String>)],
        when: Option<&ExprText>,
        stages: &'a [Spanned<Stage>],
        around: &Around,
    ) {
        let around = self.inside(when, around);
        let count = self.world.whole(times, around.scope, 0, around.live());
        let Some(indices) = count.map_or(Some(None), |count| self.range(0, count, &times.place).map(Some))
        else {
            return;
        };
        let text = times.value.trim();
        let rounds = Rounds::new(
            indices,
            0,
            format!("repeated 0 times: {text} is 0"),
            format!("repeated {text} times"),
        );
        let pairs: Vec<_> = swap.iter().filter_map(|pair| self.pair(pair, &around)).collect();
        let per_frame =
            self.world.causes(times, around.scope).contains(&Cause::Frame).then_some(&times.place);
        if let (Some(place), Some((a, _))) = (per_frame.or(around.per_frame.as_ref()), swap.first()) {
            let problem =
                Problem::input("swap-per-frame", "what names mean can't change from frame to frame")
                    .at(place, "depends on the frame")
                    .at(&a.place, "changes names");
            self.world.report(problem);
        }
        let before = self.swapped.clone();
        let around = Around { condition: around.condition.and(rounds.condition), ..around };
        for index in rounds.indices {
            self.rounds += 1;
            if self.full || self.exhausted(&times.place) {
                break;
            }
            let mut round = around.clone();
            round.suffix += &format!("[{index}]");
            self.stages(stages, &round);
            for pair in &pairs {
                self.swap(pair);
            }
        }
        if around.live() == Live::No {
            self.swapped = before;
        }
    }

    fn swap(&mut self, pair: &[(ResourceId, Place); 2]) {
        let means = |(id, _): &(ResourceId, Place)| self.swapped.get(id).copied().unwrap_or(*id);
        let [a, b] = pair;
        let (now_a, now_b) = (means(a), means(b));
        for ((name, place), means) in [(a, now_b), (b, now_a)] {
            self.swap_places.insert(*name, place.clone());
            if *name == means {
                self.swapped.remove(name);
            } else {
                self.swapped.insert(*name, means);
            }
        }
    }

    /// The two whole resources of a pair, which must be alike.
    fn pair(
        &mut self,
        pair: &(Spanned<String>, Spanned<String>),
        around: &Around,
    ) -> Option<[(ResourceId, Place); 2]> {
        let side = |text: &Spanned<String>| {
            let reference = self.world.reference(text, around.scope, around.live())?;
            if reference == reference.resource.into() {
                return Some(reference.resource);
            }
            let problem =
                Problem::input("bad-swap", format!("`{}` is only a piece of a resource", text.value));
            self.world.report(problem.at(&text.place, "only whole resources change names"));
            None
        };
        let (a, b) = (side(&pair.0), side(&pair.1));
        let (a, b) = (a?, b?);
        let world = &self.world;
        let start = |id: ResourceId| resources::start(world.resources[id].declared);
        let message = if a == b {
            format!("`{}` and `{}` are the same resource", pair.0.value, pair.1.value)
        } else if start(a) == Start::Given || start(b) == Start::Given {
            "what the scene gives can't change names".to_owned()
        } else if (world.resource(a).0, start(a)) != (world.resource(b).0, start(b)) {
            format!("`{}` and `{}` are not alike, so they can't change names", pair.0.value, pair.1.value)
        } else {
            return Some([(a, pair.0.place.clone()), (b, pair.1.place.clone())]);
        };
        let problem = Problem::input("bad-swap", message)
            .at(&pair.0.place, "this")
            .at(&pair.1.place, "and this")
            .at(&world.resources[a].place, "declared here")
            .at(&world.resources[b].place, "and here");
        self.world.report(problem.help("both need the same format, size, mips, layers and start"));
        None
    }

    /// The names of kept resources must end as they began: the next frame begins with them.
    pub fn check_kept(&self) {
        let kept = |id: &ResourceId| {
            matches!(resources::start(self.world.resources[*id].declared), Start::Kept { .. })
        };
        let moved: Vec<_> =
            self.swap_places.iter().filter(|(id, _)| self.swapped.contains_key(id) && kept(id)).collect();
        if moved.is_empty() {
            return;
        }
        let problem = Problem::input("swap-kept", "resources are kept, but end the frame under other names");
        let problem = moved.into_iter().fold(problem, |problem, (id, place)| {
            problem.at(place, format!("`{}` changes names here", self.world.resources[*id].path))
        });
        self.world.report(problem.help("an even number of rounds leaves the names as they were"));
    }
}
