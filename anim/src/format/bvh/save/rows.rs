//! Copies the text of a file, and replaces numbers of its rows.

use super::super::angles::angles;
use super::super::channel::{BvhChannel, CHANNELS};
use super::super::check as code;
use super::super::hierarchy::Joint;
use super::super::motion::{MotionHead, time_of};
use super::super::parsed::{BvhText, LEXICON};
use super::edits::{JointEdits, rotations_differ, translations_differ};
use super::number::spelled;
use super::report::{BvhChanges, ChangedColumn, JointProperty};
use crate::data::{Skeleton, Take};
use crate::format::decimal::parse_number;
use crate::format::losses::Losses;
use crate::format::text::{TextScanner, TextToken};
use crate::format::{AxisMap, ExportError};
use crate::sample::{rest_pose, sample_track};
use glam::{DQuat, DVec3, Quat, Vec3};
use std::collections::BTreeSet;
use std::ops::Range;

/// Angle in degrees below which a number stays as it is: single precision does not represent less.
const SAME_ANGLE: f64 = 2e-5;

/// Share of a position below which a number stays as it is.
const SAME_POSITION: f64 = 3e-7;

/// Angle in radians above which a rotation counts as not stored.
const ROTATION_LOST: f64 = 1e-4;

/// The text of a file, edited from start to end.
pub(super) struct RowWriter<'a> {
    bytes: &'a [u8],
    text: &'a BvhText,
    skeleton: &'a Skeleton,
    scanner: TextScanner<'a>,
    /// From the space of the model to that of the file.
    to_file: AxisMap,
    out: Vec<u8>,
    /// Number of bytes of the file that are copied or replaced.
    done: usize,
    /// The row that was read last.
    row: Vec<TextToken<'a>>,
    /// End of the row before it.
    row_start: usize,
    changes: BvhChanges,
    /// Joints with rotations or translations that their channels cannot express.
    unstored: BTreeSet<(usize, &'static str)>,
}

impl<'a> RowWriter<'a> {
    pub(super) fn new(bytes: &'a [u8], text: &'a BvhText, head: &MotionHead, skeleton: &'a Skeleton) -> Self {
        let mut scanner = TextScanner::new(bytes, &LEXICON);
        scanner.go_to(head.end);
        Self {
            bytes,
            text,
            skeleton,
            scanner,
            to_file: text.conversion.axes().inverse(),
            out: Vec::new(),
            done: 0,
            row: Vec::new(),
            row_start: head.end,
            changes: BvhChanges::default(),
            unstored: BTreeSet::new(),
        }
    }

    /// Copies the text before a range, and replaces the range.
    pub(super) fn replace(&mut self, range: Range<usize>, text: &str) {
        self.out.extend_from_slice(&self.bytes[self.done..range.start]);
        self.out.extend_from_slice(text.as_bytes());
        self.done = range.end;
    }

    /// Replaces the numbers of the edits in the first `frames` rows.
    pub(super) fn edit_rows(&mut self, edits: &mut JointEdits<'_>, frames: usize) -> Result<(), ExportError> {
        for frame in 0..frames {
            self.next_row()?;
            let time = time_of(frame, self.text.seconds());
            for edit in edits.iter_mut() {
                let joint = &self.text.hierarchy.joints[edit.joint];
                let rotation = edit.rotation.as_mut().and_then(|pair| pair.changed(time, rotations_differ));
                let translation =
                    edit.translation.as_mut().and_then(|pair| pair.changed(time, translations_differ));
                if rotation.is_none() && translation.is_none() {
                    edit.added = [0.0; CHANNELS];
                    continue;
                }
                let old = self.numbers_of(joint)?;
                let near = std::array::from_fn(|slot| old[slot] + edit.added[slot]);
                let new = self.numbers(edit.joint, rotation, translation, [&old, &near]);
                for (slot, channel) in joint.channels.iter().enumerate() {
                    edit.added[slot] = new[slot] - old[slot];
                    self.replace_number(joint.first + slot, channel, old[slot], new[slot]);
                }
            }
        }
        Ok(())
    }

    /// Appends rows with the poses of `take` after the row that was read last.
    pub(super) fn append_rows(&mut self, take: &Take, frames: Range<usize>) {
        let joints = &self.text.hierarchy.joints;
        let end = self.row.last().map_or(self.row_start, |token| token.at + token.text.len());
        self.replace(end..end, "");
        let line_end: &[u8] =
            if self.bytes[..end].ends_with(b"\r") || self.bytes.contains(&b'\r') { b"\r\n" } else { b"\n" };
        let mut last: Vec<[f64; CHANNELS]> =
            joints.iter().map(|joint| self.numbers_of(joint).unwrap_or([0.0; CHANNELS])).collect();
        self.changes.appended = frames.len();
        for frame in frames {
            let time = time_of(frame, self.text.seconds());
            for column in 0..self.text.hierarchy.columns_before() {
                self.append_number(column, 0.0, line_end);
            }
            for (index, joint) in joints.iter().enumerate() {
                let Some(bone) = self.skeleton.bones.get(index) else { continue };
                let pose =
                    take.tracks.get(index).map_or(rest_pose(bone), |track| sample_track(track, bone, time));
                last[index] =
                    self.numbers(index, Some(pose.rotation), Some(pose.translation), [&last[index]; 2]);
                for (slot, number) in last[index].iter().enumerate().take(joint.channels.len()) {
                    self.append_number(joint.first + slot, *number, line_end);
                }
            }
        }
    }

