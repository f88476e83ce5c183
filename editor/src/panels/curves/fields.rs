//! Number fields for the values and the time of the selected keys.

use super::axis::ValueWindow;
use super::canvas::component_name;
use super::curve::Curve;
use super::drag::MOST;
use super::form::RotationForm;
use super::key_numbers::{KeyNumbers, selected_keys};
use super::paint::color;
use super::scales::CurveRanges;
use super::toolbar::Chosen;
use super::values::{ValueChange, ValueKey, given_angles, value_edit};
use crate::control::expression::Quantity;
use crate::panels::context::PanelContext;
use crate::panels::dope::to_frame;
use crate::panels::keys::{Drawn, KeyDragOp, KeysRequest};
use crate::panels::number_field::{FieldEvent, NumberField, RelativeNumber};
use crate::panels::number_text::Digits;
use crate::panels::request::Request;
use crate::panels::style::{CONTROL, GRID};
use crate::panels::theme::Theme;
use dragonfly_document::Change;
use dragonfly_picture::playback::LATEST;
use egui::{Align2, FontId, Id, Rect, Sense, Ui, pos2, vec2};
use std::sync::Arc;

/// Width of a field.
const WIDTH: f32 = 64.0;
/// Width of the letter before a value.
const LETTER: f32 = 12.0;
/// Largest number of keys whose values are typed at once.
const MOST_TYPED: usize = 50_000;
/// Reason why more cannot be typed.
const TOO_MANY: &str = "At most 50,000 keys can be given values at once";

/// The fields, with the one that is dragged.
#[derive(Debug, Default)]
pub(super) struct Fields {
    held: Option<HeldField>,
}

/// The number that a field edits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum KeyNumber {
    Value(usize),
    Time,
}

/// A dragged field: its keys as they were when the drag began, and the distance from there.
#[derive(Clone, Debug)]
struct HeldField {
    part: KeyNumber,
    numbers: KeyNumbers,
    keys: Vec<ValueKey>,
    by: f32,
    /// The curves of the keys when the drag began.
    curves: Vec<Arc<Curve>>,
}

/// What the fields edit.
pub(super) struct FieldsContext<'a> {
    pub(super) chosen: &'a Chosen,
    pub(super) curves: &'a [Arc<Curve>],
    /// The numbers of the selected keys of these curves.
    pub(super) numbers: Option<KeyNumbers>,
    pub(super) drawn: &'a Drawn,
    pub(super) window: ValueWindow,
    pub(super) ranges: &'a CurveRanges,
    /// Component of the key that was pressed on last: shown where there is no space for all.
    pub(super) component: usize,
    pub(super) context: &'a PanelContext<'a>,
}

impl Fields {
    /// Draws the fields from right to left: time, then the values that fit.
    pub(super) fn show(&mut self, ui: &mut Ui, about: &FieldsContext<'_>, requests: &mut Vec<Request>) {
        self.held
            .take_if(|held| held.by != 0.0 && !about.context.keys.drag().is_some_and(|drag| drag.held()));
        let held = self.held.as_ref().map(|held| held.numbers);
        let numbers = held.or(about.numbers);
        let Some(numbers) = numbers.filter(|_| ui.available_width() >= WIDTH) else { return };
        ui.spacing_mut().item_spacing.x = GRID;
        self.time(ui, &numbers, about, requests);
        let width = numbers.first.width();
        let shown: Vec<usize> = (0..width)
            .filter(|at| numbers.first.id.is_shape() || about.chosen.components & (1 << at) != 0)
            .collect();
        let room = (ui.available_width() / (WIDTH + LETTER + GRID)) as usize;
        if shown.len() <= room {
            for &component in shown.iter().rev() {
                self.value(ui, &numbers, component, about, requests);
            }
        } else if room > 0 {
            let touched = Some(about.component).filter(|component| shown.contains(component));
            self.value(ui, &numbers, touched.unwrap_or(shown[0]), about, requests);
        }
    }

