//! A thing of the cast with everything that happens to it.

use super::cues::RunCue;
use super::holds::HoldCue;
use super::looks::LookCue;
use super::places::PlaceLane;
use super::poses::PoseLane;
use super::properties::PropertyLane;
use super::spot::StageSpot;
use crate::stage::ground::GroundMesh;
use crate::stage::model::StageModel;
use crate::stage::path::StagePath;
use glam::DQuat;
use std::sync::Arc;

/// What is in focus.
#[derive(Clone, Copy, Debug)]
pub(super) enum FocusTarget {
    /// Everything.
    Everything,
    /// A distance, meters.
    Distance(f64),
    /// A position.
    Spot(StageSpot),
}

/// A thing and its channels.
#[derive(Clone, Debug)]
pub struct PlannedThing {
    /// The id.
    pub id: Box<str>,
    /// Name of its element.
    pub kind: &'static str,
    /// Meters in one length of its model.
    pub scale: f64,
    /// Its model; `None` for things without one, and while it is missing.
    pub model: Option<Arc<StageModel>>,
    /// Whether it has a model that is missing: what is known of its takes and bones is guessed.
    pub is_missing: bool,
    /// Its way; `None` for things that are no path.
    pub path: Option<Arc<StagePath>>,
    /// Its surface, if it is ground.
    pub(super) ground: Option<Arc<GroundMesh>>,
    /// Rotation of a prop in its own space, before its direction; none for other things.
    pub(super) tilt: DQuat,
    pub(super) places: PlaceLane,
    /// The first lane is that of the whole body.
    pub(super) poses: Vec<PoseLane>,
    pub(super) looks: Vec<LookCue>,
    pub(super) holds: Vec<HoldCue>,
    pub(super) properties: Vec<PropertyLane>,
    pub(super) runs: Vec<RunCue>,
    /// The target of a camera unless an action has another one.
    pub(super) aim: Option<StageSpot>,
    pub(super) focus: FocusTarget,
}

impl PlannedThing {
    /// Returns whether it is ground: a prop that ways with `ground="mesh"` follow. Not while its model is missing.
    pub fn is_ground(&self) -> bool {
        self.ground.is_some()
    }

    /// Returns the lane of a property.
    pub(super) fn property(&self, name: &str) -> Option<&PropertyLane> {
        self.properties.iter().find(|lane| lane.name == name)
    }
}
