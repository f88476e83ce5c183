//! Saving an edited motion into the file that it came from.
//!
//! Only the numbers of edited frames and channels are replaced; every other byte stays. A number is replaced where the value
//! of the edited channel at the time of the frame differs from the opened one. Of the angles that make a rotation those
//! nearest to the old numbers are written, and in a row of edited frames those that continue the frame before, so that no curve
//! jumps by a turn. If the take becomes longer or shorter, rows are appended or removed at the end.

mod edits;
mod number;
mod report;
mod rows;

pub(super) use number::spelled;

use super::check as code;
use super::model;
use super::parsed::BvhText;
use crate::data::{ModelData, Skeleton, Take};
use crate::format::fixed_skeleton::takes_of_file;
use crate::format::losses::Losses;
use crate::format::{
    EditedTake, ExportError, ImportContext, ImportError, OutputFile, SavePlan, SurgicalFile,
};
use edits::{frames_of, joint_edits};
use report::BvhChanges;
use rows::RowWriter;
use std::sync::Arc;

/// An opened file.
struct BvhFile {
    name: String,
    bytes: Arc<[u8]>,
    text: BvhText,
}

/// Opens a file for [`WriteSupport::Surgical`](crate::format::WriteSupport::Surgical).
pub(super) fn open(
    name: &str,
    bytes: Arc<[u8]>,
    context: &ImportContext<'_>,
) -> Result<Box<dyn SurgicalFile>, ImportError> {
    let mut text = BvhText::parse(&bytes, context)?;
    // They are read again where they are replaced.
    text.rows.numbers = Vec::new();
    Ok(Box::new(BvhFile { name: name.to_owned(), bytes, text }))
}

impl SurgicalFile for BvhFile {
    fn plan(
        &self,
        opened: &ModelData,
        skeleton: &Skeleton,
        takes: &[EditedTake],
    ) -> Result<SavePlan, ExportError> {
        let mut losses = Losses::default();
        let takes = &*takes_of_file(&opened.animation.skeleton, skeleton, takes, &mut losses)?;
        let chosen = takes.iter().position(|take| take.origin == Some(0)).unwrap_or(0);
        for (index, edited) in takes.iter().enumerate().filter(|(index, _)| *index != chosen) {
            let text = format!("take \"{}\": a BVH file has one take", edited.take.name);
            losses.add(format!("/animation/takes/{index}"), code::TAKE_NOT_STORED, text);
        }
        let take = takes.get(chosen).map(|edited| edited.take.as_ref());
        let before = opened.animation.takes.first().map(Arc::as_ref);
        if let Some(take) = take {
            self.named(take, before, chosen, &mut losses);
        }
        let Some(head) = &self.text.head else {
            if take.is_some() {
                let text = "the file has no section MOTION";
                losses.add(format!("/animation/takes/{chosen}"), code::TAKE_NOT_STORED, text);
            }
            return Ok(self.planned(self.bytes.to_vec(), &BvhChanges::default(), losses));
        };
        let frames = take.map_or(0, |take| frames_of(take, before, &self.text));
        self.check_size(frames)?;
        let mut edits = match take {
            Some(take) => joint_edits(take, before, chosen, &self.text, &mut losses),
            None => Vec::new(),
        };
        let mut writer = RowWriter::new(&self.bytes, &self.text, head, &opened.animation.skeleton);
        let old = self.text.rows.frames;
        if frames != old {
            writer.replace(head.count.clone(), &frames.to_string());
        }
        writer.edit_rows(&mut edits, frames.min(old))?;
        if let Some(take) = take.filter(|_| frames > old) {
            writer.append_rows(take, old..frames);
        } else {
            writer.remove_rows(frames..old)?;
        }
        let (bytes, changes) = writer.finish(edits, chosen, &mut losses);
        Ok(self.planned(bytes, &changes, losses))
    }

    fn compact(&self) -> Result<SavePlan, ExportError> {
        Ok(self.planned(self.bytes.to_vec(), &BvhChanges::default(), Losses::default()))
    }

    fn neighbors(&self) -> Vec<String> {
        Vec::new()
    }
}

impl BvhFile {
    fn planned(&self, bytes: Vec<u8>, changes: &BvhChanges, losses: Losses) -> SavePlan {
        let files = vec![OutputFile { name: self.name.clone(), bytes }];
        SavePlan { files, lost: losses.into_list(), changes: Some(changes.report()) }
    }

    /// Lists what the file has no room for in a take as a whole.
    fn named(&self, take: &Take, before: Option<&Take>, index: usize, losses: &mut Losses) {
        let path = format!("/animation/takes/{index}");
        let name = before.map_or(model::TAKE_NAME, |before| &before.name);
        if take.name != name {
            let text = format!("a take of a BVH file has no name; \"{}\" is not stored", take.name);
            losses.add(format!("{path}/name"), code::NAME_NOT_STORED, text);
        }
        if !take.extras.is_empty() {
            losses.add(
                format!("{path}/extras"),
                code::EXTRAS_NOT_STORED,
                "layers, contacts and events are not stored",
            );
        }
        if !take.morphs.is_empty() {
            losses.add(
                format!("{path}/morphs"),
                code::MORPHS_NOT_STORED,
                "weights of shape keys are not stored",
            );
        }
    }

    fn check_size(&self, frames: usize) -> Result<(), ExportError> {
        let numbers = frames.saturating_mul(self.text.hierarchy.channels);
        let limit = crate::limits::KEYS;
        if frames > crate::limits::KEYS_PER_CHANNEL || numbers > limit {
            let reason =
                format!("the take has {frames} frames, {numbers} numbers; at most {limit} are written");
            return Err(ExportError::new(reason));
        }
        Ok(())
    }
}
