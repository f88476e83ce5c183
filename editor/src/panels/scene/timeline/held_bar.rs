//! A bar that is dragged: moved with the other selected ones, trimmed, faded, stretched.

use super::lane_layout::{SceneBarPart, SceneHit};
use super::sheet::SceneSheet;
use super::snap::{SnapTargets, frame_at};
use crate::panels::drag::{PointerInput, readout};
use crate::panels::request::Request;
use crate::panels::scene::{ChangedThings, SceneBase, SceneEditing, SceneRequest, ScriptChange, move_label};
use dragonfly_anim::stage::gesture::{
    FadeEnd, Followers, GestureRefusal, MovedPart, MovedToLane, SequenceMove, SequenceOrder, in_this_text,
    move_clips, move_clips_to_lane, moved_along, sequence_move, sequence_place, set_fade, stretch_to,
    trim_end, trim_start,
};
use dragonfly_anim::stage::lanes::{SceneBar, SceneLane, SceneLanes};
use dragonfly_anim::stage::splice::ElementPlace;
use dragonfly_anim::stage::table::element;
use dragonfly_anim::stage::time::{StageRate, StageTime, TICKS_PER_SECOND};
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::history::Gesture;
use egui::Ui;
use glam::Vec2;
use std::sync::Arc;

/// A bar that is dragged.
#[derive(Clone, Debug)]
pub(super) struct HeldBar {
    base: SceneBase,
    pub(super) gesture: Gesture,
    bar: SceneBar,
    pub(super) part: SceneBarPart,
    /// The actions that move along, with that of the bar.
    actions: Vec<usize>,
    /// The things that do them.
    things: Arc<[Box<str>]>,
    /// Time of the pointer when it was pressed.
    grabbed: StageTime,
    /// Name of the thing.
    name: Box<str>,
    /// The lanes as they were when it was pressed.
    lanes: Arc<SceneLanes>,
    /// To what it snaps, by what the actions after it do.
    targets: Option<(Followers, SnapTargets)>,
    /// Whether something was sent.
    pub(super) is_sent: bool,
    /// The place to which the edge was brought last.
    asked: Option<AskedEdge>,
    /// Why it could not be brought there, or not with all actions that move along.
    refused: Option<GestureRefusal>,
    /// The place that it has there among the actions of its sequence, if that is another one than before.
    becomes: Option<(ElementPlace, SequenceMove)>,
}

/// A place to which an edge is brought.
#[derive(Clone, Debug, PartialEq, Eq)]
struct AskedEdge {
    time: StageTime,
    /// Whether Alt is held.
    alt: bool,
    followers: Followers,
    /// The thing to whose lane the bar goes; `None` for its own.
    onto: Option<Box<str>>,
}

/// Begins a drag; `Ok(None)` where there is nothing to drag.
pub(super) fn begin(
    hit: SceneHit,
    grabbed: StageTime,
    sheet: &SceneSheet<'_>,
) -> Result<Option<HeldBar>, GestureRefusal> {
    let SceneHit::Bar { lane, action, part } = hit else { return Ok(None) };
    let Some((lane, bar)) = sheet.lanes.list.get(lane).zip(sheet.lanes.bar_of(action).map(|(_, bar)| bar))
    else {
        return Ok(None);
    };
    // A part of a bar is dragged alone.
    let editing = sheet.context.scene_editing;
    let actions = match part == SceneBarPart::Body && editing.is_action_selected(action) {
        true => editing.actions().to_vec(),
        false => vec![action],
    };
    let base = SceneBase::of(sheet.scene, sheet.context.scene_editing.text(sheet.scene))?;
    let things = ChangedThings::Actions(&actions).ids(&base.script);
    if let Some(reason) = sheet.context.scene_editing.lock_refusal(&things) {
        return Err(GestureRefusal(reason));
    }
    for own in actions.iter().filter_map(|&action| base.script.actions().get(action)) {
        in_this_text(base.script.tree(), own.element)?;
    }
    let gesture = sheet.context.new_gesture();
    Ok(Some(HeldBar {
        base,
        gesture,
        bar: bar.clone(),
        part,
        actions,
        things,
        grabbed,
        name: lane.name.clone(),
        lanes: Arc::clone(sheet.context.scene_editing.lanes()),
        targets: None,
        is_sent: false,
        asked: None,
        refused: None,
        becomes: None,
    }))
}

impl HeldBar {
    /// Returns the actions that are selected while this bar is dragged, the active one last.
    pub(super) fn selection(&self) -> Vec<usize> {
        let others = self.actions.iter().copied().filter(|&action| action != self.bar.action);
        others.chain([self.bar.action]).collect()
    }

