//! The times of all actions, from the lengths that actions have by themselves.

use super::graph::{TimeGraph, TimeNode};
use super::{ActionTimes, Schedule};
use crate::stage::script::{ActionMoment, ErrorList, ScriptError, StageRepeat, StageScript};
use crate::stage::time::{Decimal, StageTime};

/// Computes when each action begins and ends.
///
/// `lengths` has for each action of the script the duration of one repetition that follows from its take or path; zero for all others.
///
/// # Errors
///
/// Actions whose times depend on themselves: one error that names every one of them with its line.
pub fn resolve(script: &StageScript, lengths: &[StageTime]) -> Result<Schedule, Vec<ScriptError>> {
    script.with_errors(|errors| {
        let mut resolver = Resolver::new(script, lengths);
        if let Some(cycle) = resolver.run() {
            report_cycle(script, &cycle, errors);
            return Schedule::default();
        }
        resolver.schedule()
    })
}

struct Resolver<'a> {
    script: &'a StageScript,
    lengths: &'a [StageTime],
    graph: TimeGraph<'a>,
    times: Vec<Option<StageTime>>,
    /// The begins of the shots, each with the shot, ascending.
    shots: Vec<(StageTime, usize)>,
}

impl<'a> Resolver<'a> {
    fn new(script: &'a StageScript, lengths: &'a [StageTime]) -> Self {
        let graph = TimeGraph::new(script);
        Self { script, lengths, times: vec![None; graph.slots()], graph, shots: Vec::new() }
    }

    /// Computes every node. Returns the nodes of a cycle if there is one.
    fn run(&mut self) -> Option<Vec<TimeNode>> {
        let mut is_open = vec![false; self.graph.slots()];
        let mut open: Vec<(TimeNode, usize)> = Vec::new();
        let all = (0..self.script.actions().len())
            .flat_map(|action| [TimeNode::Begin(action), TimeNode::End(action)]);
        for start in all {
            if self.times[self.graph.slot(start)].is_some() {
                continue;
            }
            open.push((start, 0));
            is_open[self.graph.slot(start)] = true;
            while let Some((node, at)) = open.last_mut() {
                let (node, next) = (*node, self.graph.needs(*node, *at));
                *at += 1;
                match next {
                    Some(needed) if self.times[self.graph.slot(needed)].is_some() => {}
                    Some(needed) if is_open[self.graph.slot(needed)] => {
                        let first = open.iter().position(|(node, _)| *node == needed).unwrap_or(0);
                        return Some(open[first..].iter().map(|(node, _)| *node).collect());
                    }
                    Some(needed) => {
                        is_open[self.graph.slot(needed)] = true;
                        open.push((needed, 0));
                    }
                    None => {
                        let time = self.compute(node);
                        self.times[self.graph.slot(node)] = Some(time);
                        open.pop();
                    }
                }
            }
        }
        None
    }

    /// Returns the time of a node whose needs are computed.
    fn at(&self, node: TimeNode) -> StageTime {
        self.times[self.graph.slot(node)].unwrap_or_default()
    }

    fn compute(&mut self, node: TimeNode) -> StageTime {
        match node {
            TimeNode::Begin(index) => match self.script.actions()[index].begin {
                Some(moment) => self.moment(index, moment),
                None => self.base(index),
            },
            TimeNode::End(index) => self.unlimited_end(index).max(self.at(TimeNode::Begin(index))),
            TimeNode::Shots => {
                self.shots =
                    self.graph.shots.iter().map(|&shot| (self.at(TimeNode::Begin(shot)), shot)).collect();
                self.shots.sort_unstable();
                StageTime::ZERO
            }
        }
    }

    fn base(&self, index: usize) -> StageTime {
        self.graph.base(index).map_or(StageTime::ZERO, |base| self.at(base))
    }

    fn moment(&self, index: usize, moment: ActionMoment) -> StageTime {
        match moment {
            ActionMoment::Offset(time) => self.base(index) + time,
            ActionMoment::Begin(other, offset) => self.at(TimeNode::Begin(other)) + offset,
            ActionMoment::End(other, offset) => self.at(TimeNode::End(other)) + offset,
            ActionMoment::Point(other, time, offset) => {
                self.at(TimeNode::Begin(other))
                    + self.script.after_start(other, time, self.once(other))
                    + offset
            }
        }
    }

    fn once(&self, index: usize) -> StageTime {
        self.lengths.get(index).copied().unwrap_or_default()
    }

