//! Heads that look at things.

use super::fade::ActiveSpan;
use super::spot::StageSpot;
use crate::ik::Gaze;

/// A role or camera that looks at something.
#[derive(Clone, Debug)]
pub(super) struct LookCue {
    pub(super) span: ActiveSpan,
    pub(super) weight: f32,
    pub(super) at: StageSpot,
    /// The bones that turn; empty for a camera.
    pub(super) gazes: Vec<Gaze>,
}
