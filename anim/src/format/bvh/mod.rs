//! BVH (Biovision hierarchy): the usual format of motion captures, a text with a skeleton and one motion.
//!
//! # What is read
//!
//! A joint becomes a bone, and the tip of a joint (`End Site`) a bone `<joint>_end` without channels. The local rotation is the
//! product of the rotations about the axes in the order of the channels; a position channel replaces the offset of its axis. In the
//! rest pose every channel is zero. Every joint with channels has a key in every frame, at the number of the frame times the frame
//! time. The take is called `motion`.
//!
//! # Units
//!
//! The format has Y up and right-handed axes, and does not contain a unit of length: [`Conversion::meters_per_unit`] is guessed
//! from the size of the figure (meters, centimeters, millimeters, inches, or inches divided by 0.45 as in the database of CMU),
//! such that a human is as tall as a human; where none of these fits, such that the figure is 1.7 m tall.
//!
//! # What is saved
//!
//! An edited file keeps every byte but the numbers of the frames and channels that were edited ([`save`]). [`write`](fn@write) makes a
//! file of any model.

mod angles;
mod channel;
pub mod check;
mod hierarchy;
mod model;
mod motion;
mod sampled;
pub mod save;
mod unit;
mod write;

pub use write::write;

use super::text::{Lexicon, TextScanner};
use super::{Conversion, Format, Found, ImportContext, ImportError, Place, UpAxis, WriteSupport};
use crate::data::ModelData;
use hierarchy::{Hierarchy, Joint};
use motion::{MotionHead, MotionRows};

/// BVH motion capture, `.bvh`.
pub const BVH: Format = Format {
    name: "bvh",
    title: "BVH motion capture",
    extensions: &["bvh"],
    sniff: |bytes| {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        text.get(..9).is_some_and(|word| word.eq_ignore_ascii_case(b"HIERARCHY"))
    },
    read,
    write: WriteSupport::Surgical(save::open),
};

/// How the text is divided: braces and colons are tokens on their own.
const LEXICON: Lexicon = Lexicon::new(b"", b"{}:", &[]);

fn read(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let text = BvhText::parse(bytes, context)?;
    context.converted(text.conversion);
    model::model(&text, context)
}

/// A parsed file.
struct BvhText {
    hierarchy: Hierarchy,
    /// The lines before the numbers; `None` for a file without motion.
    head: Option<MotionHead>,
    rows: MotionRows,
    conversion: Conversion,
}

impl BvhText {
    fn parse(bytes: &[u8], context: &ImportContext<'_>) -> Result<Self, ImportError> {
        let mut scanner = TextScanner::new(bytes, &LEXICON);
        let hierarchy = hierarchy::parse(&mut scanner, context)?;
        let mut rows = MotionRows { numbers: Vec::new(), frames: 0 };
        let mut head = None;
        if hierarchy.has_motion {
            let found = MotionHead::parse(&mut scanner, context)?;
            rows = motion::rows(&mut scanner, &hierarchy, &found, context)?;
            head = Some(found);
        } else {
            let text = "the file has no motion; the model has no take";
            context.warn(scanner.place(scanner.at()), check::MOTION_MISSING, text);
        }
        context.charge(&Place::File, hierarchy.joints.len() as u64 * 24)?;
        if context.conventions().up.is_none() && unit::seems_z_up(&hierarchy, &rows) {
            let text = "the figure seems to have z up, against the convention of the format; choose Z up if it is on its back";
            context.warn(Place::Line(1, 1), check::UP_DOUBTFUL, text);
        }
        let conversion = Conversion {
            meters_per_unit: Found::guessed(unit::meters_per_unit(&hierarchy, &rows)),
            up: Found::by_format(UpAxis::Y),
            frame_rate: head.as_ref().map(MotionHead::rate),
            ..Conversion::default()
        };
        let conversion = conversion.with(context.conventions());
        Ok(Self { hierarchy, head, rows, conversion })
    }

    /// Returns the number of seconds between two frames: the frame time, unless the user chose a rate.
    fn seconds(&self) -> f64 {
        let chosen = self.conversion.frame_rate.filter(|rate| rate.source == super::ConventionSource::User);
        match (chosen, &self.head) {
            (Some(rate), _) => 1.0 / f64::from(rate.value),
            (None, Some(head)) => head.seconds,
            (None, None) => 0.0,
        }
    }

    /// Returns the numbers of a joint in a frame.
    fn row(&self, frame: usize, joint: &Joint) -> &[f64] {
        &self.rows.numbers[frame * self.hierarchy.channels + joint.first..][..joint.channels.len()]
    }
}
