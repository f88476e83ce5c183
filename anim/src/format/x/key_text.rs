//! Keys as text: rows of ticks and values, and the object around them.

use super::animation::XKeyKind;
use super::check as code;
use crate::data::{Channel, Track, Transform};
use crate::format::AxisMap;
use crate::format::losses::Losses;
use crate::format::straight::{LineValue, is_straight, straight_times};
use crate::sample::sample_channel;
use glam::{Quat, Vec3};
use std::fmt::Write;

/// Share of a tick by which a key may be off its tick.
const OFF_TICK: f64 = 0.02;

/// Writes keys of the model in the space and the ticks of a file.
pub(super) struct KeyText {
    pub(super) to_file: AxisMap,
    pub(super) ticks_per_second: f64,
    pub(super) line_end: &'static str,
}

/// Keys of one list in the file: times in seconds, and values.
pub(super) struct FileKeys {
    pub(super) kind: XKeyKind,
    pub(super) times: Vec<f32>,
    pub(super) values: Vec<Vec<f32>>,
}

impl KeyText {
    /// Returns the shortest time between two keys, in seconds: one tick.
    pub(super) fn jump(&self) -> f32 {
        (1.0 / self.ticks_per_second) as f32
    }

    /// Returns the nearest tick to a time.
    pub(super) fn ticks(&self, seconds: f32) -> i64 {
        (f64::from(seconds) * self.ticks_per_second).round() as i64
    }

    /// Returns whether a time is not at a whole tick.
    pub(super) fn is_off(&self, seconds: f32) -> bool {
        let ticks = f64::from(seconds) * self.ticks_per_second;
        (ticks - ticks.round()).abs() > OFF_TICK
    }

    /// Returns the values of a rotation.
    pub(super) fn rotation(&self, rotation: Quat) -> Vec<f32> {
        let rotation = self.to_file.rotation(rotation);
        // The inverse rotation, w first.
        vec![rotation.w, -rotation.x, -rotation.y, -rotation.z]
    }

    /// Returns the values of a position.
    pub(super) fn position(&self, position: Vec3) -> Vec<f32> {
        self.to_file.position(position).to_array().to_vec()
    }

    /// Returns the values of a scale.
    pub(super) fn scale(&self, scale: Vec3) -> Vec<f32> {
        self.to_file.factors(scale).to_array().to_vec()
    }

    /// Returns the values of a matrix.
    pub(super) fn matrix(&self, pose: Transform) -> Vec<f32> {
        self.to_file.matrix(pose.to_matrix()).to_cols_array().to_vec()
    }

    /// Returns the keys of the channels of a track that have keys; `rest` is the pose without.
    pub(super) fn lists(&self, track: &Track, rest: Transform) -> Vec<FileKeys> {
        let mut lists = Vec::new();
        let mut add = |keys: FileKeys| {
            if !keys.times.is_empty() {
                lists.push(keys);
            }
        };
        add(self.channel(XKeyKind::Rotation, &track.rotation, rest.rotation, |value| self.rotation(value)));
        add(self.channel(XKeyKind::Scale, &track.scale, rest.scale, |value| self.scale(value)));
        add(self
            .channel(XKeyKind::Position, &track.translation, rest.translation, |value| self.position(value)));
        lists
    }

    /// Returns the keys of a channel.
    pub(super) fn channel<T: LineValue>(
        &self,
        kind: XKeyKind,
        channel: &Channel<T>,
        rest: T,
        values: impl Fn(T) -> Vec<f32>,
    ) -> FileKeys {
        let times = straight_times(channel, self.jump());
        let values = times.iter().map(|&time| values(sample_channel(channel, rest, time))).collect();
        FileKeys { kind, times, values }
    }

    /// Returns the text of a row.
    pub(super) fn row(&self, seconds: f32, values: &[f32]) -> String {
        let numbers: Vec<String> = values.iter().map(|&value| decimal(value)).collect();
        format!("{};{};{}", self.ticks(seconds), values.len(), numbers.join(","))
    }

    /// Returns the object with a list of keys. `indent` is what its lines start with. Of keys at one tick the last one is
    /// written.
    pub(super) fn block(&self, keys: &FileKeys, indent: &str) -> String {
        let line = self.line_end;
        let is_last = |&index: &usize| {
            keys.times.get(index + 1).is_none_or(|&next| self.ticks(next) != self.ticks(keys.times[index]))
        };
        let rows: Vec<usize> = (0..keys.times.len()).filter(is_last).collect();
        let mut text = format!(
            "AnimationKey {{{line}{indent} {};{line}{indent} {};{line}",
            keys.kind.number(),
            rows.len()
        );
        for (position, &index) in rows.iter().enumerate() {
            let end = if position + 1 < rows.len() { ";;," } else { ";;;" };
            let _ = write!(text, "{indent} {}{end}{line}", self.row(keys.times[index], &keys.values[index]));
        }
        text + indent + "}"
    }

    /// Returns the object with all keys of a frame.
    pub(super) fn animation(&self, frame: &str, lists: &[FileKeys], indent: &str) -> String {
        let line = self.line_end;
        let mut text = format!("Animation {{{line}{indent} {{ {frame} }}{line}");
        for keys in lists {
            let _ = write!(text, "{indent} {}{line}", self.block(keys, &format!("{indent} ")));
        }
        text + indent + "}"
    }

    /// Lists curves that are no straight lines, and keys that are not at a tick.
    pub(super) fn list_losses(&self, new: &Track, old: &Track, take: usize, losses: &mut Losses) {
        self.list_channel(&new.translation, &old.translation, take, losses);
        self.list_channel(&new.rotation, &old.rotation, take, losses);
        self.list_channel(&new.scale, &old.scale, take, losses);
    }

    fn list_channel<T: PartialEq>(
        &self,
        new: &Channel<T>,
        old: &Channel<T>,
        take: usize,
        losses: &mut Losses,
    ) {
        if new == old {
            return;
        }
        let path = format!("/animation/takes/{take}/tracks");
        if !is_straight(new) {
            let text = "steps and curves are stored as straight lines between more keys";
            losses.add(path, code::INTERPOLATION_NOT_STORED, text);
        } else if new.times.iter().any(|&time| self.is_off(time) && !old.times.contains(&time)) {
            let text = format!("keys are moved to the nearest of {} ticks per second", self.ticks_per_second);
            losses.add(path, code::KEYS_BETWEEN_TICKS, text);
        }
    }
}

/// Returns a number with a point and without an exponent, as every program reads it.
pub(super) fn decimal(value: f32) -> String {
    let text = format!("{}", value + 0.0);
    if text.contains('.') { text } else { text + ".0" }
}
