//! Keys through the clipboard: copied with everything they hold, and put in at the playhead.
//!
//! They go as text, as poses do, so that they reach another take, another model and another program. What the clipboard
//! holds says what a paste does; what a copy takes is up to who was touched last, the timeline or the picture.

use super::{ChannelId, KeySelection, channel};
use crate::panels::pose_commands::named;
use crate::panels::state::{Effect, State};
use crate::panels::status::Level;
use crate::panels::widgets::{count, grouped};
use dragonfly_anim::data::{BoneIndex, Channel, Interpolation, Skeleton, Take};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{Between, BoneRef, CopiedChannel, CopiedKey, Edit, PasteKeys, Property};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Most keys that are copied at once.
pub const MOST: usize = 100_000;
/// Longest text that is looked at, bytes: that many keys fit in.
const LONGEST: usize = 64 << 20;

/// Keys that are selected once they are there.
#[derive(Clone, Debug)]
pub(super) struct Awaited {
    /// They are in a view newer than this.
    generation: u64,
    /// How many keys the take had before.
    before: usize,
    parts: Vec<(ChannelId, Vec<[f32; 2]>)>,
}

/// What is written.
#[derive(Serialize, Deserialize)]
struct Text {
    /// What it is: "keys".
    dragonfly: String,
    version: u32,
    channels: Vec<CopiedChannel>,
}

/// The text of keys.
pub fn to_text(channels: Vec<CopiedChannel>) -> String {
    // Plain data always has a text.
    serde_json::to_string(&Text { dragonfly: "keys".to_owned(), version: 1, channels }).unwrap_or_default()
}

/// The keys in a text; `None` where it is anything else.
pub fn from_text(text: &str) -> Option<Vec<CopiedChannel>> {
    if text.len() > LONGEST {
        return None;
    }
    let text: Text = serde_json::from_str(text.trim()).ok()?;
    let some = text.channels.iter().any(|channel| !channel.keys.is_empty());
    (text.dragonfly == "keys" && text.version == 1 && some).then_some(text.channels)
}

/// The selected keys of a take, at their distances to the first.
pub fn copied(take: &Take, selection: &KeySelection, skeleton: &Skeleton) -> Vec<CopiedChannel> {
    let first = selection.extent(take).map_or(0.0, |[first, _]| first);
    let of = |((bone, property), keys): (ChannelId, &super::intervals::Intervals)| {
        let track = channel::track(take, bone)?;
        let keys = keys.keys(channel::times(take, (bone, property))).flatten();
        let (interpolation, keys) = match property {
            Property::Translation => column(&track.translation, keys, first, |value| value.to_array().into()),
            Property::Rotation => column(&track.rotation, keys, first, |value| value.to_array().into()),
            Property::Scale => column(&track.scale, keys, first, |value| value.to_array().into()),
        };
        let bone = named(skeleton, bone);
        (!keys.is_empty()).then_some(CopiedChannel { bone, property, interpolation, keys })
    };
    selection.channels().filter_map(of).collect()
}

fn column<T: Copy>(
    channel: &Channel<T>,
    keys: impl Iterator<Item = usize>,
    first: f32,
    numbers: impl Fn(T) -> Vec<f32>,
) -> (Between, Vec<CopiedKey>) {
    let between = match channel.interpolation {
        // The nearest key, which no edit can ask for: at the keys both show the same.
        Interpolation::Step | Interpolation::Closest => Between::Step,
        Interpolation::Linear => Between::Linear,
        Interpolation::CubicSpline => Between::CubicSpline,
    };
    let key = |key: usize| {
        let tangent = |part: usize| {
            let value = channel.values.get(key * 3 + part).filter(|_| between == Between::CubicSpline);
            value.map(|&value| numbers(value))
        };
        Some(CopiedKey {
            after: f64::from(*channel.times.get(key)?) - f64::from(first),
            value: numbers(channel.value(key)?),
            arrive: tangent(0),
            leave: tangent(2),
        })
    };
    (between, keys.filter_map(key).collect())
}

impl State {
    /// Copies the selected keys where the timeline was touched last, else the pose.
    pub(in crate::panels) fn copy(&mut self) -> Option<Effect> {
        if self.keys.has_hand && self.take().is_some() && !self.keys.selection.is_empty() {
            return self.copy_keys();
        }
        self.copy_pose()
    }

    /// The selected keys as text for the clipboard.
    pub(in crate::panels) fn copy_keys(&mut self) -> Option<Effect> {
        Some(Effect::Copy(self.keys_text("Copied")?))
    }

    /// The same, and deletes them.
    pub(in crate::panels) fn cut_keys(&mut self) -> Option<Effect> {
        let text = self.keys_text("Cut")?;
        match self.delete_keys()? {
            Effect::Change(change) => Some(Effect::Cut(text, change)),
            _ => None,
        }
    }

