//! Moves keys to whole frames.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, KeySet, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{KeyMove, Transaction, timing::move_keys};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Moves keys to whole frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SnapKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys of bones.
    pub keys: Vec<KeySet>,
    /// Stretches of time, start and end in seconds, in which keys of shape keys are moved to whole frames.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<[f32; 2]>,
    /// Frames per second, 1 to 1000; frame 0 is at 0 s.
    pub rate: f32,
}

map_references!(SnapKeys { take, shapes, rate }, |edit, map| {
    keys: map.any(&edit.keys, !edit.shapes.is_empty())?,
});

impl EditKind for SnapKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"snap_keys","take":"Walk","keys":[{}],"rate":30}"#,
        description: "Moves all keys to whole frames.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    const SHOWS_DIFFERENCE: bool = true;

    fn label(&self) -> &'static str {
        "Snap keys to frames"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::of_keys(&self.keys, skeleton)
    }

    fn keys(&self) -> &[KeySet] {
        &self.keys
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        if !(1.0..=1000.0).contains(&self.rate) {
            return Err(EditError::Number { what: "the frame rate", value: self.rate });
        }
        let rate = f64::from(self.rate);
        // A time shortly before 0 s goes to 0, not to -0, which a saved file does not distinguish.
        let nearest = |time: f32| ((f64::from(time) * rate).round() / rate) as f32 + 0.0;
        move_keys(work, &self.take, (&self.keys, &self.shapes), KeyMove::PLAIN, nearest)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self {
            take: from.take(),
            keys: from.keys(),
            shapes: from.shapes(),
            rate: from.choice([8.0, 24.0, 30.0]),
        }
    }
}
