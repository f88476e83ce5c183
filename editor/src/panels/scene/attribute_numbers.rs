//! Attributes of plain numbers as number fields: typed, or dragged as one step of the history.

use super::attributes::value_change;
use super::{SceneBase, SceneRequest};
use crate::control::expression::Quantity;
use crate::panels::context::PanelContext;
use crate::panels::number_field::{FieldEvent, NumberField};
use crate::panels::number_text::{Digits, exact};
use crate::panels::plain_words::plain_words;
use crate::panels::request::Request;
use crate::panels::style::GRID;
use crate::panels::submenu::entry;
use dragonfly_anim::stage::gesture::GestureRefusal;
use dragonfly_anim::stage::table::{AttributeRow, PlainNumbers};
use dragonfly_anim::stage::time::Decimal;
use dragonfly_document::Change;
use dragonfly_document::history::Gesture;
use egui::{Id, Rect, Response, Ui, pos2, vec2};

/// Height of a field, points.
const HEIGHT: f32 = 24.0;
/// Difference that is not written; of small numbers less than this.
const GRAIN: f64 = 5e-5;
/// Change per point of a drag: of lengths and factors, and of degrees.
const SPEED: f64 = 0.01;
const DEGREES: f64 = 0.5;

/// An attribute whose value is plain numbers.
#[derive(Clone, Debug)]
pub(super) struct NumberAttribute {
    element: usize,
    row: &'static AttributeRow,
    kind: PlainNumbers,
    /// The numbers as they are written, or the default ones.
    texts: Vec<String>,
    is_written: bool,
}

/// A number that is dragged.
#[derive(Clone, Debug)]
pub(super) struct DraggedAttribute {
    gesture: Gesture,
    /// The script at the start of the drag.
    base: SceneBase,
    attribute: NumberAttribute,
    index: usize,
    start: f64,
    is_sent: bool,
}

/// Shows the menu of an attribute that is written, at a right click. Returns whether the default is to be restored.
pub(super) fn reset_menu(response: &Response) -> bool {
    let mut resets = false;
    response.context_menu(|ui| {
        if entry(ui, "Reset to the default").clicked() {
            resets = true;
            ui.close();
        }
    });
    resets
}

impl NumberAttribute {
    /// Returns an attribute with fields for its numbers; `None` where its value is something else.
    pub(super) fn of(element: usize, row: &'static AttributeRow, written: Option<&str>) -> Option<Self> {
        let kind = row.value.plain_numbers()?;
        let text = written.unwrap_or(row.default);
        let texts: Vec<String> = text.split_ascii_whitespace().map(str::to_owned).collect();
        let is_plain = texts.len() == kind.count && texts.iter().all(|text| Decimal::parse(text).is_some());
        is_plain.then_some(Self { element, row, kind, texts, is_written: written.is_some() })
    }

    /// Draws the fields. `dragged` is the number that is dragged, of any attribute. Returns whether the default is to be restored.
    pub(super) fn show(
        &self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        dragged: &mut Option<DraggedAttribute>,
        requests: &mut Vec<Request>,
    ) -> bool {
        let mut resets = false;
        let (count, gaps) = (self.texts.len() as f32, GRID * (self.texts.len() as f32 - 1.0));
        let width = (ui.available_width() - 2.0 * GRID).max(24.0);
        let (all, _) = ui.allocate_exact_size(vec2(width, HEIGHT), egui::Sense::hover());
        let each = ((width - gaps) / count).max(8.0);
        for index in 0..self.texts.len() {
            let left = all.left() + index as f32 * (each + GRID);
            let rect = Rect::from_min_size(pos2(left, all.top()), vec2(each, HEIGHT));
            let (event, response) = self.field(ui, rect, index);
            self.follow(event, index, context, dragged, requests);
            if self.is_written && !self.row.required {
                resets |= reset_menu(&response);
            }
        }
        resets
    }

