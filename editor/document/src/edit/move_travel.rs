//! Moves the travel of a figure from one bone to another.

use super::kind::EditKind;
use super::map_references::map_references;
use super::travel_parts::travel_options;
use super::{Arbitrary, BoneRef, EditedBones, Example, TakeRef, TravelPart};
use crate::adapter::plan::{Transaction, rewrite};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::motion::{move_travel, travel_bones};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Moves travel from a bone to one above or below it, for example from the hips to the root. The figure looks the same: the other
/// children of the bones between get keys that keep them in place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoveTravel {
    /// The take.
    pub take: TakeRef,
    /// The bone that travels.
    pub from: BoneRef,
    /// The bone that is to travel, above or below it.
    pub to: BoneRef,
    /// The parts of the travel: `x`, `z`, `height`, `yaw`; all but the height by default.
    #[serde(default = "TravelPart::usual")]
    pub parts: Vec<TravelPart>,
    /// Standard deviation of the Gaussian that smooths the travel, in frames; what it removes stays in the bone.
    #[serde(default)]
    pub smooth: f32,
    /// Frames per second of new keys; by default the lowest usual rate that fits the keys of the take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f32>,
}

map_references!(MoveTravel { take, from, to, parts, smooth, rate });

impl EditKind for MoveTravel {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"move_travel","take":"Walk","from":"Hips","to":"Root","parts":["x","z","yaw"],"smooth":0}"#,
        description: "Lets the root walk instead of the hips.",
    };

    fn label(&self) -> &'static str {
        "Move travel"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        let found = [&self.from, &self.to].map(|bone| bone.find_in(skeleton));
        let [Some(from), Some(to)] = found else { return EditedBones::Named(Default::default()) };
        EditedBones::Named(travel_bones(skeleton, from, to).into_iter().collect())
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let take = Arc::clone(&work.slot(id).result);
        let (from, to) = (work.bone(&self.from)?, work.bone(&self.to)?);
        let options = travel_options(&self.parts, self.smooth, self.rate, &take)?;
        let moved = move_travel(&take, work.skeleton(), from, to, &options)?;
        if rewrite::channels(work, id, &moved.take)? {
            Ok(())
        } else {
            Err(EditError::Nothing("the bone does not travel"))
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self {
            take: from.take(),
            from: from.bone(),
            to: from.bone(),
            parts: TravelPart::arbitrary(from),
            smooth: if from.flag() { 0.0 } else { from.between(0.0, 5.0) },
            rate: from.optional(|from| from.between(5.0, 60.0)),
        }
    }
}
