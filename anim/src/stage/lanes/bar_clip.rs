//! The part of a take that a bar plays, and when moments of the take are in the scene.

use super::bar::SceneBar;
use crate::stage::StagePlan;
use crate::stage::script::StageScript;
use crate::stage::time::{Decimal, StageTime};

/// The part of a take that a bar plays, and how fast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BarClip {
    /// Start and end of the part, after the start of the take.
    pub part: [StageTime; 2],
    /// Factor of the speed; below 0 backwards.
    pub speed: Decimal,
    /// The duration that is left out at the start of the first repetition.
    pub skipped: StageTime,
}

impl BarClip {
    /// Returns the part that an action plays; `None` for other actions, and while the model is missing.
    pub(super) fn of(script: &StageScript, plan: &StagePlan, action: usize) -> Option<Self> {
        let element = script.element(action);
        if element.row.name != "play" {
            return None;
        }
        let model = plan.things().get(plan.thing_called(element.value("who")?)?)?.model.as_ref()?;
        let length = model.takes().get(model.take_called(element.value("take")?)?)?.length();
        let time = |name: &str| script.time(element, name).map(|time| time.min(length));
        let from = time("from").unwrap_or_default();
        let (to, speed) = (time("to").unwrap_or(length).max(from), script.speed(action));
        let skipped = script.skipped(action, (to - from).over(speed));
        Some(Self { part: [from, to], speed, skipped })
    }
}

impl SceneBar {
    /// Returns the times in the scene of the moment that is `at` after the start of the take, once for each repetition, at most `most` of them;
    /// none where the bar does not play that moment.
    pub fn occurrences(&self, at: StageTime, most: usize) -> impl Iterator<Item = StageTime> + use<> {
        let begin = self.begin;
        self.moments(at).skip_while(move |&time| time < begin).take(most)
    }

    /// Returns the times of a moment of the take in all repetitions, also of one in the part that is left out.
    fn moments(&self, at: StageTime) -> impl Iterator<Item = StageTime> + use<> {
        let (begin, end, once) = (self.begin, self.end, self.once);
        let clip = self.clip.filter(|clip| (clip.part[0]..=clip.part[1]).contains(&at));
        let first = clip.map(|clip| {
            let after = (at - clip.part[0]).over(clip.speed);
            // Backwards the end of the part comes first.
            begin + (if clip.speed.is_negative() { once - after } else { after }) - clip.skipped
        });
        let next = move |&time: &StageTime| (once > StageTime::ZERO).then(|| time + once);
        std::iter::successors(first, next).take_while(move |&time| time <= end)
    }

    /// Returns the parts of the scene in which a part of the take is played that is `from` to `to` after its start, at most `most` of them.
    pub fn occurrences_of_part(
        &self,
        [from, to]: [StageTime; 2],
        most: usize,
    ) -> impl Iterator<Item = [StageTime; 2]> + use<> {
        let (begin, end, clip) = (self.begin, self.end, self.clip);
        let inside =
            clip.map(|clip| [from.max(clip.part[0]), to.min(clip.part[1])]).filter(|[from, to]| from < to);
        let is_backwards = clip.is_some_and(|clip| clip.speed.is_negative());
        let length = clip.zip(inside).map(|(clip, [from, to])| (to - from).over(clip.speed));
        let first = inside.map(|[from, to]| if is_backwards { to } else { from });
        let starts = first.map(|first| self.moments(first)).into_iter().flatten();
        let length = length.unwrap_or_default();
        let parts = starts.map(move |start| [start.max(begin), (start + length).min(end)]);
        parts.filter(|[from, to]| from < to).take(most)
    }
}