    fn time(
        &mut self,
        ui: &mut Ui,
        numbers: &KeyNumbers,
        about: &FieldsContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, CONTROL), Sense::hover());
        let frame = f64::from(about.context.frame_seconds());
        let by = self.by(KeyNumber::Time);
        let help = if numbers.count > 1 {
            "Of the selected keys. A number moves them together, so that the first one is there"
        } else {
            "Of the selected key"
        };
        let field = NumberField {
            name: if numbers.count > 1 { "Time of the keys" } else { "Time of the key" },
            value: numbers.time.map(|time| f64::from(time + by)),
            unit: "s",
            speed: frame * 0.2,
            snap: frame,
            grain: 1e-6,
            digits: Digits::Fixed(3),
            range: if numbers.time.is_some() { 0.0..=f64::from(LATEST) } else { ANY },
            help,
            ..field(KeyNumber::Time)
        };
        let (event, _) = field.show(ui, rect);
        // The first of all selected keys, those of other channels included.
        let first = || about.context.keys.selection().extent(&about.drawn.take).map(|[first, _]| first);
        let start = numbers.time.or_else(first).unwrap_or(numbers.first.time);
        let snap = about.context.keys.snap() != ui.input(|input| input.modifiers.command);
        let event = match event {
            FieldEvent::Dragged(by) if snap => {
                FieldEvent::Dragged(f64::from(to_frame(start + by as f32, about.context) - start))
            }
            event => event,
        };
        let typed = match event {
            FieldEvent::Typed(value) => Some(KeyDragOp::Move(value as f32 - start)),
            FieldEvent::Changed(RelativeNumber::Add(by)) => Some(KeyDragOp::Move(by as f32)),
            FieldEvent::Changed(RelativeNumber::Multiply(by)) => {
                Some(KeyDragOp::Scale { about: 0.0, factor: by as f32 })
            }
            FieldEvent::Nothing
            | FieldEvent::Touched
            | FieldEvent::Dragged(_)
            | FieldEvent::Released
            | FieldEvent::Cancelled => None,
        };
        match typed {
            Some(op) => {
                requests.push(Request::Timeline(KeysRequest::Drag(op)));
                requests.push(Request::Timeline(KeysRequest::Release));
            }
            None => {
                let op = |_: &[ValueKey], by| Some(KeyDragOp::Move(by));
                self.drag(event, KeyNumber::Time, numbers, about, op, requests);
            }
        }
    }

    fn value(
        &mut self,
        ui: &mut Ui,
        numbers: &KeyNumbers,
        component: usize,
        about: &FieldsContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let (rect, _) = ui.allocate_exact_size(vec2(LETTER + WIDTH, CONTROL), Sense::hover());
        let is_weight = numbers.first.id.is_shape();
        let letter = if is_weight { "" } else { component_name(component) };
        let tone = color(Theme::of(ui), component);
        let at = pos2(rect.left(), rect.center().y);
        ui.painter().text(at, Align2::LEFT_CENTER, letter, FontId::proportional(11.0), tone);
        let rect = Rect::from_min_max(pos2(rect.left() + LETTER, rect.top()), rect.max);
        let key = &numbers.first;
        let angle = key.id.is_rotation() && key.form != RotationForm::Quaternion;
        let by = self.by(KeyNumber::Value(component));
        // Below a millionth of the numbers that are shown, a value is a rounding error.
        let span = about.ranges.window(about.window, key.id, component).span;
        let dust = |shown: f64| shown.abs() < span * 1e-6;
        let shown = numbers.values[component].map(|number| f64::from(number + by));
        let field = NumberField {
            name: &if is_weight { "Weight".to_owned() } else { format!("Value {letter}") },
            value: shown.map(|shown| if dust(shown) { 0.0 } else { shown }),
            quantity: if angle { Quantity::Angle } else { Quantity::Number },
            unit: if angle { "°" } else { "" },
            // About as far as the curve moves on the screen.
            speed: span / 300.0,
            snap: if angle { 15.0 } else { 0.1 },
            grain: f64::from(key.numbers[component].abs()) * 1e-6 + 1e-7,
            digits: if angle { Digits::Fixed(2) } else { Digits::Fitting },
            locked: (numbers.count > MOST_TYPED).then_some(TOO_MANY),
            help: if numbers.count > 1 { "Of the selected keys" } else { "Of the selected key" },
            ..field(KeyNumber::Value(component))
        };
        let (event, _) = field.show(ui, rect);
        let typed = match event {
            FieldEvent::Typed(value) => Some(ValueChange::Set(value as f32)),
            FieldEvent::Changed(RelativeNumber::Add(by)) => Some(ValueChange::Add(by as f32)),
            FieldEvent::Changed(RelativeNumber::Multiply(by)) => Some(ValueChange::Multiply(by as f32)),
            FieldEvent::Nothing
            | FieldEvent::Touched
            | FieldEvent::Dragged(_)
            | FieldEvent::Released
            | FieldEvent::Cancelled => None,
        };
        let edit = |keys: &[ValueKey], change| value_edit(about.context.take_ref()?, keys, component, change);
        match typed {
            Some(change) => {
                let keys = selected_keys(about.curves, about.drawn, MOST_TYPED);
                let Some(edit) = edit(&keys, change) else { return };
                requests.extend(given_angles(&curves_of(about.curves, &keys), &keys, component, change));
                requests.push(Request::Change(Change::Edit(edit, None)));
            }
            None => {
                let part = KeyNumber::Value(component);
                let op = |keys: &[ValueKey], by| edit(keys, ValueChange::Add(by)).map(KeyDragOp::Edit);
                self.drag(event, part, numbers, about, op, requests);
                if let (FieldEvent::Dragged(_), Some(held)) = (event, &self.held) {
                    let change = ValueChange::Add(held.by);
                    requests.extend(given_angles(&held.curves, &held.keys, component, change));
                }
            }
        }
    }

    /// Returns the distance by which a field is dragged.
    fn by(&self, part: KeyNumber) -> f32 {
        self.held.as_ref().filter(|held| held.part == part).map_or(0.0, |held| held.by)
    }

    fn drag(
        &mut self,
        event: FieldEvent,
        part: KeyNumber,
        numbers: &KeyNumbers,
        about: &FieldsContext<'_>,
        op: impl Fn(&[ValueKey], f32) -> Option<KeyDragOp>,
        requests: &mut Vec<Request>,
    ) {
        let request = match event {
            // More keys do not follow the pointer.
            FieldEvent::Dragged(_) if part != KeyNumber::Time && numbers.count > MOST => None,
            FieldEvent::Dragged(by) => {
                let held = self.held.get_or_insert_with(|| {
                    let most = if part == KeyNumber::Time { 1 } else { MOST };
                    let keys = selected_keys(about.curves, about.drawn, most);
                    let curves = curves_of(about.curves, &keys);
                    HeldField { part, numbers: *numbers, keys, by: 0.0, curves }
                });
                held.by = by as f32;
                op(&held.keys, held.by).map(KeysRequest::Drag)
            }
            FieldEvent::Released => self.held.take().map(|_| KeysRequest::Release),
            FieldEvent::Cancelled => self.held.take().map(|_| KeysRequest::Cancel),
            FieldEvent::Nothing | FieldEvent::Touched | FieldEvent::Typed(_) | FieldEvent::Changed(_) => None,
        };
        requests.extend(request.map(Request::Timeline));
    }
}

/// Returns the curves of these keys.
fn curves_of(curves: &[Arc<Curve>], keys: &[ValueKey]) -> Vec<Arc<Curve>> {
    let mut ids: Vec<_> = keys.iter().map(|key| key.id).collect();
    ids.dedup();
    curves.iter().filter(|curve| ids.contains(&curve.id)).cloned().collect()
}

/// Any number.
const ANY: std::ops::RangeInclusive<f64> = f32::MIN as f64..=f32::MAX as f64;

/// Returns the settings that all fields share.
fn field<'a>(part: KeyNumber) -> NumberField<'a> {
    NumberField {
        id: Id::unique(("number of the selected keys", part)),
        name: "",
        value: None,
        quantity: Quantity::Number,
        unit: "",
        speed: 0.0,
        snap: 0.0,
        grain: 0.0,
        digits: Digits::Fitting,
        range: ANY,
        locked: None,
        help: "",
        quiet: false,
        relative: true,
    }
}
