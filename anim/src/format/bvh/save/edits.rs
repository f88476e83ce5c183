//! Differences between the opened take and the edited one.

use super::super::channel::CHANNELS;
use super::super::check as code;
use super::super::parsed::BvhText;
use super::report::JointProperty;
use crate::data::{Channel, Interpolation, Take};
use crate::format::bvh::motion::time_of;
use crate::format::losses::Losses;
use crate::frames::OFF_FRAME;
use crate::sample::{Value, sample_channel};
use glam::{Quat, Vec3};

/// An edited channel, and the opened one.
pub(super) struct ChannelPair<'a, T> {
    new: &'a Channel<T>,
    old: Option<&'a Channel<T>>,
    rest: T,
    /// Number of frames in which the value differs.
    pub(super) frames: usize,
}

impl<'a, T: Value + PartialEq> ChannelPair<'a, T> {
    /// Returns the pair; `None` if the channels are the same.
    fn new(new: &'a Channel<T>, old: Option<&'a Channel<T>>, rest: T) -> Option<Self> {
        let is_same = old.map_or(new.is_empty(), |old| old == new);
        (!is_same).then_some(Self { new, old, rest, frames: 0 })
    }

    /// Returns the value at a time if it differs from the opened one, and counts it.
    pub(super) fn changed(&mut self, time: f32, differs: fn(T, T) -> bool) -> Option<T> {
        let new = sample_channel(self.new, self.rest, time);
        let old = self.old.map_or(self.rest, |old| sample_channel(old, self.rest, time));
        let changed = differs(new, old).then_some(new);
        self.frames += usize::from(changed.is_some());
        changed
    }
}

/// Edits of the channels of a joint.
pub(super) struct JointEdit<'a> {
    /// Number of the joint.
    pub(super) joint: usize,
    pub(super) rotation: Option<ChannelPair<'a, Quat>>,
    pub(super) translation: Option<ChannelPair<'a, Vec3>>,
    /// Differences that were added to the old numbers of the frame before.
    pub(super) added: [f64; CHANNELS],
}

/// Edits of the joints of a take.
pub(super) type JointEdits<'a> = Vec<JointEdit<'a>>;

/// Returns whether two rotations differ by more than rounding.
pub(super) fn rotations_differ(a: Quat, b: Quat) -> bool {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    (a - b).length() > 3e-7
}

/// Returns whether two translations differ by more than rounding.
pub(super) fn translations_differ(a: Vec3, b: Vec3) -> bool {
    a.distance(b) > 2.4e-7 * a.abs().max(b.abs()).max_element()
}

/// Returns the number of frames of a file with `take`.
pub(super) fn frames_of(take: &Take, before: Option<&Take>, text: &BvhText) -> usize {
    let old = text.rows.frames;
    let end = |take: &Take| take.range_of_keys().map(|(_, last)| last);
    if before.is_some_and(|before| end(before) == end(take)) {
        return old;
    }
    let position = f64::from(end(take).unwrap_or(0.0)) / text.seconds();
    let nearest = position.round();
    let last = if (position - nearest).abs() <= OFF_FRAME { nearest } else { position.ceil() };
    // Negative and NaN become zero.
    (last as usize).saturating_add(1)
}

/// Returns the edited joints that have channels, and lists what has no channel.
pub(super) fn joint_edits<'a>(
    take: &'a Take,
    before: Option<&'a Take>,
    index: usize,
    text: &BvhText,
    losses: &mut Losses,
) -> JointEdits<'a> {
    let axes = text.conversion.axes();
    let mut edits = Vec::new();
    for (number, (track, joint)) in take.tracks.iter().zip(&text.hierarchy.joints).enumerate() {
        let path = format!("/animation/takes/{index}/tracks/{number}");
        let old = before.and_then(|before| before.tracks.get(number));
        let rest = axes.position(joint.offset.as_vec3());
        let rotation = ChannelPair::new(&track.rotation, old.map(|old| &old.rotation), Quat::IDENTITY);
        let translation = ChannelPair::new(&track.translation, old.map(|old| &old.translation), rest);
        let mut lost = |property: JointProperty, is_lost: bool| {
            if is_lost {
                let (what, name) = (property.name(), &joint.name);
                let text = format!("\"{name}\" has no channels for its {what}");
                losses.add(format!("{path}/{what}"), code::CHANNEL_MISSING, text);
            }
        };
        lost(JointProperty::Scale, any(&track.scale, |scale| (scale - Vec3::ONE).abs().max_element() > 1e-6));
        let mut edit = JointEdit { joint: number, rotation, translation, added: [0.0; CHANNELS] };
        if edit.rotation.is_some() && !joint.channels.has_rotations() {
            lost(JointProperty::Rotation, any(&track.rotation, |key| rotations_differ(key, Quat::IDENTITY)));
            edit.rotation = None;
        }
        if edit.translation.is_some() && !joint.channels.has_positions() {
            lost(JointProperty::Translation, any(&track.translation, |key| translations_differ(key, rest)));
            edit.translation = None;
        }
        if edit.rotation.is_some() {
            off_frames(&track.rotation, &format!("{path}/rotation"), text, losses);
        }
        if edit.translation.is_some() {
            off_frames(&track.translation, &format!("{path}/translation"), text, losses);
        }
        if edit.rotation.is_some() || edit.translation.is_some() {
            edits.push(edit);
        }
    }
    edits
}

fn any<T: Copy>(channel: &Channel<T>, is_meant: impl Fn(T) -> bool) -> bool {
    (0..channel.len()).filter_map(|key| channel.value(key)).any(is_meant)
}

/// Lists keys between two frames, and curves that are no straight lines.
fn off_frames<T: Copy>(channel: &Channel<T>, path: &str, text: &BvhText, losses: &mut Losses) {
    let off = |&&time: &&f32| {
        let frame = (f64::from(time) / text.seconds()).round().max(0.0);
        let distance = f64::from(time) - f64::from(time_of(frame as usize, text.seconds()));
        distance.abs() > OFF_FRAME * text.seconds()
    };
    let count = channel.times.iter().filter(off).count();
    if count > 0 {
        let text = format!(
            "{} not at the time of a frame; the frames have the values of the curve",
            super::report::count(count, "key")
        );
        losses.add(path.to_owned(), code::KEYS_BETWEEN_FRAMES, text);
    }
    if channel.interpolation != Interpolation::Linear && channel.len() > 1 {
        let text = "only the values at the frames are stored, and lines between them";
        losses.add(path.to_owned(), code::INTERPOLATION_NOT_STORED, text);
    }
}
