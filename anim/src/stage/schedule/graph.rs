//! The nodes of the graph, and which others each of them needs.

use crate::stage::script::{ActionMoment, StageScript};

/// A time to compute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::stage) enum TimeNode {
    /// The begin of an action.
    Begin(usize),
    /// The end of an action.
    End(usize),
    /// The begins of all shots, in order.
    Shots,
}

/// The rules for the times of the actions of a script.
pub(super) struct TimeGraph<'a> {
    script: &'a StageScript,
    /// The actions that are shots.
    pub(super) shots: Vec<usize>,
}

impl<'a> TimeGraph<'a> {
    pub(super) fn new(script: &'a StageScript) -> Self {
        let all = 0..script.actions().len();
        Self { script, shots: all.filter(|&action| script.element(action).row.name == "shot").collect() }
    }

    /// Returns the position of a node in a list of all.
    pub(super) fn slot(&self, node: TimeNode) -> usize {
        match node {
            TimeNode::Begin(action) => 2 * action,
            TimeNode::End(action) => 2 * action + 1,
            TimeNode::Shots => 2 * self.script.actions().len(),
        }
    }

    /// Returns the number of nodes.
    pub(super) fn slots(&self) -> usize {
        2 * self.script.actions().len() + 1
    }

    /// Returns the `at`-th node that `node` needs; `None` after the last one.
    pub(super) fn needs(&self, node: TimeNode, at: usize) -> Option<TimeNode> {
        match node {
            TimeNode::Begin(action) => (at == 0).then(|| self.before(action)).flatten(),
            TimeNode::End(action) if at == 0 => Some(TimeNode::Begin(action)),
            TimeNode::End(action) => self.before_end(action, at - 1),
            TimeNode::Shots => self.shots.get(at).map(|&shot| TimeNode::Begin(shot)),
        }
    }

    /// Returns what the start of an action depends on; `None` for the script.
    fn before(&self, action: usize) -> Option<TimeNode> {
        match self.script.actions()[action].begin {
            Some(moment) => self.moment(action, moment),
            None => self.base(action),
        }
    }

    /// Returns the usual begin of an action (rule 1).
    pub(super) fn base(&self, action: usize) -> Option<TimeNode> {
        let parent = self.script.actions()[action].parent?;
        Some(self.script.before_in_seq(action).map_or(TimeNode::Begin(parent), TimeNode::End))
    }

    /// Returns the node of a moment.
    pub(super) fn moment(&self, action: usize, moment: ActionMoment) -> Option<TimeNode> {
        match moment {
            ActionMoment::Offset(_) => self.base(action),
            ActionMoment::Begin(other, _) | ActionMoment::Point(other, ..) => Some(TimeNode::Begin(other)),
            ActionMoment::End(other, _) => Some(TimeNode::End(other)),
        }
    }

    /// Returns what the end of an action depends on, apart from its start (rules 2 to 4).
    fn before_end(&self, index: usize, at: usize) -> Option<TimeNode> {
        let action = &self.script.actions()[index];
        match (action.end, action.dur) {
            (Some(end), _) => (at == 0).then(|| self.moment(index, end)).flatten(),
            (None, Some(_)) => None,
            (None, None) if action.passive && self.is(index, "shot") => {
                [TimeNode::Shots, self.limit(index)].get(at).copied()
            }
            (None, None) if action.passive => (at == 0).then(|| self.passive_end(index)),
            (None, None) => {
                let child = *action.children.get(at)?;
                Some(if self.script.actions()[child].passive {
                    TimeNode::Begin(child)
                } else {
                    TimeNode::End(child)
                })
            }
        }
    }

    /// Returns the end of a passive action that is no shot: the start of the next one in a `seq` if that has one of its own, otherwise
    /// the end of the nearest `par`.
    pub(super) fn passive_end(&self, index: usize) -> TimeNode {
        self.script
            .next_in_seq(index)
            .filter(|&next| self.script.actions()[next].begin.is_some())
            .map_or_else(|| self.limit(index), TimeNode::Begin)
    }

    /// Returns the end of the nearest `par` around an action.
    pub(super) fn limit(&self, index: usize) -> TimeNode {
        let mut above = self.script.actions()[index].parent.unwrap_or(0);
        while self.script.is_seq(above) {
            above = self.script.actions()[above].parent.unwrap_or(0);
        }
        TimeNode::End(above)
    }

    fn is(&self, action: usize, name: &str) -> bool {
        self.script.element(action).row.name == name
    }
}
