//! Frames become bones.

use super::check as code;
use super::scene::{XFrame, XScene};
use crate::data::{Bone, BoneIndex, Skeleton, Transform};
use crate::format::matrices::{inverse, split};
use crate::format::names::UniqueNames;
use crate::format::{AxisMap, ImportContext, ImportError, Place};
use glam::Mat4;
use std::collections::HashMap;

/// Name of a frame that has none.
const UNNAMED: &str = "frame";

/// The bones while they are made.
pub(super) struct BoneList<'a> {
    context: &'a ImportContext<'a>,
    bones: Vec<Bone>,
    to_roots: Vec<Mat4>,
    names: UniqueNames,
    /// The first frame of each name.
    by_name: HashMap<String, BoneIndex>,
    /// Number of bones that are frames.
    frames: usize,
}

impl<'a> BoneList<'a> {
    /// Returns the bones of all frames.
    pub(super) fn of(
        scene: &XScene,
        axes: &AxisMap,
        context: &'a ImportContext<'a>,
    ) -> Result<Self, ImportError> {
        let mut list = Self {
            context,
            bones: context.vec(&Place::File, scene.frames.len())?,
            to_roots: context.vec(&Place::File, scene.frames.len())?,
            names: UniqueNames::default(),
            by_name: HashMap::new(),
            frames: scene.frames.len(),
        };
        for frame in &scene.frames {
            context.work(4)?;
            list.add_frame(frame, axes)?;
        }
        Ok(list)
    }

    fn add_frame(&mut self, frame: &XFrame, axes: &AxisMap) -> Result<(), ImportError> {
        let matrix = axes.matrix(frame.matrix);
        let Some((rest, rest_matrix)) = split(matrix) else {
            return Err(too_large(&frame.name));
        };
        if rest_matrix.is_some() {
            let text = format!(
                "the transform of the frame \"{}\" is sheared; it is shown, but cannot be edited",
                frame.name
            );
            self.context.warn(Place::File, code::MATRIX_INVALID, text);
        }
        let parent = frame.parent.map(|parent| parent as BoneIndex);
        let own = rest_matrix.unwrap_or_else(|| rest.to_matrix());
        let to_root = frame.parent.map_or(own, |parent| self.to_roots[parent] * own);
        if !to_root.is_finite() {
            return Err(too_large(&frame.name));
        }
        let number = self.bones.len() as BoneIndex;
        if !frame.name.is_empty() {
            self.by_name.entry(frame.name.clone()).or_insert(number);
        }
        let name = if frame.name.is_empty() { UNNAMED.to_owned() } else { frame.name.clone() };
        let (name, _) = self.names.make(name);
        let offset = inverse(to_root).unwrap_or(Mat4::IDENTITY);
        self.bones.push(Bone { name, parent, rest, rest_matrix, offset, node: None });
        self.to_roots.push(to_root);
        Ok(())
    }

    /// Returns the number of bones.
    pub(super) fn len(&self) -> usize {
        self.bones.len()
    }

    /// Returns the bone of the first frame of this name.
    pub(super) fn find(&self, name: &str) -> Option<BoneIndex> {
        self.by_name.get(name).copied().filter(|&bone| (bone as usize) < self.frames)
    }

    /// Returns the bone that a skin names. For one that is not in the file a bone is added that does not move, so that its vertices
    /// stay where they are bound.
    pub(super) fn of_skin(&mut self, name: &str, offset: Mat4) -> Result<BoneIndex, ImportError> {
        if let Some(&bone) = self.by_name.get(name) {
            return Ok(bone);
        }
        let text = format!(
            "a skin refers to the frame \"{name}\", which is not in the file; its vertices do not move"
        );
        self.context.warn(Place::File, code::FRAME_MISSING, text);
        self.context.charge(&Place::File, 2 * size_of::<Bone>() as u64 + 8 * name.len() as u64)?;
        let to_root = inverse(offset).unwrap_or(Mat4::IDENTITY);
        let (rest, rest_matrix) = split(to_root).unwrap_or((Transform::IDENTITY, None));
        let number = self.bones.len() as BoneIndex;
        self.by_name.insert(name.to_owned(), number);
        let (name, _) = self.names.make(name.to_owned());
        self.bones.push(Bone { name, parent: None, rest, rest_matrix, offset, node: None });
        self.to_roots.push(to_root);
        Ok(number)
    }

    /// Returns the skeleton. `offsets` are those of skins; the first one of a bone is used.
    pub(super) fn finish(mut self, offsets: impl Iterator<Item = (BoneIndex, Mat4)>) -> Skeleton {
        let mut is_bound = vec![false; self.bones.len()];
        for (bone, offset) in offsets {
            if !std::mem::replace(&mut is_bound[bone as usize], true) {
                self.bones[bone as usize].offset = offset;
            }
        }
        Skeleton { bones: self.bones }
    }
}

fn too_large(name: &str) -> ImportError {
    let reason = format!("the transform of the frame \"{name}\" is too large");
    ImportError::Invalid { place: Place::File, code: code::HUGE_POSITION, reason }
}
