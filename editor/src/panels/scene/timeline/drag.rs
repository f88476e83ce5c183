//! Drags of bars: moved, trimmed, faded, stretched.

use super::lane_layout::{SceneBarPart, SceneHit};
use super::sheet::SceneSheet;
use super::snap::snapped_time;
use crate::panels::drag::{DragEvent, PanelDrag, PointerInput, readout};
use crate::panels::request::Request;
use crate::panels::scene::{SceneBase, SceneRequest, ScriptChange};
use dragonfly_anim::stage::gesture::{
    FadeEnd, Followers, GestureRefusal, SequenceOrder, move_clip, set_fade, set_speed, trim_end, trim_start,
};
use dragonfly_anim::stage::lanes::SceneBar;
use dragonfly_anim::stage::time::{StageRate, StageTime, TICKS_PER_SECOND};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::history::Gesture;
use egui::{CursorIcon, Pos2, Response, Ui};
use glam::Vec2;

/// The drag of a bar, and what is under the pointer.
#[derive(Debug, Default)]
pub(super) struct BarDragging {
    drag: PanelDrag<SceneHit, HeldBar>,
    hovered: Option<SceneHit>,
}

/// A bar that is dragged.
#[derive(Clone, Debug)]
struct HeldBar {
    base: SceneBase,
    gesture: Gesture,
    bar: SceneBar,
    part: SceneBarPart,
    /// Time of the pointer when it was pressed.
    grabbed: StageTime,
    /// Name of the thing.
    name: Box<str>,
    /// Whether something was sent.
    is_sent: bool,
    /// The time to which the edge was brought last, with which keys.
    asked: Option<(StageTime, bool, Followers)>,
    /// Why it could not be brought there.
    refused: Option<GestureRefusal>,
}

impl BarDragging {
    /// Returns what is under the pointer, or dragged.
    pub(super) fn hovered(&self) -> Option<SceneHit> {
        self.hovered
    }

    /// Returns whether a button is held.
    pub(super) fn is_busy(&self) -> bool {
        self.drag.is_busy()
    }

    pub(super) fn update(
        &mut self,
        ui: &Ui,
        response: &Response,
        sheet: &SceneSheet<'_>,
        requests: &mut Vec<Request>,
    ) {
        let top = sheet.canvas.top() - sheet.scroll;
        let hit = |at: Pos2| match sheet.canvas.contains(at) {
            true => sheet.layout.hit(sheet.lanes, at, top, sheet.scale),
            false => SceneHit::Nothing,
        };
        let input = PointerInput::read(ui);
        if !self.drag.is_busy() {
            self.hovered = response.hover_pos().map(hit);
        }
        self.cursor(ui);
        let held = input.primary_down && response.is_pointer_button_down_on()
            || input.clicked && response.contains_pointer();
        match self.drag.step(&input, held, hit) {
            DragEvent::Clicked(press) => click(&press.on, sheet, press.modifiers, requests),
            DragEvent::Started(press) => {
                let time = StageTime::from_seconds(f64::from(sheet.scale.time_at(press.at.x)));
                match begin(press.on, time, sheet) {
                    Ok(Some(held)) => {
                        requests.push(Request::Scene(SceneRequest::SelectAction(Some(held.bar.action))));
                        self.drag.begin(held);
                    }
                    Ok(None) => {}
                    Err(refusal) => requests.push(Request::Scene(SceneRequest::Refused(refusal.to_string()))),
                }
            }
            DragEvent::Moved(at) => {
                if let Some(held) = self.drag.drag_mut() {
                    held.moved(ui, at, &input, sheet, requests);
                }
            }
            DragEvent::Dropped(held) if held.is_sent => {
                requests.push(Request::Change(Change::Release(held.gesture)));
            }
            DragEvent::Cancelled(held) if held.is_sent => {
                requests.push(Request::Change(Change::Cancel(held.gesture)));
            }
            DragEvent::Dropped(_) | DragEvent::Cancelled(_) | DragEvent::Nothing | DragEvent::Pressed => {}
        }
        if response.double_clicked()
            && let Some(SceneHit::Bar { action, .. }) = self.hovered
            && let Some((_, bar)) = sheet.lanes.bar_of(action)
        {
            requests.push(Request::Seek(sheet.context.playhead_at(bar.begin)));
        }
    }

    fn cursor(&self, ui: &Ui) {
        let part = match (self.drag.drag(), self.hovered) {
            (Some(held), _) => held.part,
            (None, Some(SceneHit::Bar { part, .. })) => part,
            (None, Some(SceneHit::Lane(_) | SceneHit::Nothing) | None) => return,
        };
        ui.ctx().set_cursor_icon(match part {
            SceneBarPart::Body if self.drag.drag().is_some() => CursorIcon::Grabbing,
            SceneBarPart::Body => CursorIcon::Grab,
            SceneBarPart::Start | SceneBarPart::End => CursorIcon::ResizeHorizontal,
            SceneBarPart::FadeIn | SceneBarPart::FadeOut => CursorIcon::ResizeColumn,
        });
    }
}

