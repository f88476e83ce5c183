//! Closes a loop.

use super::contact_span::{named, stored_of_limbs};
use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, ContactSpan, EditedBones, Example, TakeRef};
use crate::adapter::plan::{Transaction, rewrite};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::frames::frame_rate;
use dragonfly_anim::loops::{CloseSettings, close_loop};
use dragonfly_anim::motion::Axis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Changes the end of a take so that it leads into the start: position and velocity of every bone continue when the take repeats.
/// Step channels stay as they are. Keys are added at each of the last frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CloseLoop {
    /// The take.
    pub take: TakeRef,
    /// Number of frames before the end that change.
    pub frames: u32,
    /// The bone that travels: its way on the ground stays as it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub travel: Option<BoneRef>,
    /// Contacts of feet that are held. Where empty, those stored with the take.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<ContactSpan>,
    /// Frames per second; by default the lowest usual rate that fits the keys of the take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f32>,
}

map_references!(CloseLoop { take, frames, travel, contacts, rate });

impl EditKind for CloseLoop {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"close_loop","take":"Walk","frames":8,"travel":"Hips"}"#,
        description: "Lets the last 8 frames lead into the start; the hips go on walking.",
    };

    const LAYERS: LayerUse = LayerUse::NoLayers;

    fn label(&self) -> &'static str {
        "Close loop"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::All
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let take = Arc::clone(&work.slot(id).result);
        let rate = self.rate.unwrap_or_else(|| frame_rate(&take));
        let travel = self.travel.as_ref().map(|bone| work.bone(bone)).transpose()?;
        let mut contacts = named(work, &self.contacts)?;
        if contacts.is_empty() {
            contacts = stored_of_limbs(work, id);
        }
        let settings = CloseSettings { rate, frames: self.frames, travel, up: Axis::Y };
        let closed = close_loop(&take, work.skeleton(), &contacts, &settings)?;
        if rewrite::channels(work, id, &closed)? {
            Ok(())
        } else {
            Err(EditError::Nothing("the take repeats without a jump already"))
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let contacts = if from.below(4) == 0 { vec![ContactSpan::arbitrary(from)] } else { Vec::new() };
        let rate = from.optional(|from| from.between(5.0, 60.0));
        let travel = from.optional(Arbitrary::bone);
        Self { take: from.take(), frames: from.below(8) as u32, travel, contacts, rate }
    }
}
