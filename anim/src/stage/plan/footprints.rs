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
    /// The place below the joint of the foot, at the height of the thing, or of the mesh that its way follows; meters.
    pub position: DVec3,
}

/// An action that follows a path, found in a plan and looked up in it without a search.
#[derive(Clone, Copy, Debug)]
pub struct PathWalk {
    /// The thing, as a position in [`StagePlan::things`].
    pub thing: usize,
    /// The action, as a position in [`StageScript::actions`](crate::stage::script::StageScript::actions).
    pub action: usize,
    cue: usize,
}

impl StagePlan {
    /// Returns the actions that follow paths, thing by thing.
    pub fn path_walks(&self) -> impl Iterator<Item = PathWalk> {
        self.things.iter().enumerate().flat_map(|(thing, planned)| {
            let cues = planned.places.cues.iter().enumerate();
            let follows = cues.filter(|(_, cue)| matches!(cue.kind, MotionKind::Follow(_)));
            follows.map(move |(at, cue)| PathWalk { thing, action: cue.action, cue: at })
        })
    }

    /// Returns the footprints of a thing in an action that follows a path with a take, in the order of time: 2,000 places at most. Empty for
    /// other actions and takes without contacts.
    pub fn footprints(&self, thing: usize, action: usize) -> Vec<Footprint> {
        self.walk_of(thing, action).map_or_else(Vec::new, |walk| self.footprints_of(walk))
    }

    /// Returns the footprints of a walk, as [`Self::footprints`]. Empty for a walk of another plan that this one has not.
    pub fn footprints_of(&self, walk: PathWalk) -> Vec<Footprint> {
        let Some((planned, stride)) = self.stride(walk) else { return Vec::new() };
        let mut found = Vec::new();
        for contact in stride.take().contacts() {
            let landings = (0..).map_while(|turn| landing(planned, walk.cue, contact, turn));
            found.extend(landings.take(MOST).map(|(time, position)| Footprint {
                foot: contact.foot,
                time,
                position,
            }));
        }
        found.sort_by_key(|print| (print.time, print.foot));
        found.truncate(MOST);
        found
    }

    /// Returns the distance that one cycle of the take goes with which an action follows a path, meters: two steps of a walk. `None` for other actions
    /// and for takes without a stride.
    pub fn stride_on_path(&self, thing: usize, action: usize) -> Option<f64> {
        self.stride_of(self.walk_of(thing, action)?)
    }

    /// Returns the distance that one cycle of the take of a walk goes, as [`Self::stride_on_path`].
    pub fn stride_of(&self, walk: PathWalk) -> Option<f64> {
        self.stride(walk).map(|(_, stride)| stride.cycle())
    }

    fn walk_of(&self, thing: usize, action: usize) -> Option<PathWalk> {
        let cue = self.things.get(thing)?.places.cues.iter().position(|cue| cue.action == action)?;
        Some(PathWalk { thing, action, cue })
    }

    fn stride(&self, walk: PathWalk) -> Option<(&PlannedThing, &PathStride)> {
        let planned = self.things.get(walk.thing)?;
        match &planned.places.cues.get(walk.cue)?.kind {
            MotionKind::Follow(follower) => Some((planned, follower.stride.as_ref()?)),
            MotionKind::Put { .. } | MotionKind::Turn { .. } | MotionKind::Travel { .. } => None,
        }
    }
}
