//! Footprints of a thing on its way, and the length of its stride.

use super::StagePlan;
use super::feet::landing;
use super::follow::PathStride;
use super::places::MotionKind;
use super::thing::PlannedThing;
use crate::stage::time::StageTime;
use glam::DVec3;

/// Largest number of footprints of an action.
const MOST: usize = 2_000;

/// A place where a foot is on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Position of the foot in the list of feet of the model.
    pub foot: usize,
    /// The time at which it lands.
    pub time: StageTime,
    /// The place below the joint of the foot, at the height of the thing; meters.
    pub position: DVec3,
}

impl StagePlan {
    /// Returns the footprints of a thing in an action that follows a path with a take, in the order of time: 2,000 places at most. Empty for
    /// other actions and takes without contacts.
    pub fn footprints(&self, thing: usize, action: usize) -> Vec<Footprint> {
        let Some((planned, cue, stride)) = self.strides(thing, action) else { return Vec::new() };
        let mut found = Vec::new();
        for contact in stride.take().contacts() {
            let landings =
                (0..).map_while(|turn| landing(&planned.places, (cue, planned.scale), contact, turn));
            found.extend(landings.take(MOST).map(|(time, position)| {
                let height = planned.places.by(cue, time).position.y;
                Footprint { foot: contact.foot, time, position: position.with_y(height) }
            }));
        }
        found.sort_by_key(|print| (print.time, print.foot));
        found.truncate(MOST);
        found
    }

    /// Returns the distance that one cycle of the take goes with which an action follows a path, meters: two steps of a walk. `None` for other actions
    /// and for takes without a stride.
    pub fn stride_on_path(&self, thing: usize, action: usize) -> Option<f64> {
        self.strides(thing, action).map(|(_, _, stride)| stride.cycle())
    }

    fn strides(&self, thing: usize, action: usize) -> Option<(&PlannedThing, usize, &PathStride)> {
        let planned = self.things.get(thing)?;
        let cue = planned.places.cues.iter().position(|cue| cue.action == action)?;
        match &planned.places.cues[cue].kind {
            MotionKind::Follow(follower) => Some((planned, cue, follower.stride.as_ref()?)),
            MotionKind::Put { .. } | MotionKind::Turn { .. } | MotionKind::Travel { .. } => None,
        }
    }
}