    fn field(&self, ui: &mut Ui, rect: Rect, index: usize) -> (FieldEvent, Response) {
        let value = self.value(index);
        let is_angle = matches!(self.row.name, "facing" | "tilt");
        // A factor changes in proportion to its size.
        let factor = if self.texts.len() == 1 { value.abs().clamp(0.01, 1.0) } else { 1.0 };
        let name = match self.texts.len() {
            1 => self.row.name.to_owned(),
            _ => format!("{} {}", self.row.name, ["x", "y", "z"].get(index).copied().unwrap_or_default()),
        };
        let help = plain_words(self.row.help);
        let field = NumberField {
            id: Id::unique(("attribute", self.element, self.row.name, index)),
            name: &name,
            value: Some(value),
            quantity: if is_angle { Quantity::Angle } else { Quantity::Number },
            unit: "",
            speed: if is_angle { DEGREES } else { SPEED * factor },
            snap: if is_angle { 15.0 } else { 0.1 },
            grain: GRAIN,
            digits: Digits::Fitting,
            range: self.kind.least..=self.kind.most,
            locked: None,
            help: &help,
            quiet: !self.is_written,
            relative: false,
        };
        field.show(ui, rect)
    }

    fn value(&self, index: usize) -> f64 {
        let text = self.texts.get(index).and_then(|text| Decimal::parse(text));
        text.map(Decimal::to_f64).unwrap_or_default()
    }

    /// Returns the text of the attribute with another number; the others stay as they are written.
    fn with(&self, index: usize, number: f64) -> String {
        let mut texts = self.texts.clone();
        if let Some(text) = texts.get_mut(index) {
            *text = exact(number, GRAIN.min(1e-4 * number.abs()));
        }
        texts.join(" ")
    }

    /// Writes what happened to a field.
    fn follow(
        &self,
        event: FieldEvent,
        index: usize,
        context: &PanelContext<'_>,
        dragged: &mut Option<DraggedAttribute>,
        requests: &mut Vec<Request>,
    ) {
        match event {
            FieldEvent::Nothing | FieldEvent::Touched | FieldEvent::Changed(_) => {}
            FieldEvent::Typed(number) => {
                let change = base(context).and_then(|base| {
                    value_change(&base, self.element, self.row, Some(&self.with(index, number)), None)
                });
                requests.push(request(change.map(SceneRequest::Text)));
            }
            FieldEvent::Dragged(by) => {
                if dragged.is_none() {
                    *dragged = match base(context) {
                        Ok(base) => Some(DraggedAttribute {
                            gesture: context.new_gesture(),
                            base,
                            attribute: self.clone(),
                            index,
                            start: self.value(index),
                            is_sent: false,
                        }),
                        Err(refusal) => return requests.push(request(Err(refusal))),
                    };
                }
                requests.extend(dragged.as_mut().map(|dragged| dragged.moved(by)));
            }
            FieldEvent::Released | FieldEvent::Cancelled => {
                let Some(over) = dragged.take().filter(|over| over.is_sent) else { return };
                requests.push(Request::Change(match event == FieldEvent::Released {
                    true => Change::Release(over.gesture),
                    false => Change::Cancel(over.gesture),
                }));
            }
        }
    }
}

impl DraggedAttribute {
    /// Returns the request that changes the number from its start.
    fn moved(&mut self, by: f64) -> Request {
        let own = &self.attribute;
        let text = own.with(self.index, self.start + by);
        let change = value_change(&self.base, own.element, own.row, Some(&text), Some(self.gesture));
        self.is_sent |= change.is_ok();
        request(change.map(SceneRequest::Text))
    }
}

fn base(context: &PanelContext<'_>) -> Result<SceneBase, GestureRefusal> {
    let scene = context.scene().ok_or_else(|| GestureRefusal("No scene is open".to_owned()))?;
    SceneBase::of(scene, context.scene_editing.text(scene))
}

fn request(request: Result<SceneRequest, GestureRefusal>) -> Request {
    Request::Scene(request.unwrap_or_else(|refusal| SceneRequest::Refused(refusal.to_string())))
}
