//! Saving edited takes into the text that they came from.
//!
//! Only the numbers of edited keys are replaced, rows of keys are added and removed, and their counts are patched; every other
//! byte stays. Lists of keys and animations are added where a frame has none, and animation sets after the last one.
//!
//! Binary and compressed files are not edited: that needs a new file under another name, as in glTF ([`ExportError`]).

mod list;
mod set;

use super::header::{XEncoding, XFile};
use super::mesh::XMesh;
use super::scene::XScene;
use super::{check as code, names, take};
use crate::data::{ModelData, Skeleton, Take};
use crate::format::fixed_skeleton::takes_of_file;
use crate::format::key_changes::KeyChanges;
use crate::format::losses::Losses;
use crate::format::patch::TextPatches;
use crate::format::{
    Conversion, EditedTake, ExportError, ImportContext, ImportError, OutputFile, SavePlan, SurgicalFile,
};
use set::SetWriter;
use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;

/// An opened file.
struct XSource {
    name: String,
    bytes: Arc<[u8]>,
    encoding: XEncoding,
    scene: XScene,
    conversion: Conversion,
    neighbors: Vec<String>,
}

/// Opens a file for [`WriteSupport::Surgical`](crate::format::WriteSupport::Surgical).
pub(super) fn open(
    name: &str,
    bytes: Arc<[u8]>,
    context: &ImportContext<'_>,
) -> Result<Box<dyn SurgicalFile>, ImportError> {
    let file = XFile::open(&bytes, context)?;
    let mut scene = XScene::parse(&file, context)?;
    let encoding = file.encoding;
    let conversion = take::conversion(&scene, context);
    let mut neighbors = Vec::new();
    for texture in scene.textures() {
        let path = crate::format::uri::relative_path(&crate::format::uri::plain_reference(texture)).ok();
        neighbors.extend(path.filter(|path| !neighbors.contains(path)));
    }
    // A save needs none of the geometry.
    (scene.meshes, scene.materials) = (Vec::<XMesh>::new(), Vec::new());
    drop(file);
    Ok(Box::new(XSource { name: name.to_owned(), bytes, encoding, scene, conversion, neighbors }))
}

impl SurgicalFile for XSource {
    fn plan(
        &self,
        opened: &ModelData,
        skeleton: &Skeleton,
        takes: &[EditedTake],
    ) -> Result<SavePlan, ExportError> {
        let (mut losses, mut changes) = (Losses::default(), KeyChanges::default());
        let takes = &*takes_of_file(&opened.animation.skeleton, skeleton, takes, &mut losses)?;
        let mut patches = TextPatches::default();
        if self.encoding != XEncoding::Text {
            self.refuse_edits(opened, takes)?;
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

impl XSource {
    /// Refuses edits of files that are no text.
    fn refuse_edits(&self, opened: &ModelData, takes: &[EditedTake]) -> Result<(), ExportError> {
        let old = &opened.animation.takes;
        let is_same = |(index, edited): (usize, &EditedTake)| {
            edited.origin == Some(index) && old.get(index).is_some_and(|old| **old == *edited.take)
        };
        if takes.len() == old.len() && takes.iter().enumerate().all(is_same) {
            return Ok(());
        }
        let kind = match self.encoding {
            XEncoding::Text => "text",
            XEncoding::Binary => "binary",
            XEncoding::CompressedText | XEncoding::CompressedBinary => "compressed",
        };
        Err(ExportError::new(format!("a {kind} .x file cannot be edited; save the model as .glb")))
    }

    fn patch(
        &self,
        opened: &ModelData,
        takes: &[EditedTake],
        patches: &mut TextPatches,
        changes: &mut KeyChanges,
        losses: &mut Losses,
    ) {
        let sets = &self.scene.sets;
        let writer = SetWriter::new(&self.bytes, &self.scene, &self.conversion, &opened.animation.skeleton);
        let mut replaced = HashSet::new();
        let mut blocks = Vec::with_capacity(takes.len());
        for (index, edited) in takes.iter().enumerate() {
            let take = edited.take.as_ref();
            let origin = edited.origin.filter(|&origin| origin < sets.len());
            let before = origin.and_then(|origin| opened.animation.takes.get(origin));
            let name = take_name(take, before.map(Arc::as_ref), index, losses);
            let is_new = origin.is_none_or(|origin| !replaced.insert(origin));
            blocks.push(match (origin, before) {
                (Some(origin), Some(before)) => {
                    writer.edited(&sets[origin], [take, before], &name, index, changes, losses)
                }
                _ => writer.made(take, &name, index, losses).into_bytes(),
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
        let places: Vec<Range<usize>> = sets.iter().map(|set| set.block.clone()).collect();
        let end = places.last().map_or(self.scene.end.max(super::inflate::HEADER), |place| place.end);
        patches.place(&self.bytes, &places, blocks, end, &writer.line_end().repeat(2));
    }
}

/// Returns the name of a take in the file, and lists what else an animation set has no room for.
pub(super) fn take_name(take: &Take, before: Option<&Take>, index: usize, losses: &mut Losses) -> String {
    let path = format!("/animation/takes/{index}");
    if !take.extras.is_empty() {
        let text = "layers, contacts and events are not stored";
        losses.add(format!("{path}/extras"), code::EXTRAS_NOT_STORED, text);
    }
    if !take.morphs.is_empty() {
        let text = "weights of shape keys are not stored";
        losses.add(format!("{path}/morphs"), code::MORPHS_NOT_STORED, text);
    }
    if before.is_some_and(|before| before.name == take.name) {
        return take.name.clone();
    }
    let name = names::possible(&take.name);
    if name != take.name {
        let text = format!("the take \"{}\" is called \"{name}\"", take.name);
        losses.add(format!("{path}/name"), code::NAME_NOT_STORED, text);
    }
    name
}