    /// Returns why it could not be brought to where the pointer is.
    pub(super) fn refused(&self) -> Option<&GestureRefusal> {
        self.refused.as_ref()
    }

    /// Follows the pointer.
    pub(super) fn moved(
        &mut self,
        ui: &Ui,
        at: Vec2,
        input: &PointerInput,
        sheet: &SceneSheet<'_>,
        requests: &mut Vec<Request>,
    ) {
        let context = sheet.context;
        let pointer = StageTime::from_seconds(f64::from(sheet.scale.time_at(at.x)));
        let by = pointer - self.grabbed;
        let edge = match self.part {
            SceneBarPart::Body | SceneBarPart::Start => self.bar.begin + by,
            SceneBarPart::End => self.bar.end + by,
            SceneBarPart::FadeIn => self.bar.begin + self.bar.fade_in + by,
            SceneBarPart::FadeOut => self.bar.end - self.bar.fade_out + by,
        };
        let rate = self.base.script.rate();
        let reach = StageTime::from_seconds(f64::from(sheet.scale.seconds(6.0)));
        let snaps = context.keys.snap() != input.modifiers.command;
        let followers =
            if context.scene_editing.ripple() == input.ripple { Followers::Stay } else { Followers::Follow };
        let edge = match snaps {
            true => self.snapped(edge, context.scene_time(), reach, followers),
            false => at_five_decimals(edge),
        };
        let edge = edge.max(StageTime::ZERO);
        let asked = AskedEdge { time: edge, alt: input.modifiers.alt, followers, onto: self.onto(at, sheet) };
        // A movement within the same frame changes nothing.
        if self.asked.as_ref() != Some(&asked) {
            requests.extend(self.bring_to(&asked, context.scene_editing));
            self.becomes = self.other_place(&asked);
            self.asked = Some(asked);
        }
        let pointer = egui::pos2(at.x, at.y);
        match &self.refused {
            None => readout(ui, pointer, &self.amounts(edge, rate)),
            Some(refusal) => readout(ui, pointer, &refusal.to_string()),
        }
    }

    /// Returns the time to which an edge snaps: of a whole bar, its begin or its end, whichever is nearer to something. What moves along with it was
    /// elsewhere when it was pressed, and does not count.
    fn snapped(
        &mut self,
        edge: StageTime,
        playhead: StageTime,
        reach: StageTime,
        followers: Followers,
    ) -> StageTime {
        let part = match self.part {
            SceneBarPart::Body => MovedPart::Whole,
            SceneBarPart::Start => MovedPart::Begin,
            SceneBarPart::End => MovedPart::End,
            SceneBarPart::FadeIn | SceneBarPart::FadeOut => MovedPart::Neither,
        };
        if self.targets.as_ref().is_none_or(|(of, _)| *of != followers) {
            let moved = moved_along(&self.base.scene(), &self.actions, part, followers);
            self.targets = Some((followers, SnapTargets::of(&self.lanes, &moved)));
        }
        let nearest = |time: StageTime| {
            let (_, targets) = self.targets.as_ref()?;
            targets.nearest(time, playhead, reach)
        };
        let length = self.bar.end - self.bar.begin;
        let has_end = part == MovedPart::Whole && !self.bar.is_passive && length > StageTime::ZERO;
        let by_end = nearest(edge + length).filter(|_| has_end).map(|time| time - length);
        let distance = |time: &StageTime| (*time - edge).ticks().abs();
        let found = nearest(edge).into_iter().chain(by_end).min_by_key(distance);
        found.unwrap_or_else(|| frame_at(edge, self.base.script.rate()))
    }

    /// Returns the thing to whose lane the bar goes with the pointer: one that does such actions, or `None` for its own.
    fn onto(&self, at: Vec2, sheet: &SceneSheet<'_>) -> Option<Box<str>> {
        let kinds = element(self.bar.kind).map_or(&[][..], |row| row.who);
        let is_other = |lane: &&SceneLane| *lane.name != *self.name && kinds.contains(&lane.kind);
        let lane = sheet.layout.lane_at(at.y - sheet.canvas.top() + sheet.scroll)?;
        let lane = sheet.lanes.list.get(lane).filter(is_other)?;
        let may = self.part == SceneBarPart::Body && self.bar.kind != "shot";
        may.then(|| lane.name.clone())
    }

