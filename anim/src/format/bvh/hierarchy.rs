//! The section `HIERARCHY`: joints with offsets and channels.

use super::channel::{BvhChannel, CHANNELS, ChannelList};
use super::check as code;
use crate::format::names::UniqueNames;
use crate::format::text::{TextScanner, TextToken, UNEXPECTED_END, UNEXPECTED_TOKEN};
use crate::format::{ImportContext, ImportError};
use crate::limits::{HUGE, NODE_DEPTH, NODES};
use glam::DVec3;

/// A joint, or an end site: the tip of the joint above it.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    /// Unique among the joints.
    pub(super) name: String,
    /// Position in the list of joints, before the joint's own; `None` for a root.
    pub(super) parent: Option<usize>,
    /// Position relative to the parent, unless position channels replace it.
    pub(super) offset: DVec3,
    /// Columns of the joint.
    pub(super) channels: ChannelList,
    /// Number of the first column of the joint.
    pub(super) first: usize,
}

/// The joints, in the order of the file.
pub(super) struct JointTable {
    pub(super) joints: Vec<Joint>,
    /// Number of columns, with those of a common root.
    pub(super) channels: usize,
    /// Whether a motion follows.
    pub(super) has_motion: bool,
}

impl JointTable {
    /// Returns the number of columns before those of the first joint; more than 0 if a common root was removed.
    pub(super) fn columns_before(&self) -> usize {
        self.joints.first().map_or(0, |joint| joint.first)
    }

    /// Returns whether a column is a position.
    pub(super) fn is_position(&self, column: usize) -> bool {
        let own = |joint: &&Joint| (joint.first..joint.first + joint.channels.len()).contains(&column);
        let joint = self.joints.iter().find(own);
        let channel = joint.and_then(|joint| joint.channels.iter().nth(column - joint.first));
        matches!(channel, Some(BvhChannel::Position(_)))
    }
}

/// Reads up to the word `MOTION`, or the end of the text.
pub(super) fn parse(
    scanner: &mut TextScanner<'_>,
    context: &ImportContext<'_>,
) -> Result<JointTable, ImportError> {
    scanner.expect("HIERARCHY")?;
    let mut reader = HierarchyReader {
        joints: Vec::new(),
        open: Vec::new(),
        channels: 0,
        names: UniqueNames::default(),
        context,
    };
    let has_motion = loop {
        context.work(1)?;
        let Some(token) = scanner.token() else {
            if reader.open.is_empty() && !reader.joints.is_empty() {
                break false;
            }
            let what = if reader.joints.is_empty() { "ROOT" } else { "a brace" };
            let reason = format!("the text ends where {what} was expected");
            return Err(scanner.invalid(scanner.at(), UNEXPECTED_END, reason));
        };
        if reader.step(scanner, token)? {
            break true;
        }
    };
    Ok(JointTable { joints: reader.joints, channels: reader.channels, has_motion })
}

struct HierarchyReader<'a> {
    joints: Vec<Joint>,
    /// Joints whose brace is open.
    open: Vec<usize>,
    channels: usize,
    names: UniqueNames,
    context: &'a ImportContext<'a>,
}

impl HierarchyReader<'_> {
    /// Reads what starts with `token`. Returns whether the hierarchy ends.
    fn step(&mut self, scanner: &mut TextScanner<'_>, token: TextToken<'_>) -> Result<bool, ImportError> {
        let Some(&joint) = self.open.last() else {
            if token.is("ROOT") || (self.joints.is_empty() && token.is("JOINT")) {
                self.open_joint(scanner, token, None)?;
                return Ok(false);
            }
            if token.is("MOTION") && !self.joints.is_empty() {
                return Ok(true);
            }
            let what = if self.joints.is_empty() { "\"ROOT\"" } else { "\"MOTION\" or \"ROOT\"" };
            return Err(scanner.unexpected(token, what));
        };
        if token.is("}") {
            self.open.pop();
        } else if token.is("JOINT") || token.is("END") {
            self.open_joint(scanner, token, Some(joint))?;
        } else if token.is("OFFSET") {
            self.joints[joint].offset = offset(scanner)?;
        } else if token.is("CHANNELS") {
            self.channels(scanner, token, joint)?;
        } else {
            return Err(scanner.unexpected(token, "OFFSET, CHANNELS, JOINT, End Site or a brace"));
        }
        Ok(false)
    }

    fn open_joint(
        &mut self,
        scanner: &mut TextScanner<'_>,
        token: TextToken<'_>,
        parent: Option<usize>,
    ) -> Result<(), ImportError> {
        let too_large = |what, size: usize, limit: usize| {
            let (place, size, limit) = (scanner.place(token.at), size as u64, limit as u64);
            Err(ImportError::TooLarge { place, what, size, limit })
        };
        if self.joints.len() >= NODES {
            return too_large("joints", self.joints.len() + 1, NODES);
        }
        if self.open.len() >= NODE_DEPTH {
            return too_large("joints inside each other", self.open.len() + 1, NODE_DEPTH);
        }
        let written = scanner.line_until(b'{');
        scanner.expect("{")?;
        let name = match parent {
            Some(parent) if token.is("END") => format!("{}_end", self.joints[parent].name),
            _ => String::from_utf8_lossy(written.text).split_whitespace().collect::<Vec<_>>().join(" "),
        };
        // Charged for the list while it grows, the bone, and the copies of the name.
        let bytes = 3 * size_of::<Joint>() + size_of::<crate::data::Bone>() + 4 * (name.len() + 24);
        let place = scanner.place(token.at);
        self.context.charge(&place, bytes as u64)?;
        let (unique, is_new) = self.names.make(name);
        if !is_new && !token.is("END") {
            let text = format!("another joint has the same name; this one is called \"{unique}\"");
            self.context.warn(place, code::NAME_TWICE, text);
        }
        self.open.push(self.joints.len());
        self.joints.push(Joint {
            name: unique,
            parent,
            offset: DVec3::ZERO,
            channels: ChannelList::default(),
            first: self.channels,
        });
        Ok(())
    }

    fn channels(
        &mut self,
        scanner: &mut TextScanner<'_>,
        token: TextToken<'_>,
        joint: usize,
    ) -> Result<(), ImportError> {
        let count = scanner.whole("the number of channels", CHANNELS as u64)?;
        let joint = &mut self.joints[joint];
        if joint.channels.len() > 0 {
            return Err(scanner.invalid(token.at, UNEXPECTED_TOKEN, "the joint has channels already"));
        }
        joint.first = self.channels;
        for _ in 0..count {
            let name = scanner.need("the name of a channel")?;
            let Some(channel) = BvhChannel::parse(name.text) else {
                let reason = format!("{} is no channel, such as Xposition or Zrotation", name.shown());
                return Err(scanner.invalid(name.at, code::CHANNEL_UNKNOWN, reason));
            };
            joint.channels.push(channel);
            self.channels += 1;
        }
        Ok(())
    }
}

fn offset(scanner: &mut TextScanner<'_>) -> Result<DVec3, ImportError> {
    let mut offset = DVec3::ZERO;
    for axis in 0..3 {
        scanner.skip_blank();
        let at = scanner.at();
        offset[axis] = scanner.number("an offset")?;
        if offset[axis].abs() > f64::from(HUGE) {
            return Err(scanner.invalid(at, code::HUGE_POSITION, "the offset is too large"));
        }
    }
    Ok(offset)
}