    /// Appends the number of a column, as the row that was read last has it.
    fn append_number(&mut self, column: usize, number: f64, line_end: &[u8]) {
        let (before, old) = match self.row.get(column) {
            Some(token) => {
                let from = match column.checked_sub(1) {
                    Some(before) => self.row[before].at + self.row[before].text.len(),
                    None => self.row_start,
                };
                (&self.bytes[from..token.at], token.text)
            }
            None => (if column == 0 { line_end } else { &b" "[..] }, &b"0.000000"[..]),
        };
        self.out.extend_from_slice(before);
        self.out.extend_from_slice(spelled(number, old).as_bytes());
    }

    /// Removes rows at the end.
    pub(super) fn remove_rows(&mut self, frames: Range<usize>) -> Result<(), ExportError> {
        let start = self.row.last().map_or(self.row_start, |token| token.at + token.text.len());
        self.changes.removed = frames.len();
        for _ in frames {
            self.next_row()?;
        }
        let end = self.row.last().map_or(start, |token| token.at + token.text.len());
        self.replace(start..end, "");
        Ok(())
    }

    /// Returns the text and its changes, and lists what the channels cannot express.
    pub(super) fn finish(
        mut self,
        edits: JointEdits<'_>,
        take: usize,
        losses: &mut Losses,
    ) -> (Vec<u8>, BvhChanges) {
        self.out.extend_from_slice(&self.bytes[self.done..]);
        for edit in edits {
            let counted = [
                (JointProperty::Translation, edit.translation.map_or(0, |pair| pair.frames)),
                (JointProperty::Rotation, edit.rotation.map_or(0, |pair| pair.frames)),
            ];
            for (property, frames) in counted.into_iter().filter(|(_, frames)| *frames > 0) {
                let bone = self.text.hierarchy.joints[edit.joint].name.clone();
                self.changes.columns.push(ChangedColumn { bone, property, frames });
            }
        }
        for (joint, property) in self.unstored {
            let name = &self.text.hierarchy.joints[joint].name;
            let text = format!("the channels of \"{name}\" cannot express its {property}");
            let pointer = format!("/animation/takes/{take}/tracks/{joint}/{property}");
            losses.add(pointer, code::CHANNEL_MISSING, text);
        }
        (self.out, self.changes)
    }

    fn next_row(&mut self) -> Result<(), ExportError> {
        self.row_start = self.row.last().map_or(self.row_start, |token| token.at + token.text.len());
        self.row.clear();
        for _ in 0..self.text.hierarchy.channels {
            let token =
                self.scanner.token().ok_or_else(|| ExportError::new("the opened file has changed"))?;
            self.row.push(token);
        }
        Ok(())
    }

    /// Returns the numbers of a joint in the row that was read last.
    fn numbers_of(&self, joint: &Joint) -> Result<[f64; CHANNELS], ExportError> {
        let mut numbers = [0.0; CHANNELS];
        for (slot, number) in numbers.iter_mut().enumerate().take(joint.channels.len()) {
            let token = self.row.get(joint.first + slot);
            *number = token
                .and_then(|token| parse_number(token.text))
                .ok_or_else(|| ExportError::new("the opened file has changed"))?;
        }
        Ok(numbers)
    }

    /// Returns the numbers of a joint with a rotation and a translation of the model; without one they stay as in `old`.
    /// Of all angles those nearest to `near` are returned.
    fn numbers(
        &mut self,
        index: usize,
        rotation: Option<Quat>,
        translation: Option<Vec3>,
        [old, near]: [&[f64; CHANNELS]; 2],
    ) -> [f64; CHANNELS] {
        let joint = &self.text.hierarchy.joints[index];
        let channels = &joint.channels;
        let mut numbers = *old;
        if let Some(rotation) = rotation {
            let rotation = self.to_file.rotation(rotation).as_dquat().normalize();
            let found = angles(channels, rotation, &near[..channels.len()]);
            for (slot, channel) in channels.iter().enumerate() {
                if matches!(channel, BvhChannel::Rotation(_)) {
                    numbers[slot] = found[slot];
                }
            }
            if channels.has_rotations()
                && angle_between(channels.rotation(&numbers), rotation) > ROTATION_LOST
            {
                self.unstored.insert((index, JointProperty::Rotation.name()));
            }
        }
        if let Some(translation) = translation {
            let translation = self.to_file.position(translation).as_dvec3();
            for (number, channel) in numbers.iter_mut().zip(channels.iter()) {
                if let BvhChannel::Position(axis) = channel {
                    *number = translation[axis];
                }
            }
            let stored = channels.translation(joint.offset, &numbers);
            if channels.has_positions() && stored.distance(translation) > 1e-5 * largest(translation).max(1.0)
            {
                self.unstored.insert((index, JointProperty::Translation.name()));
            }
        }
        numbers
    }

    fn replace_number(&mut self, column: usize, channel: BvhChannel, old: f64, new: f64) {
        let tolerance = match channel {
            BvhChannel::Rotation(_) => SAME_ANGLE,
            BvhChannel::Position(_) => SAME_POSITION * old.abs(),
        };
        let token = self.row[column];
        let text = spelled(new, token.text);
        if (new - old).abs() <= tolerance || parse_number(text.as_bytes()) == Some(old) {
            return;
        }
        self.replace(token.at..token.at + token.text.len(), &text);
        self.changes.numbers += 1;
    }
}

fn largest(vector: DVec3) -> f64 {
    vector.abs().max_element()
}

/// Returns the angle of the rotation from one to the other, in radians.
fn angle_between(a: DQuat, b: DQuat) -> f64 {
    let between = a.conjugate() * b;
    2.0 * libm::atan2(between.xyz().length(), between.w.abs())
}
