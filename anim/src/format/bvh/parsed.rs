//! A parsed file: what reading and saving start from.

use super::check;
use super::common_root;
use super::hierarchy::{self, Joint, JointTable};
use super::motion::{self, MotionHead, MotionRows};
use super::unit;
use crate::format::text::{Lexicon, TextScanner};
use crate::format::{ConventionSource, Conversion, Found, ImportContext, ImportError, Place, UpAxis};

/// How the text is divided: braces and colons are tokens on their own.
pub(super) const LEXICON: Lexicon = Lexicon::new(b"", b"{}:", &[]);

/// A parsed file.
pub(super) struct BvhText {
    pub(super) hierarchy: JointTable,
    /// The lines before the numbers; `None` for a file without motion.
    pub(super) head: Option<MotionHead>,
    pub(super) rows: MotionRows,
    pub(super) conversion: Conversion,
}

impl BvhText {
    pub(super) fn parse(bytes: &[u8], context: &ImportContext<'_>) -> Result<Self, ImportError> {
        let mut scanner = TextScanner::new(bytes, &LEXICON);
        let mut hierarchy = hierarchy::parse(&mut scanner, context)?;
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
        common_root::remove(&mut hierarchy, &rows);
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
    pub(super) fn seconds(&self) -> f64 {
        let chosen = self.conversion.frame_rate.filter(|rate| rate.source == ConventionSource::User);
        match (chosen, &self.head) {
            (Some(rate), _) => 1.0 / f64::from(rate.value),
            (None, Some(head)) => head.seconds,
            (None, None) => 0.0,
        }
    }

    /// Returns the numbers of a joint in a frame.
    pub(super) fn row(&self, frame: usize, joint: &Joint) -> &[f64] {
        &self.rows.numbers[frame * self.hierarchy.channels + joint.first..][..joint.channels.len()]
    }
}