    fn keys_text(&mut self, verb: &str) -> Option<String> {
        let take = Arc::clone(self.shared_take()?);
        let number = self.keys.selection.count(&take);
        if number > MOST {
            let text = format!("{} keys are selected; at most {} are copied", grouped(number), grouped(MOST));
            self.status.say(Level::Warning, text);
            return None;
        }
        let skeleton = Arc::clone(&self.loaded()?.model.animation.skeleton);
        let channels = copied(&take, &self.keys.selection, &skeleton);
        if channels.is_empty() {
            self.status.say(Level::Info, "No key is selected");
            return None;
        }
        self.status.say(Level::Info, format!("{verb} {}", count(number, "key", "keys")));
        Some(to_text(channels))
    }

    /// The edit that puts copied keys in at the time shown: on the bones they are of, or, where as many others are selected,
    /// on these in their order. Locked bones are left as they are.
    pub(in crate::panels) fn paste_keys(&mut self, mut channels: Vec<CopiedChannel>) -> Option<Effect> {
        let Some(take) = self.take_ref() else {
            self.status.say(Level::Info, "The rest pose is not edited; show a take first");
            return None;
        };
        let (generation, time) = (self.view.as_ref()?.generation, self.time());
        let skeleton = Arc::clone(&self.loaded()?.model.animation.skeleton);
        let to = targets(&channels, self.selection.bones(), &skeleton);
        channels.retain_mut(|channel| match to.get(&name_of(&channel.bone)) {
            Some(&bone) => {
                channel.bone = BoneRef::Index(bone);
                true
            }
            None => false,
        });
        if channels.is_empty() {
            self.status.say(Level::Info, "The keys in the clipboard are of bones that this model has not");
            return None;
        }
        if !self.spare_locked(&mut channels, |channel| match channel.bone {
            BoneRef::Index(bone) => bone,
            BoneRef::Name(_) => BoneIndex::MAX,
        }) {
            return None;
        }
        let parts = channels.iter().filter_map(|channel| match channel.bone {
            BoneRef::Index(bone) => {
                let times = channel.keys.iter().map(|key| (f64::from(time) + key.after) as f32);
                Some(((bone, channel.property), times.map(|time| [time, time]).collect()))
            }
            BoneRef::Name(_) => None,
        });
        let (before, parts) = (self.take().map_or(0, Take::keys), parts.collect());
        self.keys.awaited = Some(Awaited { generation, before, parts });
        Some(Effect::Change(Change::Edit(Edit::PasteKeys(PasteKeys { take, time, channels }), None)))
    }

    /// Selects keys that were pasted, once they are there.
    pub(super) fn select_pasted(&mut self, generation: u64) {
        let Some(slot) = self.slot() else { return };
        // A view that was on its way when they were pasted has not got them yet.
        let there = |awaited: &Awaited| {
            let is_key = |bone, property, time| slot.key_at(bone, property, time).is_some();
            let any = |times: &[[f32; 2]], bone, property| {
                times.iter().any(|[time, _]| is_key(bone, property, *time))
            };
            generation != awaited.generation
                && awaited.parts.iter().any(|((bone, property), times)| any(times, *bone, *property))
        };
        if self.keys.awaited.as_ref().is_some_and(there)
            && let Some(Awaited { before, parts, .. }) = self.keys.awaited.take()
        {
            self.select_parts(&parts, Choice::Replace);
            self.tell_replaced(before, parts.iter().map(|(_, times)| times.len()).sum());
        }
    }
}

/// A bone's name as one that can be ordered.
fn name_of(bone: &BoneRef) -> (u32, String) {
    match bone {
        BoneRef::Index(index) => (*index, String::new()),
        BoneRef::Name(name) => (u32::MAX, name.clone()),
    }
}

/// Where the keys of each bone go.
fn targets(
    channels: &[CopiedChannel],
    selected: &[BoneIndex],
    skeleton: &Skeleton,
) -> BTreeMap<(u32, String), BoneIndex> {
    let mut names: Vec<&BoneRef> = Vec::new();
    let mut own: BTreeMap<(u32, String), Option<BoneIndex>> = BTreeMap::new();
    for channel in channels {
        own.entry(name_of(&channel.bone)).or_insert_with(|| {
            names.push(&channel.bone);
            match &channel.bone {
                BoneRef::Index(bone) => Some(*bone).filter(|&bone| (bone as usize) < skeleton.len()),
                BoneRef::Name(name) => skeleton.find(name),
            }
        });
    }
    let mut selected = selected.to_vec();
    selected.sort_unstable();
    let mut same: Vec<Option<BoneIndex>> = own.values().copied().collect();
    same.sort_unstable();
    if selected.len() == names.len() && !same.iter().copied().eq(selected.iter().copied().map(Some)) {
        return names.into_iter().map(name_of).zip(selected).collect();
    }
    own.into_iter().filter_map(|(name, bone)| Some((name, bone?))).collect()
}
