//! Saving edited takes into the file that they came from.
//!
//! Only the numbers of edited keys are replaced, rows of keys are added and removed, and their counts are patched; every other
//! byte stays. A row has the position, the scale and the rotation of a bone, so a key of one of them becomes a row with the
//! values of the other two at its time. New takes are added after the last one. What the importer corrected (rotations of other
//! lengths, rows that are not in order) stays as it is.

mod clip;

pub(super) use clip::{ClipWriter, possible_name};

use super::check as code;
use super::scan::M3dScanner;
use super::text::M3dText;
use crate::data::{ModelData, Skeleton};
use crate::format::fixed_skeleton::takes_of_file;
use crate::format::key_changes::KeyChanges;
use crate::format::losses::Losses;
use crate::format::patch::TextPatches;
use crate::format::{
    EditedTake, ExportError, ImportContext, ImportError, OutputFile, SavePlan, SurgicalFile,
};
use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;

/// An opened file.
struct M3dFile {
    name: String,
    bytes: Arc<[u8]>,
    text: M3dText,
    neighbors: Vec<String>,
}

/// Opens a file for [`WriteSupport::Surgical`](crate::format::WriteSupport::Surgical).
pub(super) fn open(
    name: &str,
    bytes: Arc<[u8]>,
    context: &ImportContext<'_>,
) -> Result<Box<dyn SurgicalFile>, ImportError> {
    let mut text = M3dText::parse(&bytes, context)?;
    let mut neighbors = Vec::new();
    for name in text.materials.iter().flat_map(|material| material.textures(&bytes)) {
        let path = crate::format::uri::relative_path(&crate::format::uri::plain_reference(&name)).ok();
        neighbors.extend(path.filter(|path| !neighbors.contains(path)));
    }
    // A save needs none of the geometry.
    (text.vertices, text.triangles.indices) = (super::geometry::M3dVertices::default(), Vec::new());
    Ok(Box::new(M3dFile { name: name.to_owned(), bytes, text, neighbors }))
}

impl SurgicalFile for M3dFile {
    fn plan(
        &self,
        opened: &ModelData,
        skeleton: &Skeleton,
        takes: &[EditedTake],
    ) -> Result<SavePlan, ExportError> {
        let (mut losses, mut changes) = (Losses::default(), KeyChanges::default());
        let takes = &*takes_of_file(&opened.animation.skeleton, skeleton, takes, &mut losses)?;
        let mut patches = TextPatches::default();
        if self.text.bones.is_empty() {
            for (index, edited) in takes.iter().enumerate() {
                let text = format!("take \"{}\": a file without bones has no takes", edited.take.name);
                losses.add(format!("/animation/takes/{index}"), code::TAKE_NOT_STORED, text);
            }
        } else {
            self.patch(opened, takes, &mut patches, &mut changes, &mut losses);
        }
        let bytes = patches.apply(&self.bytes, 0..self.bytes.len());
        let files = vec![OutputFile { name: self.name.clone(), bytes }];
        Ok(SavePlan { files, lost: losses.into_list(), changes: Some(changes.report()) })
    }

    fn compact(&self) -> Result<SavePlan, ExportError> {
        let files = vec![OutputFile { name: self.name.clone(), bytes: self.bytes.to_vec() }];
        Ok(SavePlan { files, lost: Vec::new(), changes: Some(KeyChanges::default().report()) })
    }

    fn neighbors(&self) -> Vec<String> {
        self.neighbors.clone()
    }
}

impl M3dFile {
    fn patch(
        &self,
        opened: &ModelData,
        takes: &[EditedTake],
        patches: &mut TextPatches,
        changes: &mut KeyChanges,
        losses: &mut Losses,
    ) {
        let clips = &self.text.clips;
        let mut writer = ClipWriter::new(&self.bytes, &self.text, &opened.animation.skeleton);
        let mut replaced = HashSet::new();
        let mut blocks = Vec::with_capacity(takes.len());
        for (index, edited) in takes.iter().enumerate() {
            let origin = edited.origin.filter(|&origin| origin < clips.len());
            let before = origin.and_then(|origin| opened.animation.takes.get(origin));
            let name = writer.name(&edited.take, before.map(Arc::as_ref), index, losses);
            let is_new = origin.is_none_or(|origin| !replaced.insert(origin));
            blocks.push(match (origin, before) {
                (Some(origin), Some(before)) => {
                    writer.edited(&clips[origin], &edited.take, before, &name, index, changes, losses)
                }
                _ => writer.made(&edited.take, &name, index, losses).into_bytes(),
            });
            if is_new {
                changes.take(&name, "added");
            }
        }
        for (origin, take) in opened.animation.takes.iter().enumerate() {
            if !replaced.contains(&origin) {
                changes.take(&take.name, "removed");
            }
        }
        if let Some(count) = self.text.clip_count.clone().filter(|_| takes.len() != clips.len()) {
            patches.replace(count, takes.len().to_string());
        }
        let places: Vec<Range<usize>> = clips.iter().map(|clip| clip.block.clone()).collect();
        let (banner_end, has_banner) = self.text.clips_at;
        let end = places.last().map_or(banner_end, |place| place.end);
        let line = writer.line_end();
        if !has_banner && !blocks.is_empty() {
            let banner = format!("{line}{line}***************AnimationClips****************");
            patches.replace(end..end, banner);
        }
        let separator = match &places[..] {
            [.., one, two] if M3dScanner::blank(&self.bytes[one.end..two.start]) => {
                String::from_utf8_lossy(&self.bytes[one.end..two.start]).into_owned()
            }
            [] => line.to_owned(),
            _ => line.repeat(2),
        };
        patches.place(&self.bytes, &places, blocks, end, &separator);
    }
}
