//! The note that effects are not drawn, where one is added and where one is on.

use dragonfly_anim::stage::lanes::{SceneLane, SceneLanes};
use dragonfly_anim::stage::time::StageTime;

/// Note of the panels about effects.
pub(in crate::panels) const NOT_DRAWN: &str = "Effects are not drawn yet";

/// Returns the id of an effect that is on at a time; `None` where none is.
pub(in crate::panels) fn effect_on(lanes: &SceneLanes, at: StageTime) -> Option<&str> {
    let is_on = |lane: &&SceneLane| {
        is_of_effect(lane) && lane.bars.iter().any(|bar| bar.kind == "run" && bar.begin <= at && at < bar.end)
    };
    lanes.list.iter().find(is_on).map(|lane| &*lane.name)
}

/// Returns whether a lane is that of an effect.
pub(in crate::panels) fn is_of_effect(lane: &SceneLane) -> bool {
    lane.kind == "effect"
}
