//! Finds the contacts of a take and stores them with it.

use super::contact_span::detected;
use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditUnit, EditedBones, Example, TakeRef};
use crate::adapter::plan::{Transaction, contacts};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::contact::{ContactThresholds, feet_by_name};
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::frames::frame_rate;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Finds the contacts of bones with the ground from height and speed, and stores them with the take in place of those that these bones
/// had. The motion stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DetectContacts {
    /// The take.
    pub take: TakeRef,
    /// The bones. Where empty, those whose names say that they are feet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// Meters in one unit of length of the model: 1 for glTF, 0.01 for centimeters, `"guess"` for what the size of the figure suggests; 1 if
    /// absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meters_per_unit: Option<EditUnit>,
    /// Frames per second; by default the lowest usual rate that fits the keys of the take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f32>,
}

map_references!(DetectContacts { take, bones, meters_per_unit, rate });

impl EditKind for DetectContacts {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"detect_contacts","take":"Walk","bones":["Foot.L","Foot.R"]}"#,
        description: "Stores with the take when the feet are on the ground.",
    };

    fn label(&self) -> &'static str {
        "Detect contacts"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let meters_per_unit = EditUnit::length(self.meters_per_unit, 1.0, work.skeleton())?;
        let mut bones: Vec<BoneIndex> =
            self.bones.iter().map(|bone| work.bone(bone)).collect::<Result<_, _>>()?;
        if bones.is_empty() {
            bones = feet_by_name(work.skeleton());
        }
        if bones.is_empty() {
            return Err(EditError::Nothing("no bone is called a foot: name the bones"));
        }
        let take = Arc::clone(work.slot(id).shown());
        let rate = self.rate.unwrap_or_else(|| frame_rate(&take));
        let thresholds = ContactThresholds { meters_per_unit, ..ContactThresholds::default() };
        let found = detected(work, &take, &bones, rate, &thresholds)?;
        if found.is_empty() && contacts::stored(work, id).is_empty() {
            return Err(EditError::Nothing("no foot is in contact with the ground"));
        }
        let track = contacts::stored(work, id).replaced(&bones, found);
        if contacts::store(work, id, &track)? {
            Ok(())
        } else {
            Err(EditError::Nothing("the take has these contacts already"))
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let rate = from.optional(|from| from.between(5.0, 60.0));
        let meters_per_unit = from.choice([None, Some(1.0.into()), Some(0.01.into()), Some(EditUnit::GUESS)]);
        Self { take: from.take(), bones: vec![from.bone()], meters_per_unit, rate }
    }
}
