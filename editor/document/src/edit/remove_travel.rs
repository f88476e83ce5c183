//! Puts a take in place.

use super::kept_travel::{TRAVEL, kept_travel, travel_text};
use super::kind::EditKind;
use super::map_references::map_references;
use super::travel_parts::travel_options;
use super::{Arbitrary, BoneRef, EditedBones, Example, TakeRef, TravelPart};
use crate::adapter::op::Op;
use crate::adapter::plan::{Transaction, rewrite};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::motion::take_travel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Puts a take in place: removes the travel of a bone. It is kept in the extras of the take, for `restore_travel`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RemoveTravel {
    /// The take.
    pub take: TakeRef,
    /// The bone that travels.
    pub bone: BoneRef,
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

map_references!(RemoveTravel { take, bone, parts, smooth, rate });

impl EditKind for RemoveTravel {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"remove_travel","take":"Walk","bone":"Hips","parts":["x","z"],"smooth":0}"#,
        description: "Lets the figure walk on the spot.",
    };

    fn label(&self) -> &'static str {
        "Remove travel"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::named([&self.bone], skeleton)
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let take = Arc::clone(&work.slot(id).result);
        let bone = work.bone(&self.bone)?;
        let options = travel_options(&self.parts, self.smooth, self.rate, &take)?;
        let travel = take_travel(&take, work.skeleton(), bone, &options)?;
        if !rewrite::channels(work, id, &travel.take)? {
            return Err(EditError::Nothing("the bone does not travel"));
        }
        let mut kept = kept_travel(&work.slot(id).original.extras);
        kept.push(travel.motion);
        work.perform(Op::Extras(id, TRAVEL.to_owned(), travel_text(&kept)));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self {
            take: from.take(),
            bone: from.bone(),
            parts: TravelPart::arbitrary(from),
            smooth: if from.flag() { 0.0 } else { from.between(0.0, 5.0) },
            rate: from.optional(|from| from.between(5.0, 60.0)),
        }
    }
}
