//! Begins and ends that move along with others.

use super::graph::{TimeGraph, TimeNode};
use crate::stage::script::StageScript;

/// The begins and ends that may move along with others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TimesAlong {
    /// Whether each of them may, by their positions in the graph.
    slots: Vec<bool>,
}

impl TimesAlong {
    /// Finds what depends on the given begins and ends of actions, with these; but not what `stays` and what depends only on that.
    pub(in crate::stage) fn after(script: &StageScript, given: &[TimeNode], stays: &[TimeNode]) -> Self {
        let graph = TimeGraph::new(script);
        let mut moved = Self::spread(&graph, given, stays);
        given.iter().for_each(|node| moved.slots[graph.slot(*node)] = true);
        moved
    }

    /// Finds what depends on the given begins and ends of actions: of these, only those that depend on another one.
    pub(in crate::stage) fn by_others(script: &StageScript, given: &[TimeNode]) -> Self {
        Self::spread(&TimeGraph::new(script), given, &[])
    }

    /// Returns the given begins and ends of actions, without what depends on them.
    pub(in crate::stage) fn only(script: &StageScript, given: &[TimeNode]) -> Self {
        let graph = TimeGraph::new(script);
        let mut slots = vec![false; graph.slots()];
        given.iter().for_each(|node| slots[graph.slot(*node)] = true);
        Self { slots }
    }

    fn spread(graph: &TimeGraph<'_>, given: &[TimeNode], stays: &[TimeNode]) -> Self {
        let actions = (graph.slots() - 1) / 2;
        let ends = |action| [TimeNode::Begin(action), TimeNode::End(action)];
        let all = (0..actions).flat_map(ends).chain([TimeNode::Shots]);
        // Pairs of a node and one that needs it, sorted by the first.
        let mut needed: Vec<(usize, TimeNode)> = Vec::new();
        for node in all {
            let needs = (0..).map_while(|at| graph.needs(node, at));
            needed.extend(needs.map(|other| (graph.slot(other), node)));
        }
        needed.sort_by_key(|(slot, _)| *slot);
        let [mut stay, mut is_given, mut slots] = [(); 3].map(|()| vec![false; graph.slots()]);
        stays.iter().for_each(|node| stay[graph.slot(*node)] = true);
        given.iter().for_each(|node| is_given[graph.slot(*node)] = true);
        let mut open: Vec<TimeNode> = given.to_vec();
        while let Some(node) = open.pop() {
            let slot = graph.slot(node);
            let from = needed.partition_point(|(other, _)| *other < slot);
            for &(_, next) in needed[from..].iter().take_while(|(other, _)| *other == slot) {
                let slot = graph.slot(next);
                if slots[slot] || stay[slot] {
                    continue;
                }
                slots[slot] = true;
                if !is_given[slot] {
                    open.push(next);
                }
            }
        }
        Self { slots }
    }

    /// Returns whether an action may begin at another time.
    pub fn begin(&self, action: usize) -> bool {
        self.slots.get(2 * action).copied().unwrap_or(false)
    }

    /// Returns whether an action may end at another time.
    pub fn end(&self, action: usize) -> bool {
        self.slots.get(2 * action + 1).copied().unwrap_or(false)
    }
}