    /// Returns the end of an action by rules 2 to 4.
    fn unlimited_end(&self, index: usize) -> StageTime {
        let action = &self.script.actions()[index];
        let begin = self.at(TimeNode::Begin(index));
        if let Some(end) = action.end {
            return self.moment(index, end);
        }
        if let Some(dur) = action.dur {
            return begin + dur;
        }
        if action.passive {
            let next = self.next_shot(index, begin);
            return next.unwrap_or_else(|| self.at(self.passive_node(index)));
        }
        if !action.children.is_empty() {
            let tails = action.children.iter().map(|&child| {
                let passive = self.script.actions()[child].passive;
                self.at(if passive { TimeNode::Begin(child) } else { TimeNode::End(child) })
            });
            return tails.fold(begin, StageTime::max);
        }
        let times = match action.repeat {
            StageRepeat::Times(times) => times,
            StageRepeat::Fill => Decimal::ONE,
        };
        let once = self.once(index);
        begin + once.times(times) - self.script.skipped(index, once)
    }

    fn passive_node(&self, index: usize) -> TimeNode {
        if self.graph.shots.binary_search(&index).is_ok() {
            self.graph.limit(index)
        } else {
            self.graph.passive_end(index)
        }
    }

    /// Returns the start of the shot after a shot; `None` for the last one and for other actions.
    fn next_shot(&self, index: usize, begin: StageTime) -> Option<StageTime> {
        self.graph.shots.binary_search(&index).ok()?;
        let after = self.shots.partition_point(|&shot| shot <= (begin, index));
        self.shots.get(after).map(|&(time, _)| time)
    }

    fn schedule(&self) -> Schedule {
        let mut schedule =
            Schedule { times: Vec::with_capacity(self.script.actions().len()), notes: Vec::new() };
        // For each action the earliest end that it or a container around it has of its own.
        let mut limits: Vec<Option<StageTime>> = Vec::with_capacity(self.script.actions().len());
        let note = |index: usize, end: StageTime| {
            let element = self.script.element(index);
            let range = element.value_range("end");
            let message = format!(
                "this end is {:.3} s before the begin, so <{}> takes no time",
                (self.at(TimeNode::Begin(index)) - end).seconds(),
                element.row.name
            );
            self.script.tree().error(range, message, "")
        };
        for (index, action) in self.script.actions().iter().enumerate() {
            let (begin, end) = (self.at(TimeNode::Begin(index)), self.at(TimeNode::End(index)));
            let unlimited = self.unlimited_end(index);
            if unlimited < begin && action.end.is_some() {
                schedule.notes.push(note(index, unlimited));
            }
            // A parent comes before its children.
            let limit = action.parent.and_then(|parent| limits.get(parent).copied().flatten());
            let own = (action.end.is_some() || action.dur.is_some()).then_some(end);
            limits.push(own.into_iter().chain(limit).min());
            let stop = limit.map_or(end, |limit| end.min(limit)).max(begin);
            schedule.times.push(ActionTimes { begin, end, stop, once: self.once(index) });
        }
        schedule
    }
}

/// Reports the nodes of a cycle, each with its action and line, and what usually helps.
fn report_cycle(script: &StageScript, cycle: &[TimeNode], errors: &mut ErrorList) {
    let title = |node: &TimeNode| match *node {
        TimeNode::Begin(action) => {
            format!("begin of {}", script.tree().title(script.actions()[action].element))
        }
        TimeNode::End(action) => format!("end of {}", script.tree().title(script.actions()[action].element)),
        TimeNode::Shots => "begins of all shots".to_owned(),
    };
    let mut chain: Vec<String> = cycle.iter().map(title).collect();
    chain.extend(cycle.first().map(title));
    // The usual cause: an action without a length of its own, and one after it that begins when it ends.
    let waiting = cycle.iter().find_map(|node| match *node {
        TimeNode::End(action) if script.actions()[action].passive => {
            script.next_in_seq(action).filter(|next| cycle.contains(&TimeNode::Begin(*next)))
        }
        TimeNode::Begin(_) | TimeNode::End(_) | TimeNode::Shots => None,
    });
    let action = cycle.iter().find_map(|node| match *node {
        TimeNode::Begin(action) | TimeNode::End(action) if action > 0 => Some(action),
        TimeNode::Begin(_) | TimeNode::End(_) | TimeNode::Shots => None,
    });
    let (at, help) = match waiting {
        Some(next) => {
            (next, "the action before it has no length of its own: give it a `dur`, or this one a `begin`")
        }
        None => (action.unwrap_or(0), "change one of these begins or ends"),
    };
    let message = format!("this time depends on itself: {}", chain.join(" needs the "));
    errors.add(script.element(at).name.clone(), message, help);
}