/// Selects what was clicked.
fn click(hit: &SceneHit, sheet: &SceneSheet<'_>, modifiers: egui::Modifiers, requests: &mut Vec<Request>) {
    match *hit {
        SceneHit::Bar { action, .. } => {
            requests.push(Request::Scene(SceneRequest::SelectAction(Some(action))))
        }
        SceneHit::Lane(lane) => {
            requests.push(Request::Scene(SceneRequest::SelectAction(None)));
            if let Some(lane) = sheet.lanes.list.get(lane).filter(|lane| !lane.kind.is_empty()) {
                let choice = if modifiers.command { Choice::Toggle } else { Choice::Replace };
                requests.push(Request::Scene(SceneRequest::SelectThings(vec![lane.name.clone()], choice)));
            }
        }
        SceneHit::Nothing => requests.push(Request::Scene(SceneRequest::SelectAction(None))),
    }
}

/// Begins a drag; `Ok(None)` where there is nothing to drag.
fn begin(
    hit: SceneHit,
    grabbed: StageTime,
    sheet: &SceneSheet<'_>,
) -> Result<Option<HeldBar>, GestureRefusal> {
    let SceneHit::Bar { lane, action, part } = hit else { return Ok(None) };
    let Some((lane, bar)) = sheet.lanes.list.get(lane).zip(sheet.lanes.bar_of(action).map(|(_, bar)| bar))
    else {
        return Ok(None);
    };
    if sheet.context.scene_editing.is_locked(&lane.name) {
        return Err(GestureRefusal(format!("{} is locked", lane.name)));
    }
    let base = SceneBase::of(sheet.scene, sheet.context.scene_editing.text(sheet.scene))?;
    let gesture = sheet.context.new_gesture();
    Ok(Some(HeldBar {
        base,
        gesture,
        bar: bar.clone(),
        part,
        grabbed,
        name: lane.name.clone(),
        is_sent: false,
        asked: None,
        refused: None,
    }))
}

impl HeldBar {
    fn moved(
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
        let edge = match snaps {
            true => snapped_time(edge, sheet.lanes, self.bar.action, context.scene_time(), reach, rate),
            false => at_five_decimals(edge),
        };
        let edge = edge.max(StageTime::ZERO);
        let followers =
            if context.scene_editing.ripple() == input.ripple { Followers::Stay } else { Followers::Follow };
        // A movement within the same frame changes nothing.
        if self.asked.replace((edge, input.modifiers.alt, followers))
            != Some((edge, input.modifiers.alt, followers))
        {
            requests.extend(self.bring_to(edge, input.modifiers.alt, followers));
        }
        let pointer = egui::pos2(at.x, at.y);
        match &self.refused {
            None => readout(ui, pointer, &self.amounts(edge, rate)),
            Some(refusal) => readout(ui, pointer, &refusal.to_string()),
        }
    }

    /// Returns the request that brings the dragged part to `edge`; `None` where it is refused.
    fn bring_to(&mut self, edge: StageTime, alt: bool, followers: Followers) -> Option<Request> {
        let (label, result) = self.gesture_to(edge, alt, followers);
        let (text, refused) = result.map_or_else(|refusal| (None, Some(refusal)), |text| (Some(text), None));
        self.refused = refused;
        let from = std::sync::Arc::clone(self.base.text());
        let change = ScriptChange { from, text: text?, also: Vec::new(), label, gesture: Some(self.gesture) };
        self.is_sent = true;
        Some(Request::Scene(SceneRequest::Text(change)))
    }

    /// Returns the label and the text of the gesture that brings the dragged part to `edge`.
    fn gesture_to(
        &self,
        edge: StageTime,
        alt: bool,
        followers: Followers,
    ) -> (&'static str, Result<String, GestureRefusal>) {
        let (scene, action) = (self.base.scene(), self.bar.action);
        match self.part {
            SceneBarPart::Body => {
                let order = if alt { SequenceOrder::Keep } else { SequenceOrder::Change };
                ("Move clip", move_clip(&scene, action, edge, order, followers))
            }
            SceneBarPart::Start => ("Trim start", trim_start(&scene, action, edge)),
            SceneBarPart::End if alt => ("Change speed", set_speed(&scene, action, self.speed_to(edge))),
            SceneBarPart::End => ("Trim end", trim_end(&scene, action, edge, followers)),
            SceneBarPart::FadeIn => {
                ("Change fade", set_fade(&scene, action, FadeEnd::In, edge - self.bar.begin))
            }
            SceneBarPart::FadeOut => {
                ("Change fade", set_fade(&scene, action, FadeEnd::Out, self.bar.end - edge))
            }
        }
    }

    /// Returns the speed with which the bar would end at a time.
    fn speed_to(&self, edge: StageTime) -> f64 {
        let speed = self
            .base
            .script
            .element(self.bar.action)
            .value("speed")
            .and_then(|text| text.parse::<f64>().ok());
        let (old, new) = ((self.bar.end - self.bar.begin).seconds(), (edge - self.bar.begin).seconds());
        speed.unwrap_or(1.0) * old / new.max(1e-3)
    }

    /// Returns the numbers of the drag.
    fn amounts(&self, edge: StageTime, rate: StageRate) -> String {
        let (seconds, frame) = (edge.seconds(), rate.nearest_frame(edge));
        let what = match self.part {
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

/// Returns the nearest time that a script writes with five decimals.
fn at_five_decimals(time: StageTime) -> StageTime {
    const STEP: i64 = TICKS_PER_SECOND / 100_000;
    StageTime::from_ticks((time.ticks() + STEP / 2).div_euclid(STEP) * STEP)
}
