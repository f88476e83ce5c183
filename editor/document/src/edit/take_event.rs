//! Events as edits name them.

use super::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An event of a take: at its time a game plays a sound, starts an effect, calls a function.
///
/// Importers map it like this: Unity, `AnimationEvent.time` and `functionName`, numbers and texts of the payload as its parameters;
/// Unreal, an animation notify of that name; Godot, a key of a method call track with the payload as arguments; Bevy, an
/// event that is added to the clip at that time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TakeEvent {
    /// Seconds, on the clock of the take.
    pub time: f32,
    /// The name, 1 to 200 characters.
    pub name: String,
    /// Any JSON value that goes with the event, at most 16 KiB of text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub payload: Option<serde_json::Value>,
}

impl TakeEvent {
    pub(super) fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let name = from.choice(["step", "fire", ""]).to_owned();
        let payload = from.flag().then(|| serde_json::json!({ "foot": "left", "strength": 0.5 }));
        Self { time: from.time(), name, payload }
    }
}
