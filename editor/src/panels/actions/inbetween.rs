//! In-betweens: the selected keys get other values, at once.

use super::edit;
use crate::panels::inbetween::{ChosenKeys, InBetweenTool, next_take};
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::edit::{Edit, RepeatCount, RepeatKeys, RepeatMode, ResampleKeys, TurnKeys, TurnWay};

/// Applies a tool to the selected keys, with the number that its slider would have.
pub(in crate::panels) fn apply(workspace: &mut Workspace, tool: InBetweenTool, value: f64) -> Option<Effect> {
    let panels = workspace.read();
    // Each step of the history gets other noise.
    let steps = panels.view.map_or(0, |view| view.history.done);
    let chosen = ChosenKeys::of(&panels, steps as u32, next_take(&panels))?;
    let made = tool.edit(value, &chosen);
    if made.is_none() {
        let what =
            if tool == InBetweenTool::Pose { "No pose was copied" } else { "The model has no other take" };
        workspace.say(MessageSeverity::Info, what);
    }
    made.map(edit)
}

/// Replaces the selected keys by keys on every frame, or every few frames.
pub(in crate::panels) fn resample(workspace: &mut Workspace, every: u32) -> Option<Effect> {
    let panels = workspace.read();
    let keys = panels.keys.selection().key_sets(panels.take()?);
    let (take, rate) = (panels.take_ref()?, panels.frame_rate as f32);
    Some(edit(Edit::ResampleKeys(ResampleKeys { take, keys, rate, every })))
}

/// Lets the selected rotation keys turn the short way, and forgets the angles that were typed for keys.
pub(in crate::panels) fn unroll(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let keys = panels.keys.selection().key_sets(panels.take()?);
    let take = panels.take_ref()?;
    workspace.given.forget();
    Some(edit(Edit::TurnKeys(TurnKeys { take, keys, way: TurnWay::Shortest })))
}

/// Repeats the selected keys until the end of the take.
pub(in crate::panels) fn repeat(workspace: &mut Workspace, mode: RepeatMode) -> Option<Effect> {
    let panels = workspace.read();
    let keys = panels.keys.selection().key_sets(panels.take()?);
    let (take, before, after) = (panels.take_ref()?, RepeatCount::default(), RepeatCount::Take);
    Some(edit(Edit::RepeatKeys(RepeatKeys { take, keys, mode, before, after })))
}
