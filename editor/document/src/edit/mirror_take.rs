//! Mirrors a take.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::target::BoneFinder;
use super::{Arbitrary, BoneRef, EditedBones, Example, SAME_TIME, TakeRef};
use crate::adapter::plan::{Transaction, contacts, finite, rewrite};
use crate::adapter::{EditError, ModelAdapter};
use crate::bones::{BodySide, MirrorPairs};
use crate::posing::mirror::Mirror;
use crate::posing::mirror_take::{MirrorRange, mirrored_take};
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::frames::frame_rate;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Mirrors a take, or a range of it: each side of the body gets the motion of the other, or one side that of the other. Pairs of bones
/// are guessed from their names and positions, as for mirrored poses, and can be corrected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MirrorTake {
    /// The take.
    pub take: TakeRef,
    /// The bones whose motion is mirrored: their mirror bones get it, and nothing else changes. All where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// The side whose motion the other side gets; both sides and the middle where absent. Bones in the middle stay as they are then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<BodySide>,
    /// Corrections of the guessed pairs: a left and a right bone; the same bone twice is in the middle.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<[BoneRef; 2]>,
    /// Seconds; the start of the take by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f32>,
    /// Seconds; the end of the take by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f32>,
}

impl MirrorTake {
    /// Returns the bones that get the motion of others; none where all do.
    fn targets(&self, skeleton: &Skeleton, pairs: &MirrorPairs) -> Vec<BoneIndex> {
        let mut finder = BoneFinder::new(skeleton);
        let named: Vec<BoneIndex> = self.bones.iter().filter_map(|bone| finder.find(bone)).collect();
        let Some(side) = self.side else {
            return named.into_iter().filter_map(|bone| pairs.mirror_of(bone)).collect();
        };
        let is_named = |bone: &BoneIndex| self.bones.is_empty() || named.contains(bone);
        let both = pairs.pairs.iter().map(|pair| match side {
            BodySide::Left => (pair.left, pair.right),
            BodySide::Right => (pair.right, pair.left),
        });
        both.filter(|(from, _)| is_named(from)).map(|(_, to)| to).collect()
    }

    /// Returns the guessed pairs with the corrections; bones that do not exist are left out.
    fn pairs(&self, skeleton: &Skeleton) -> MirrorPairs {
        let mut finder = BoneFinder::new(skeleton);
        let found =
            self.pairs.iter().filter_map(|[left, right]| Some([finder.find(left)?, finder.find(right)?]));
        let corrections: Vec<[BoneIndex; 2]> = found.collect();
        MirrorPairs::of(skeleton).corrected(&corrections)
    }
}

map_references!(MirrorTake { take, bones, side, pairs, from, to });

impl EditKind for MirrorTake {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"mirror_take","take":"Walk"}"#,
        description: "Mirrors the take: what the left side did, the right side does.",
    };

    const LAYERS: LayerUse = LayerUse::NoLayers;

    fn label(&self) -> &'static str {
        "Mirror take"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        if self.bones.is_empty() && self.side.is_none() {
            return EditedBones::All;
        }
        EditedBones::Named(self.targets(skeleton, &self.pairs(skeleton)).into_iter().collect())
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let take = Arc::clone(&work.slot(id).result);
        for bone in self.bones.iter().chain(self.pairs.iter().flatten()) {
            work.bone(bone)?;
        }
        let mirror = Mirror::with(work.skeleton(), self.pairs(work.skeleton()));
        let targets = self.targets(work.skeleton(), &mirror.pairs);
        if targets.is_empty() && (self.side.is_some() || !self.bones.is_empty()) {
            return Err(EditError::Nothing("none of the bones has a mirror bone"));
        }
        let range = self.range(take.start, take.end(), 1.0 / frame_rate(&take))?;
        let mirrored = mirrored_take(&mirror, work.skeleton(), &take, range, &targets);
        let mirrored = mirrored.ok_or(EditError::Nothing(
            "a range of a channel with tangents cannot be mirrored: make it linear first, or mirror the whole take",
        ))?;
        if rewrite::channels(work, id, &mirrored)? {
            if range.is_none() && self.side.is_none() && self.bones.is_empty() {
                contacts::follow(work, id, |track| track.mirrored(|bone| mirror.pairs.mirror_of(bone)))?;
            }
            Ok(())
        } else {
            Err(EditError::Nothing("the take is its own mirror image"))
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let (start, end) = (from.optional(Arbitrary::time), from.optional(Arbitrary::time));
        let side = from.optional(|from| from.choice([BodySide::Left, BodySide::Right]));
        let pairs = if from.below(3) == 0 { vec![[from.bone(), from.bone()]] } else { Vec::new() };
        Self { take: from.take(), bones: from.bones(), side, pairs, from: start, to: end }
    }
}

impl MirrorTake {
    /// Returns the range to mirror; `None` for the whole take.
    fn range(&self, start: f32, end: f32, frame: f32) -> Result<Option<MirrorRange>, EditError> {
        let (from, to) = (self.from.unwrap_or(start), self.to.unwrap_or(end));
        for time in [from, to] {
            finite("the time", time)?;
            if !(time >= start - SAME_TIME && time <= end + SAME_TIME) {
                return Err(EditError::Outside { time, start, end });
            }
        }
        if to < from {
            return Err(EditError::Number { what: "an end before the start", value: to });
        }
        let whole = from <= start + SAME_TIME && to >= end - SAME_TIME;
        Ok((!whole).then_some(MirrorRange { from, to, frame }))
    }
}
