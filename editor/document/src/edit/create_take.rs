//! Creates a take (thesis §2.2.2.4).

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::Transaction;
use crate::adapter::slot::{TakeVersions, extent};
use crate::adapter::{EditError, ModelAdapter, take_name};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::data::{Channel, Interpolation, Take, Track};
use dragonfly_anim::sample::rest_pose;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Creates a take: a copy of another take, or the rest pose as one key per bone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CreateTake {
    /// Its name.
    pub name: String,
    /// The take to copy; the rest pose where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copy: Option<TakeRef>,
    /// Index in the list; after the copied take, or last, where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<usize>,
}

map_references!(CreateTake { name, copy }, |edit, map| { at: edit.at.map(|at| map.take_place(at, None)) });

impl EditKind for CreateTake {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"create_take","name":"Walk slowly","copy":"Walk"}"#,
        description: "Copies a take.",
    };

    fn label(&self) -> &'static str {
        if self.copy.is_some() { "Duplicate take" } else { "Create take" }
    }

    fn take(&self) -> Option<&TakeRef> {
        None
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let source = self.copy.as_ref().map(|take| work.take(take)).transpose()?;
        let (slot, next) = match source {
            Some(source) => {
                let mut slot = work.copy_of(source);
                // A pending pose belongs to one take only.
                slot.forget_pending();
                (slot, work.index(source) + 1)
            }
            None => {
                let take = Arc::new(rest(work.skeleton()));
                if take.keys() == 0 {
                    return Err(EditError::Nothing("a model without bones has no rest pose"));
                }
                (TakeVersions::unchanged(work.new_id(), None, take), work.takes())
            }
        };
        let id = slot.id;
        work.perform(Op::Insert(self.at.unwrap_or(next), Arc::new(slot)));
        work.perform(Op::Name(id, self.name.clone()));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let copy = from.optional(Arbitrary::take);
        Self { name: from.name(), copy, at: from.optional(|from| from.below(4)) }
    }

    fn take_title(&self, _adapter: &ModelAdapter) -> Option<String> {
        Some(self.name.clone())
    }

    fn allowed(&self, adapter: &ModelAdapter) -> Result<(), EditError> {
        take_name(adapter.slots(), &self.name, None)
    }
}

/// Returns a take of the rest pose: one key per bone, at 0 s.
fn rest(skeleton: &Skeleton) -> Take {
    let zero: Arc<[f32]> = Arc::new([0.0]);
    let track = |(bone, rules): (usize, &dragonfly_anim::data::Bone)| {
        let pose = rest_pose(rules);
        let linear = Interpolation::Linear;
        Track {
            bone: bone as u32,
            translation: Channel::new(Arc::clone(&zero), [pose.translation], linear),
            rotation: Channel::new(Arc::clone(&zero), [pose.rotation], linear),
            scale: Channel::new(Arc::clone(&zero), [pose.scale], linear),
        }
    };
    let mut take = Take { tracks: skeleton.bones.iter().enumerate().map(track).collect(), ..Take::default() };
    (take.start, take.length) = extent(&take);
    take
}
