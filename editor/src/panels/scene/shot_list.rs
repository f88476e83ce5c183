//! The shots among the lanes of a scene.

use dragonfly_anim::stage::lanes::{LaneSubject, SceneBar, SceneLanes};
use dragonfly_anim::stage::time::StageTime;

/// Returns the shots in the order of their begins.
pub fn shots_of(lanes: &SceneLanes) -> &[SceneBar] {
    let lane = lanes.list.iter().find(|lane| lane.subject == LaneSubject::Shots);
    lane.map_or(&[], |lane| &lane.bars)
}

/// Returns the position of the shot that is seen at a time: the last one that has begun. `None` before the first one.
pub fn shot_at(shots: &[SceneBar], time: StageTime) -> Option<usize> {
    shots.partition_point(|shot| shot.begin <= time).checked_sub(1)
}
