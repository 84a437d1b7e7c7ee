//! Animations of nodes, as tracks. All animations of a file play at once, each starting again after its own end.

use super::accessor::floats;
use super::file::File;
use super::notes::{Fault, Notes};
use crate::scene::motion::{Interpolation, Keys, Property, Track};
use glam::{DQuat, DVec4};
use gltf::json::animation::{Animation, Channel, Interpolation as Json, Property as Target};
use gltf::json::validation::Checked;
use std::collections::BTreeMap;

/// The tracks of each animated node, by its index.
pub fn tracks(file: &File, notes: &mut Notes) -> BTreeMap<usize, Vec<Track>> {
    let mut all: BTreeMap<usize, Vec<Track>> = BTreeMap::new();
    for (index, animation) in file.root.animations.iter().enumerate() {
        let mut duration = 0.0_f64;
        let mut own: Vec<(usize, Track)> = Vec::new();
        for (i, channel) in animation.channels.iter().enumerate() {
            let track = track(file, animation, channel, notes);
            let track = notes.catch(format_args!("/animations/{index}/channels/{i}"), track).flatten();
            duration = track.iter().fold(duration, |longest, track| longest.max(track.keys.end()));
            own.extend(track.map(|track| (channel.target.node.value(), track)));
        }
        for (node, track) in own {
            let tracks = all.entry(node).or_default();
            if tracks.iter().any(|other| other.property == track.property) {
                notes.lack("second animation of a node", "left out");
            } else {
                tracks.push(Track { duration, ..track });
            }
        }
    }
    all
}

fn track(
    file: &File,
    animation: &Animation,
    channel: &Channel,
    notes: &mut Notes,
) -> Result<Option<Track>, Fault> {
    let (node, nodes) = (channel.target.node.value(), file.root.nodes.len());
    if node >= nodes {
        return Err(Fault::beyond("node", node, nodes));
    }
    let property = match channel.target.path {
        Checked::Valid(Target::Translation) => Property::Translation,
        Checked::Valid(Target::Rotation) => Property::Rotation,
        Checked::Valid(Target::Scale) => Property::Scale,
        Checked::Valid(Target::MorphTargetWeights) => {
            notes.lack("animation of morph targets", "not played");
            return Ok(None);
        }
        Checked::Invalid => return Err(value("the target's path is none that glTF has")),
    };
    let (index, count) = (channel.sampler.value(), animation.samplers.len());
    let sampler = animation.samplers.get(index).ok_or_else(|| Fault::beyond("sampler", index, count))?;
    let interpolation = match sampler.interpolation {
        Checked::Valid(Json::Step) => Interpolation::Step,
        Checked::Valid(Json::Linear) => Interpolation::Linear,
        Checked::Valid(Json::CubicSpline) => Interpolation::Spline,
        Checked::Invalid => return Err(value("the interpolation is none that glTF has")),
    };
    let input = file.root.accessors.get(sampler.input.value());
    if input.is_some_and(|input| input.buffer_view.is_none() && input.sparse.is_none()) {
        notes.lack("animation of keys without times", "not played");
        return Ok(None);
    }
    let times: Vec<f64> = floats::<1>(file, sampler.input)?.into_iter().map(|[t]| f64::from(t)).collect();
    let values: Vec<DVec4> = if property == Property::Rotation {
        floats::<4>(file, sampler.output)?.into_iter().map(|v| DVec4::from(v.map(f64::from))).collect()
    } else {
        let list = floats::<3>(file, sampler.output)?;
        list.into_iter().map(|[x, y, z]| DVec4::new(x.into(), y.into(), z.into(), 0.0)).collect()
    };
    // Many channels may share one list of times.
    file.budget.hold((times.len() * size_of::<f64>() + values.len() * size_of::<DVec4>()) as u64)?;
    let keys = checked(Keys { interpolation, times, values }, property)?;
    Ok(Some(Track { property, duration: keys.end(), keys }))
}

/// The keys, if they are as [`Keys`] says.
fn checked(keys: Keys, property: Property) -> Result<Keys, Fault> {
    let per_key = if keys.interpolation == Interpolation::Spline { 3 } else { 1 };
    let (times, values) = (&keys.times, &keys.values);
    if times.is_empty() || values.len() != times.len() * per_key {
        let message = format!("{} keys can't have {} values", times.len(), values.len());
        return Err(value(&message));
    }
    let growing = times.windows(2).all(|pair| pair[0] <= pair[1]);
    if !(growing && times[0] >= 0.0 && times[times.len() - 1].is_finite()) {
        return Err(value("the times of the keys must not fall, and begin at 0 or later"));
    }
    if !values.iter().all(|v| v.is_finite()) {
        return Err(value("a key is not finite"));
    }
    // Tangents of a spline may be anything.
    let mut quaternions = values.iter().skip(per_key / 2).step_by(per_key).map(|v| DQuat::from_vec4(*v));
    if property == Property::Rotation && !quaternions.all(|q| q.length() > 1e-6) {
        return Err(value("a rotation is no unit quaternion"));
    }
    Ok(keys)
}

fn value(message: &str) -> Fault {
    Fault::new("gltf-animation", message)
}
