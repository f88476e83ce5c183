//! Channels of a joint: the columns of the motion, in the order of the file.

use crate::trig::rotation_about;
use glam::{DQuat, DVec3};

/// Largest number of channels of a joint.
pub(super) const CHANNELS: usize = 6;

/// Meaning of a column; the axis is 0 x, 1 y, 2 z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BvhChannel {
    /// Position along an axis, which replaces the offset.
    Position(usize),
    /// Rotation about an axis in degrees.
    Rotation(usize),
}

impl BvhChannel {
    /// Returns the channel of this name, in any case.
    pub(super) fn parse(name: &[u8]) -> Option<Self> {
        let (&first, kind) = name.split_first()?;
        let axis = match first.to_ascii_lowercase() {
            b'x' => 0,
            b'y' => 1,
            b'z' => 2,
            _ => return None,
        };
        if kind.eq_ignore_ascii_case(b"position") {
            Some(Self::Position(axis))
        } else if kind.eq_ignore_ascii_case(b"rotation") {
            Some(Self::Rotation(axis))
        } else {
            None
        }
    }
}

/// Channels of one joint, in order.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChannelList {
    list: [BvhChannel; CHANNELS],
    count: usize,
}

impl Default for ChannelList {
    fn default() -> Self {
        Self { list: [BvhChannel::Position(0); CHANNELS], count: 0 }
    }
}

impl ChannelList {
    /// Returns the positions of a joint, x to z, where `has_positions`, and then rotations about z, x, y.
    pub(super) fn usual(has_positions: bool) -> Self {
        let mut list = Self::default();
        for axis in 0..if has_positions { 3 } else { 0 } {
            list.push(BvhChannel::Position(axis));
        }
        for axis in [2, 0, 1] {
            list.push(BvhChannel::Rotation(axis));
        }
        list
    }

    /// Adds a channel. The caller has checked that there are fewer than [`CHANNELS`].
    pub(super) fn push(&mut self, channel: BvhChannel) {
        self.list[self.count] = channel;
        self.count += 1;
    }

    /// Returns the number of channels.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// Returns the channels in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = BvhChannel> + '_ {
        self.list[..self.count].iter().copied()
    }

    /// Returns whether there is a position channel of this axis.
    pub(super) fn has_position(&self, axis: usize) -> bool {
        self.iter().any(|channel| channel == BvhChannel::Position(axis))
    }

    /// Returns whether there is any position channel.
    pub(super) fn has_positions(&self) -> bool {
        (0..3).any(|axis| self.has_position(axis))
    }

    /// Returns whether there is any rotation channel.
    pub(super) fn has_rotations(&self) -> bool {
        self.iter().any(|channel| matches!(channel, BvhChannel::Rotation(_)))
    }

    /// Returns the translation of a joint: its offset, replaced by the position channels of `row`.
    pub(super) fn translation(&self, offset: DVec3, row: &[f64]) -> DVec3 {
        let mut translation = offset;
        for (channel, &number) in self.iter().zip(row) {
            if let BvhChannel::Position(axis) = channel {
                translation[axis] = number;
            }
        }
        translation
    }

    /// Returns the rotation of a joint: the product of the rotations about the axes, in the order of the channels.
    pub(super) fn rotation(&self, row: &[f64]) -> DQuat {
        let mut rotation = DQuat::IDENTITY;
        for (channel, &degrees) in self.iter().zip(row) {
            if let BvhChannel::Rotation(axis) = channel
                && degrees != 0.0
            {
                rotation = turned(rotation, axis, degrees);
            }
        }
        rotation
    }
}

/// Returns `rotation * R(axis, degrees)`.
fn turned(rotation: DQuat, axis: usize, degrees: f64) -> DQuat {
    // Whole turns of such an angle are exact, sine and cosine of a huge number are slow.
    let degrees = if degrees.abs() > 720.0 { degrees % 360.0 } else { degrees };
    rotation * rotation_about(DVec3::AXES[axis], degrees.to_radians())
}
