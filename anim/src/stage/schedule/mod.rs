//! When each action begins and ends.
//!
//! Every begin and every end is a node of a graph; the rules in [`crate::stage`] say which nodes another one needs. The nodes are computed
//! depth first with a stack of our own, so that neither depth nor size can overflow that of the thread, in time in proportion to the script.

mod graph;
mod moved;
mod resolve;

pub(in crate::stage) use graph::TimeNode;
pub use moved::TimesAlong;
pub use resolve::resolve;

use crate::stage::script::ScriptError;
use crate::stage::time::StageTime;

/// The times of one action.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ActionTimes {
    /// Its begin.
    pub begin: StageTime,
    /// Its end by the rules, never before its start: what references to it mean.
    pub end: StageTime,
    /// When it stops: its end, or the earlier end of a container around it that has an end or a duration of its own.
    pub stop: StageTime,
    /// Duration of one of its repetitions; zero where it has none.
    pub once: StageTime,
}

/// The times of all actions of a script.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Schedule {
    pub(super) times: Vec<ActionTimes>,
    pub(super) notes: Vec<ScriptError>,
}

impl Schedule {
    /// Returns the times of each action, in the order of [`crate::stage::script::StageScript::actions`].
    pub fn times(&self) -> &[ActionTimes] {
        &self.times
    }

    /// Returns the length of the script: the end of its last action that is not passive.
    pub fn length(&self) -> StageTime {
        self.times.first().map_or(StageTime::ZERO, |script| script.end)
    }

    /// Returns what is probably not meant: actions whose end would be before their begin.
    pub fn notes(&self) -> &[ScriptError] {
        &self.notes
    }
}
