//! Poses as text, so that they go through the system's clipboard, between two programs, and into text editors.

use crate::edit::BonePose;
use serde::{Deserialize, Serialize};

/// Longest text that is looked at, bytes: ten thousand bones fit in.
const LONGEST: usize = 4 << 20;

/// What is written.
#[derive(Serialize, Deserialize)]
struct Text {
    /// What it is: "pose".
    dragonfly: String,
    version: u32,
    poses: Vec<BonePose>,
}

/// The text of poses.
pub fn to_text(poses: &[BonePose]) -> String {
    let text = Text { dragonfly: "pose".to_owned(), version: 1, poses: poses.to_vec() };
    // Plain data always has a text.
    serde_json::to_string_pretty(&text).unwrap_or_default()
}

/// The poses in a text; `None` where it is anything else.
pub fn from_text(text: &str) -> Option<Vec<BonePose>> {
    if text.len() > LONGEST {
        return None;
    }
    let text: Text = serde_json::from_str(text.trim()).ok()?;
    (text.dragonfly == "pose" && text.version == 1 && !text.poses.is_empty()).then_some(text.poses)
}
