//! The lanes of a scene's timeline: which bars there are, when, and in which row.
//!
//! ```text
//! Shots    │ wide        │ close  │ wide        │
//! anna     │ Walk            ╳ PickUp │ Slash  │      row 0: what moves the whole body; a cross is a mix
//!          │                      │ look at ben │      row 1 and below: everything else, in the first row that is free
//! Sounds   │        │ thunder.ogg │
//! Scripts  │ intro.xml   │                             included; its actions are on the lanes above, and cannot be changed there
//! ```

mod bar;
mod bar_clip;
mod overlap;
mod rows;

pub use bar::{BarMark, SceneBar};
pub use bar_clip::BarClip;
pub use overlap::Takeover;
pub(in crate::stage) use overlap::{ClipMix, is_same, visit_clips};

use super::StagePlan;
use super::script::StageScript;
use super::table::ElementGroup;
use super::time::StageTime;
use std::collections::HashMap;

/// What a lane is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneSubject {
    /// The cameras that are seen: its bars are the shots.
    Shots,
    /// A thing of the cast, by its position in [`StageScript::things`].
    Thing(usize),
    /// Sounds.
    Sounds,
    /// Titles.
    Titles,
    /// Other scripts: its bars are the includes.
    Includes,
}

/// A lane of the timeline.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneLane {
    /// What it is for.
    pub subject: LaneSubject,
    /// Name of the thing, or of what it contains.
    pub name: Box<str>,
    /// Name of the element of the thing; empty for other lanes.
    pub kind: &'static str,
    /// Its bars, in the order of their begins.
    pub bars: Vec<SceneBar>,
    /// Number of its rows; at least 1.
    pub rows: usize,
}

/// The lanes of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneLanes {
    /// Shots first, then the things of the cast in its order, then sounds, titles and included scripts.
    pub list: Vec<SceneLane>,
    /// When the last bar ends that has a length of its own; the length of the script at least.
    pub end: StageTime,
}

impl SceneLanes {
    /// Computes the lanes of a script.
    ///
    /// Roles, props, lights and effects have a lane even without actions; cameras only where they do more than being seen; paths and
    /// marks none. Containers and waits have no bars.
    pub fn new(script: &StageScript, plan: &StagePlan) -> Self {
        let mut shots = lane(LaneSubject::Shots, "Shots", "");
        let mut things: Vec<SceneLane> = script
            .things()
            .enumerate()
            .map(|(at, thing)| {
                lane(LaneSubject::Thing(at), thing.value("id").unwrap_or_default(), thing.row.name)
            })
            .collect();
        let (mut sounds, mut titles) =
            (lane(LaneSubject::Sounds, "Sounds", ""), lane(LaneSubject::Titles, "Titles", ""));
        let mut includes = lane(LaneSubject::Includes, "Scripts", "");
        let mut end = plan.length();
        let stops: HashMap<usize, StageTime> =
            plan.sounds().iter().map(|sound| (sound.action(), sound.stop())).collect();
        let takeovers = overlap::takeovers(script, plan.schedule().times());
        for action in 1..script.actions().len().min(plan.schedule().times().len()) {
            let element = script.element(action);
            if element.row.group != ElementGroup::Action || element.row.name == "wait" {
                continue;
            }
            let takeover = takeovers.get(&action).copied();
            let bar = SceneBar::new(script, plan, action, takeover, stops.get(&action).copied());
            if !script.actions()[action].passive {
                end = end.max(bar.end);
            }
            let lane = match element.row.name {
                "shot" => Some(&mut shots),
                "sound" => Some(&mut sounds),
                "title" => Some(&mut titles),
                "include" => Some(&mut includes),
                _ => element
                    .value("who")
                    .and_then(|who| script.thing_called(who))
                    .and_then(|thing| things.get_mut(thing)),
            };
            if let Some(lane) = lane {
                lane.bars.push(bar);
            }
        }
        let has_camera = things.iter().any(|lane| lane.kind == "camera");
        let is_shown = |lane: &SceneLane| match lane.kind {
            "camera" | "path" | "mark" => !lane.bars.is_empty(),
            _ => true,
        };
        let mut list = Vec::with_capacity(things.len() + 4);
        list.extend(Some(shots).filter(|shots| has_camera || !shots.bars.is_empty()));
        list.extend(things.into_iter().filter(is_shown));
        list.extend([sounds, titles, includes].into_iter().filter(|lane| !lane.bars.is_empty()));
        list.iter_mut().for_each(rows::assign);
        Self { list, end }
    }

    /// Returns the lane and the bar of an action.
    pub fn bar_of(&self, action: usize) -> Option<(&SceneLane, &SceneBar)> {
        self.list.iter().find_map(|lane| Some((lane, lane.bars.iter().find(|bar| bar.action == action)?)))
    }
}

fn lane(subject: LaneSubject, name: &str, kind: &'static str) -> SceneLane {
    SceneLane { subject, name: name.into(), kind, bars: Vec::new(), rows: 1 }
}
