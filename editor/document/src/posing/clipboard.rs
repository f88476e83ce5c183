//! Poses as text for the system clipboard, for other programs and text editors.

use crate::edit::BonePose;
use serde::{Deserialize, Serialize};

/// Maximum length of a text in bytes: enough for ten thousand bones.
const MAX_BYTES: usize = 4 << 20;

/// The format of the text.
#[derive(Serialize, Deserialize)]
struct PoseText {
    /// The type of the contents: "pose".
    dragonfly: String,
    version: u32,
    poses: Vec<BonePose>,
}

/// Returns the text of poses.
pub fn to_text(poses: &[BonePose]) -> String {
    let text = PoseText { dragonfly: "pose".to_owned(), version: 1, poses: poses.to_vec() };
    // Plain data can always be serialized.
    serde_json::to_string_pretty(&text).unwrap_or_default()
}

/// Returns the poses of a text; `None` where it is not a text of poses.
pub fn from_text(text: &str) -> Option<Vec<BonePose>> {
    if text.len() > MAX_BYTES {
        return None;
    }
    let text: PoseText = serde_json::from_str(text.trim()).ok()?;
    (text.dragonfly == "pose" && text.version == 1 && !text.poses.is_empty()).then_some(text.poses)
}