    /// Returns the request that brings the dragged part to an edge; `None` where it is refused.
    fn bring_to(&mut self, asked: &AskedEdge, editing: &SceneEditing) -> Option<Request> {
        let things: Arc<[Box<str>]> = self.things.iter().chain(&asked.onto).cloned().collect();
        let (label, result) = self.gesture_to(asked);
        // Told at the pointer while it is dragged, too.
        let result = match editing.lock_refusal(&things) {
            Some(reason) => Err(GestureRefusal(reason)),
            None => result,
        };
        let (text, refused) = match result {
            Ok(MovedToLane { text, left }) => (Some(text), left),
            Err(refusal) => (None, Some(refusal)),
        };
        self.refused = refused;
        let (from, also, gesture) = (Arc::clone(self.base.text()), Vec::new(), Some(self.gesture));
        let change = ScriptChange { from, text: text?, also, label, gesture, things };
        self.is_sent = true;
        Some(Request::Scene(SceneRequest::Text(change)))
    }

    /// Returns the label of the gesture that brings the dragged part to an edge, its text, and why some actions stay.
    fn gesture_to(&self, asked: &AskedEdge) -> (ScriptLabel, Result<MovedToLane, GestureRefusal>) {
        let (scene, action) = (self.base.scene(), self.bar.action);
        let AskedEdge { time: edge, alt, followers, onto } = asked;
        let (edge, followers, by) = (*edge, *followers, *edge - self.bar.begin);
        let (label, text) = match self.part {
            SceneBarPart::Body => {
                let order = if *alt { SequenceOrder::Keep } else { SequenceOrder::Change };
                let label = move_label(&self.base.script, &self.actions);
                if let Some(onto) = onto {
                    return (label, move_clips_to_lane(&scene, &self.actions, by, onto, followers));
                }
                (label, move_clips(&scene, &self.actions, by, order, followers))
            }
            SceneBarPart::Start => (ScriptLabel::TrimStart, trim_start(&scene, action, edge)),
            SceneBarPart::End if *alt => (ScriptLabel::ChangeSpeed, stretch_to(&scene, action, edge)),
            SceneBarPart::End => (ScriptLabel::TrimEnd, trim_end(&scene, action, edge, followers)),
            SceneBarPart::FadeIn => {
                (ScriptLabel::ChangeFade, set_fade(&scene, action, FadeEnd::In, edge - self.bar.begin))
            }
            SceneBarPart::FadeOut => {
                (ScriptLabel::ChangeFade, set_fade(&scene, action, FadeEnd::Out, self.bar.end - edge))
            }
        };
        (label, text.map(|text| MovedToLane { text, left: None }))
    }

    /// Returns the other place in its sequence to which the bar goes; `None` where it keeps its own.
    fn other_place(&self, asked: &AskedEdge) -> Option<(ElementPlace, SequenceMove)> {
        let may = self.part == SceneBarPart::Body && !asked.alt && asked.onto.is_none();
        let is_alone = self.actions == [self.bar.action];
        if !(may && is_alone) {
            return None;
        }
        let (scene, action) = (self.base.scene(), self.bar.action);
        let place = sequence_place(&scene, action, asked.time)?;
        // The place alone decides what it becomes, so that a movement without another one reads no text.
        let known = self.becomes.filter(|(of, _)| *of == place);
        known.or_else(|| Some((place, sequence_move(&scene, action, place)?)))
    }

    /// Returns the numbers of the drag.
    fn amounts(&self, edge: StageTime, rate: StageRate) -> String {
        let (seconds, frame) = (edge.seconds(), rate.nearest_frame(edge));
        let what = match self.part {
            SceneBarPart::Body if let Some((_, SequenceMove { number, begin })) = self.becomes => format!(
                "becomes {} in sequence, begins at {:.3} s, frame {}",
                ordinal(number),
                begin.seconds(),
                rate.nearest_frame(begin)
            ),
            SceneBarPart::Body => format!(
                "begins at {seconds:.3} s, frame {frame}, {:+.3} s",
                (edge - self.bar.begin).seconds()
            ),
            SceneBarPart::Start => format!("starts at {seconds:.3} s, frame {frame}"),
            SceneBarPart::End => {
                format!(
                    "ends at {seconds:.3} s, frame {frame}, lasts {:.3} s",
                    (edge - self.bar.begin).seconds()
                )
            }
            SceneBarPart::FadeIn => {
                format!("fades in for {:.3} s", (edge - self.bar.begin).seconds().max(0.0))
            }
            SceneBarPart::FadeOut => {
                format!("fades out for {:.3} s", (self.bar.end - edge).seconds().max(0.0))
            }
        };
        format!("{} · {}: {what}", self.name, self.bar.label)
    }
}

/// Returns a number as a place in an order: 1st, 2nd, 11th.
fn ordinal(number: usize) -> String {
    let ending = match (number % 10, number % 100) {
        (1..=3, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// Returns the nearest time that a script writes with five decimals.
fn at_five_decimals(time: StageTime) -> StageTime {
    const STEP: i64 = TICKS_PER_SECOND / 100_000;
    StageTime::from_ticks((time.ticks() + STEP / 2).div_euclid(STEP) * STEP)
}
