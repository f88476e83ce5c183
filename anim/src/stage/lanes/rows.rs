//! The row of each bar in its lane.

use super::{SceneBar, SceneLane};
use crate::stage::time::StageTime;

/// Sorts the bars of a lane by their begins and gives each a row: what moves the whole body the first one, everything else the first of the
/// others that is free. Bars without a length need a row only at their time.
pub(super) fn assign(lane: &mut SceneLane) {
    lane.bars.sort_by_key(|bar| (bar.begin, bar.action));
    let has_main = lane.bars.iter().any(|bar| bar.is_main);
    // For each row the end of its last bar, and whether that bar has no length.
    let mut rows: Vec<Option<StageTime>> = Vec::new();
    for bar in &mut lane.bars {
        if bar.is_main {
            bar.row = 0;
            continue;
        }
        let free =
            rows.iter().position(|end| end.is_none_or(|end| end <= bar.begin && !is_instant_at(end, bar)));
        let row = free.unwrap_or(rows.len());
        if row == rows.len() {
            rows.push(None);
        }
        rows[row] = Some(bar.end);
        bar.row = row + usize::from(has_main);
    }
    lane.rows = (rows.len() + usize::from(has_main)).max(1);
}

/// Returns whether a bar without a length would hide the one before it.
fn is_instant_at(end: StageTime, bar: &SceneBar) -> bool {
    bar.is_instant() && end == bar.begin
}
