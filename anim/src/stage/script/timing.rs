//! Times that the elements of actions have, and the actions before and after them.

use super::{ElementOrigin, ScriptElement, StageScript};
use crate::stage::time::{Decimal, StageRate, StageTime, parse_time};

impl StageScript {
    /// Returns the time that an attribute of an element has, written or by default.
    pub(in crate::stage) fn time(&self, element: &ScriptElement, name: &str) -> Option<StageTime> {
        parse_time(element.value(name)?, self.rate_of(element))
    }

    /// Returns the frame rate of the file that an element is in.
    pub(in crate::stage) fn rate_of(&self, element: &ScriptElement) -> StageRate {
        match element.origin {
            ElementOrigin::Text | ElementOrigin::Project => self.rate,
            ElementOrigin::Included(part) => self.tree.parts.get(part).map_or(self.rate, |part| part.rate),
        }
    }

    /// Returns whether an action is released at its end, with a fade of this duration there: by its `fill`, else if it fades out or `releases`. One that is not
    /// is held in its last state.
    pub(in crate::stage) fn is_released(
        &self,
        element: &ScriptElement,
        fade_out: StageTime,
        releases: bool,
    ) -> bool {
        match element.value("fill") {
            Some(fill) => fill != "hold",
            None => releases || fade_out > StageTime::ZERO,
        }
    }

    /// Returns the factor of the speed of an action; 1 where it has none.
    pub(in crate::stage) fn speed(&self, action: usize) -> Decimal {
        self.element(action).value("speed").and_then(Decimal::parse).unwrap_or(Decimal::ONE)
    }

    /// Returns the names and times of the `at` of an action, times of its take.
    pub(in crate::stage) fn points(&self, action: usize) -> Vec<(&str, StageTime)> {
        let own = self.actions[action].element;
        // The parts of an element follow it directly.
        let parts = self.tree.elements[own + 1..].iter().take_while(|part| part.parent == Some(own));
        parts.filter_map(|part| Some((part.value("name")?, self.time(part, "time")?))).collect()
    }

    /// Returns the time from the start of a play to a time in its take, where one repetition takes `once`: in the second repetition if the first one begins
    /// after that.
    pub(in crate::stage) fn after_start(&self, play: usize, time: StageTime, once: StageTime) -> StageTime {
        let (after, skipped) = (self.in_repetition(play, time, once), self.skipped(play, once));
        let is_left_out = (StageTime::ZERO..skipped).contains(&after);
        if is_left_out { after + once - skipped } else { after - skipped }
    }

    /// Returns how much of the first repetition of a play is left out at its start, by the attribute `start`. One repetition takes `once`.
    pub(in crate::stage) fn skipped(&self, play: usize, once: StageTime) -> StageTime {
        let element = self.element(play);
        let start = element.attribute("start").and_then(|_| self.time(element, "start"));
        start.map_or(StageTime::ZERO, |start| {
            self.in_repetition(play, start, once).max(StageTime::ZERO).min(once)
        })
    }

    /// Returns the time from the start of a repetition of a play to a time in its take, if one repetition takes `once`.
    fn in_repetition(&self, play: usize, time: StageTime, once: StageTime) -> StageTime {
        let (from, speed) = (self.time(self.element(play), "from").unwrap_or_default(), self.speed(play));
        let after = (time - from).over(speed);
        if speed.is_negative() { once - after } else { after }
    }

    /// Returns whether an action is a `seq`.
    pub(in crate::stage) fn is_seq(&self, action: usize) -> bool {
        self.element(action).row.name == "seq"
    }

    /// Returns the action after one in its container.
    pub(in crate::stage) fn next_sibling(&self, action: usize) -> Option<usize> {
        let own = self.actions.get(action)?;
        self.actions[own.parent?].children.get(own.position + 1).copied()
    }

    /// Returns the action after one in a `seq`; `None` in a `par`.
    pub(in crate::stage) fn next_in_seq(&self, action: usize) -> Option<usize> {
        self.next_sibling(action).filter(|_| self.is_in_seq(action))
    }

    /// Returns the action before one in a `seq`, at whose end it begins as usual; `None` in a `par`.
    pub(in crate::stage) fn before_in_seq(&self, action: usize) -> Option<usize> {
        let own = self.actions.get(action).filter(|_| self.is_in_seq(action))?;
        self.actions[own.parent?].children.get(own.position.checked_sub(1)?).copied()
    }

    /// Returns whether an action is in a `seq`.
    pub fn is_in_seq(&self, action: usize) -> bool {
        self.actions.get(action).and_then(|own| own.parent).is_some_and(|parent| self.is_seq(parent))
    }

    /// Returns whether `begin` or `end` of an action refers to the one before it as `prev`.
    pub(in crate::stage) fn refers_to_prev(&self, action: usize) -> bool {
        ["begin", "end"].iter().any(|name| self.names_prev(action, name))
    }

    /// Returns whether the moment called `name`, `begin` or `end`, of an action refers to the one before it as `prev`.
    pub(in crate::stage) fn names_prev(&self, action: usize, name: &str) -> bool {
        self.element(action).value(name).is_some_and(|moment| moment.starts_with("prev."))
    }
}
