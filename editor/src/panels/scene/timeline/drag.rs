//! Clicks, selection boxes and drags on the bars.

use super::held_bar::{HeldBar, begin};
use super::lane_layout::{SceneBarPart, SceneHit};
use super::sheet::SceneSheet;
use crate::panels::drag::{DragEvent, PanelDrag, PointerInput, SelectionBox, choice_of, position};
use crate::panels::request::Request;
use crate::panels::scene::SceneRequest;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use egui::{CursorIcon, Pos2, Rect, Response, Ui, pos2};

/// What is dragged.
#[derive(Clone, Debug)]
enum TimelineDrag {
    /// A bar.
    Bar(Box<HeldBar>),
    /// A box that selects.
    Box(SelectionBox),
}

/// The drag of a bar or a box, and what is under the pointer.
#[derive(Debug, Default)]
pub(super) struct BarDragging {
    drag: PanelDrag<SceneHit, TimelineDrag>,
    hovered: Option<SceneHit>,
    /// The corner of the box in the last frame in which the pointer was known.
    last: Option<Pos2>,
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
                let time = sheet.scale.time_at(press.at.x);
                match begin(press.on, StageTime::from_seconds(f64::from(time)), sheet) {
                    Ok(Some(held)) => {
                        let select = SceneRequest::SelectActions(held.selection(), Choice::Replace);
                        requests.push(Request::Scene(select));
                        self.drag.begin(TimelineDrag::Bar(Box::new(held)));
                    }
                    Ok(None) => {
                        let from = [time, press.at.y - top];
                        let choice = choice_of(press.modifiers);
                        self.drag.begin(TimelineDrag::Box(SelectionBox { from, choice }));
                    }
                    Err(refusal) => requests.push(Request::Scene(SceneRequest::Refused(refusal.to_string()))),
                }
            }
            DragEvent::Moved(at) => match self.drag.drag_mut() {
                Some(TimelineDrag::Bar(held)) => held.moved(ui, at, &input, sheet, requests),
                Some(TimelineDrag::Box(drawn)) => {
                    let [time, y] = drawn.from;
                    let corner = pos2(sheet.scale.x_of(time), top + y);
                    SelectionBox::paint(ui, sheet.canvas, corner, position(at));
                    self.last = Some(position(at));
                }
                None => {}
            },
            DragEvent::Dropped(TimelineDrag::Bar(held)) => {
                if held.is_sent {
                    requests.push(Request::Change(Change::Release(held.gesture)));
                }
                let refused = held.refused().map(|refusal| SceneRequest::Refused(refusal.to_string()));
                requests.extend(refused.map(Request::Scene));
            }
            DragEvent::Cancelled(TimelineDrag::Bar(held)) if held.is_sent => {
                requests.push(Request::Change(Change::Cancel(held.gesture)));
            }
            DragEvent::Dropped(TimelineDrag::Box(drawn)) => {
                let at = input.pointer.or(self.last).unwrap_or_default();
                requests.push(Request::Scene(boxed(&drawn, at, sheet)));
            }
            DragEvent::Cancelled(_) | DragEvent::Nothing | DragEvent::Pressed => {}
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
            (Some(TimelineDrag::Bar(held)), _) => held.part,
            (Some(TimelineDrag::Box(_)), _) => return,
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
            requests.push(Request::Scene(SceneRequest::SelectActions(vec![action], choice_of(modifiers))));
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

/// Returns the request that selects the bars that a box touches, up to its corner at the pointer.
fn boxed(drawn: &SelectionBox, pointer: Pos2, sheet: &SceneSheet<'_>) -> SceneRequest {
    let top = sheet.canvas.top() - sheet.scroll;
    let [[left, right], [first, last]] = drawn.ranges([sheet.scale.time_at(pointer.x), pointer.y - top]);
    let frame = Rect::from_min_max(
        pos2(sheet.scale.x_of(left), top + first),
        pos2(sheet.scale.x_of(right), top + last),
    );
    let lanes = sheet.lanes.list.iter().enumerate();
    let bars = lanes.flat_map(|(index, lane)| lane.bars.iter().map(move |bar| (index, bar)));
    let touched =
        bars.filter(|(index, bar)| sheet.layout.bar(*index, bar, top, sheet.scale).intersects(frame));
    SceneRequest::SelectActions(touched.map(|(_, bar)| bar.action).collect(), drawn.choice)
}
