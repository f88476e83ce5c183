//! A bar of the timeline: an action with its times and its name.

use super::bar_clip::BarClip;
use super::overlap::{ClipTakeover, Takeover, is_main};
use crate::stage::StagePlan;
use crate::stage::script::{ScriptElement, StageRepeat, StageScript};
use crate::stage::time::{Decimal, StageTime};

/// A moment of a take that the script names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BarMark {
    /// Its name.
    pub name: Box<str>,
    /// Its time in the scene.
    pub time: StageTime,
}

/// An action on the timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneBar {
    /// The action: a position in [`StageScript::actions`].
    pub action: usize,
    /// Name of its element.
    pub kind: &'static str,
    /// Text on the bar: the name of its take, its target, or its action.
    pub label: Box<str>,
    /// Its begin.
    pub begin: StageTime,
    /// When it stops; at its begin for one without a length.
    pub end: StageTime,
    /// Duration of one repetition; zero where it has none.
    pub once: StageTime,
    /// How often it runs.
    pub repeat: StageRepeat,
    /// Duration of its fade at the start; of a shot, of its blend.
    pub fade_in: StageTime,
    /// Duration of its fade at the end.
    pub fade_out: StageTime,
    /// Whether it decides over the whole body: the main row of a lane.
    pub is_main: bool,
    /// How it takes over from the one before it.
    pub takeover: Takeover,
    /// The time from which it is mixed with the one before it again, which is still on after it; its end if it is cut off. `None` if it does not give the
    /// pose back.
    pub hand_back: Option<StageTime>,
    /// Whether it has no length of its own.
    pub is_passive: bool,
    /// The included file that has the action, relative to the folder of the document: it cannot be changed here. `None`: the script itself.
    pub file: Option<Box<str>>,
    /// The part of a take that it plays; `None` for other actions, and while the model is missing.
    pub clip: Option<BarClip>,
    /// Moments of its take.
    pub marks: Vec<BarMark>,
    /// Its row in the lane.
    pub row: usize,
}

impl SceneBar {
    /// Creates the bar of an action; `sound_stop` is when its sound stops, for a sound.
    pub(super) fn new(
        script: &StageScript,
        plan: &StagePlan,
        action: usize,
        takeover: Option<ClipTakeover>,
        sound_stop: Option<StageTime>,
    ) -> Self {
        let (own, element) = (&script.actions()[action], script.element(action));
        let times = plan.schedule().times()[action];
        let time = |name: &str| script.time(element, name).unwrap_or_default();
        let kind = element.row.name;
        Self {
            action,
            kind,
            label: label(element).into(),
            begin: times.begin,
            // The length of a sound is that of its file.
            end: sound_stop.unwrap_or(times.stop),
            once: times.once,
            repeat: own.repeat,
            fade_in: time(if kind == "shot" { "blend" } else { "fade-in" }),
            fade_out: time("fade-out"),
            is_main: is_main(element),
            takeover: takeover.map_or(Takeover::After, |own| own.takeover),
            hand_back: takeover.and_then(|own| own.hand_back),
            is_passive: own.passive,
            file: script.tree().file_of(element).map(Into::into),
            clip: BarClip::of(script, plan, action),
            marks: marks(script, action, times.begin, times.once),
            row: 0,
        }
    }

    /// Returns whether the action takes no time.
    pub fn is_instant(&self) -> bool {
        self.end <= self.begin
    }

    /// Returns the times at which further repetitions begin, at most `most` of them.
    pub fn repetitions(&self, most: usize) -> impl Iterator<Item = StageTime> + use<'_> {
        let whole = self.once > StageTime::ZERO && self.repeat != StageRepeat::Times(Decimal::ONE);
        let next = move |&time: &StageTime| Some(time + self.once);
        let skipped = self.clip.map_or(StageTime::ZERO, |clip| clip.skipped);
        let first = whole.then_some(self.begin + self.once - skipped);
        std::iter::successors(first, next).take_while(|&time| time < self.end).take(most)
    }
}

/// Returns what a bar says.
fn label(element: &ScriptElement) -> String {
    let value = |name: &str| element.value(name).unwrap_or_default();
    match element.row.name {
        "play" => value("take").to_owned(),
        "move" => {
            let way = element
                .value("path")
                .map_or_else(|| format!("to {}", value("to")), |path| format!("along {path}"));
            match element.value("take") {
                Some(take) => format!("{take} {way}"),
                None => format!("Move {way}"),
            }
        }
        "turn" => format!("Turn to {}", value("to")),
        "place" => match element.value("at") {
            Some(at) => format!("Place at {at}"),
            None => format!("Face {}", value("facing")),
        },
        "look" => format!("Look at {}", value("at")),
        "attach" => format!("Attach to {}", value("to")),
        "detach" => "Detach".to_owned(),
        "shot" => value("who").to_owned(),
        "run" => "On".to_owned(),
        "set" | "change" => format!("{} {}", value("property"), value("to")),
        "sound" | "include" => value("src").rsplit('/').next().unwrap_or_default().to_owned(),
        "title" => value("text").to_owned(),
        other => other.to_owned(),
    }
}

/// Returns the moments of the take that an action plays, at their times in the scene.
fn marks(script: &StageScript, action: usize, begin: StageTime, once: StageTime) -> Vec<BarMark> {
    let at = |time: StageTime| begin + script.after_start(action, time, once);
    let points = script.points(action).into_iter();
    points.map(|(name, time)| BarMark { name: name.into(), time: at(time) }).collect()
}
