//! Number fields for the values and the time of the selected key.

use super::axis::ValueWindow;
use super::canvas::component_name;
use super::curve::Curve;
use super::form::RotationForm;
use super::paint::color;
use super::toolbar::Chosen;
use super::values::{ValueKey, given_angles, value_edit};
use crate::control::expression::Quantity;
use crate::panels::context::PanelContext;
use crate::panels::dope::to_frame;
use crate::panels::keys::{Drawn, KeyDragOp, KeysRequest};
use crate::panels::number_field::{FieldEvent, NumberField};
use crate::panels::number_text::Digits;
use crate::panels::request::Request;
use crate::panels::style::{CONTROL, GRID};
use crate::panels::theme::Theme;
use dragonfly_document::Change;
use dragonfly_document::edit::Property;
use dragonfly_picture::playback::LATEST;
use egui::{Align2, FontId, Id, Rect, Sense, Ui, pos2, vec2};
use std::sync::Arc;

/// Width of a field.
const WIDTH: f32 = 80.0;
/// Width of the letter before a value.
const LETTER: f32 = 12.0;

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

/// A dragged field: its key as it was when the drag began, and the distance from there.
#[derive(Clone, Debug)]
struct HeldField {
    part: KeyNumber,
    key: ValueKey,
    by: f32,
    /// The curve of the key when the drag began.
    curve: Option<Arc<Curve>>,
}

/// What the fields edit.
pub(super) struct FieldsContext<'a> {
    pub(super) chosen: &'a Chosen,
    pub(super) curves: &'a [Arc<Curve>],
    pub(super) drawn: &'a Drawn,
    pub(super) window: ValueWindow,
    /// Component of the key that was pressed on last: shown where there is no space for all.
    pub(super) component: usize,
    pub(super) context: &'a PanelContext<'a>,
}

impl Fields {
    /// Draws the fields from right to left: time, then the values that fit.
    pub(super) fn show(&mut self, ui: &mut Ui, about: &FieldsContext<'_>, requests: &mut Vec<Request>) {
        self.held
            .take_if(|held| held.by != 0.0 && !about.context.keys.drag().is_some_and(|drag| drag.held()));
        let key = self.held.as_ref().map(|held| held.key).or_else(|| only_key(about.curves, about.drawn));
        let Some(key) = key.filter(|_| ui.available_width() >= WIDTH) else { return };
        ui.spacing_mut().item_spacing.x = GRID;
        self.time(ui, &key, about, requests);
        let shown: Vec<usize> =
            (0..key.width()).filter(|at| about.chosen.components & (1 << at) != 0).collect();
        let room = (ui.available_width() / (WIDTH + LETTER + GRID)) as usize;
        if shown.len() <= room {
            for &component in shown.iter().rev() {
                self.value(ui, &key, component, about, requests);
            }
        } else if room > 0 {
            let touched = Some(about.component).filter(|component| shown.contains(component));
            self.value(ui, &key, touched.unwrap_or(shown[0]), about, requests);
        }
    }

    fn time(&mut self, ui: &mut Ui, key: &ValueKey, about: &FieldsContext<'_>, requests: &mut Vec<Request>) {
        let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, CONTROL), Sense::hover());
        let frame = f64::from(about.context.frame_seconds());
        let shown = key.time + self.by(KeyNumber::Time);
        let field = NumberField {
            name: "Time of the key",
            value: Some(f64::from(shown)),
            unit: "s",
            speed: frame * 0.2,
            snap: frame,
            grain: 1e-6,
            digits: Digits::Fixed(3),
            range: 0.0..=f64::from(LATEST),
            ..field(KeyNumber::Time)
        };
        let (event, _) = field.show(ui, rect);
        let snap = about.context.keys.snap() != ui.input(|input| input.modifiers.command);
        let event = match event {
            FieldEvent::Dragged(by) if snap => {
                FieldEvent::Dragged(f64::from(to_frame(key.time + by as f32, about.context) - key.time))
            }
            event => event,
        };
        match event {
            FieldEvent::Typed(value) => {
                requests.push(Request::Timeline(KeysRequest::Drag(KeyDragOp::Move(value as f32 - key.time))));
                requests.push(Request::Timeline(KeysRequest::Release));
            }
            event => self.drag(event, KeyNumber::Time, key, about, |by| Some(KeyDragOp::Move(by)), requests),
        }
    }

    fn value(
        &mut self,
        ui: &mut Ui,
        key: &ValueKey,
        component: usize,
        about: &FieldsContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let (rect, _) = ui.allocate_exact_size(vec2(LETTER + WIDTH, CONTROL), Sense::hover());
        let letter = component_name(component);
        let tone = color(Theme::of(ui), component);
        let at = pos2(rect.left(), rect.center().y);
        ui.painter().text(at, Align2::LEFT_CENTER, letter, FontId::proportional(11.0), tone);
        let rect = Rect::from_min_max(pos2(rect.left() + LETTER, rect.top()), rect.max);
        let angle = key.id.1 == Property::Rotation && key.form != RotationForm::Quaternion;
        let number = key.numbers[component];
        let shown = number + self.by(KeyNumber::Value(component));
        // Below a millionth of the numbers that are shown, a value is a rounding error.
        let dust = f64::from(shown.abs()) < about.window.span * 1e-6;
        let field = NumberField {
            name: &format!("Value {letter}"),
            value: Some(if dust { 0.0 } else { f64::from(shown) }),
            quantity: if angle { Quantity::Angle } else { Quantity::Number },
            unit: if angle { "°" } else { "" },
            // About as far as the curve moves on the screen.
            speed: about.window.span / 300.0,
            snap: if angle { 15.0 } else { 0.1 },
            grain: f64::from(number.abs()) * 1e-6 + 1e-7,
            digits: if angle { Digits::Fixed(2) } else { Digits::Fitting },
            ..field(KeyNumber::Value(component))
        };
        let (event, _) = field.show(ui, rect);
        let edit = |by: f32| value_edit(about.context.take_ref()?, &[*key], component, by);
        let by = match event {
            FieldEvent::Typed(value) => Some(value as f32 - number),
            FieldEvent::Dragged(by) => Some(by as f32),
            FieldEvent::Nothing | FieldEvent::Touched | FieldEvent::Released | FieldEvent::Cancelled => None,
        };
        if let Some(by) = by {
            requests.extend(given_angles(self.curve_before(key, about).as_slice(), &[*key], component, by));
        }
        match event {
            FieldEvent::Typed(value) => {
                let edit = edit(value as f32 - number);
                requests.extend(edit.map(|edit| Request::Change(Change::Edit(edit, None))));
            }
            event => self.drag(
                event,
                KeyNumber::Value(component),
                key,
                about,
                |by| edit(by).map(KeyDragOp::Edit),
                requests,
            ),
        }
    }

    /// Returns the curve of a key as it was when the drag began, or without a drag as it is.
    fn curve_before(&self, key: &ValueKey, about: &FieldsContext<'_>) -> Option<Arc<Curve>> {
        match &self.held {
            Some(held) => held.curve.clone(),
            None => about.curves.iter().find(|curve| curve.id == key.id).cloned(),
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
        key: &ValueKey,
        about: &FieldsContext<'_>,
        op: impl Fn(f32) -> Option<KeyDragOp>,
        requests: &mut Vec<Request>,
    ) {
        let request = match event {
            FieldEvent::Dragged(by) => {
                let by = by as f32;
                let curve = self.curve_before(key, about);
                self.held = Some(HeldField { part, key: *key, by, curve });
                op(by).map(KeysRequest::Drag)
            }
            FieldEvent::Released => self.held.take().map(|_| KeysRequest::Release),
            FieldEvent::Cancelled => self.held.take().map(|_| KeysRequest::Cancel),
            FieldEvent::Nothing | FieldEvent::Touched | FieldEvent::Typed(_) => None,
        };
        requests.extend(request.map(Request::Timeline));
    }
}

/// Returns the settings that all fields share.
fn field<'a>(part: KeyNumber) -> NumberField<'a> {
    NumberField {
        id: Id::unique(("number of the selected key", part)),
        name: "",
        value: None,
        quantity: Quantity::Number,
        unit: "",
        speed: 0.0,
        snap: 0.0,
        grain: 0.0,
        digits: Digits::Fitting,
        range: f64::from(f32::MIN)..=f64::from(f32::MAX),
        locked: None,
        help: "Of the selected key",
        quiet: false,
    }
}

/// Returns the selected key, if exactly one key of the shown curves is selected.
fn only_key(curves: &[Arc<Curve>], drawn: &Drawn) -> Option<ValueKey> {
    let mut found = None;
    for curve in curves {
        let chosen = drawn.selection.of(curve.id);
        if chosen.is_empty() {
            continue;
        }
        let keys = chosen.keys(curve.times()).next()?;
        if found.is_some() || keys.len() != 1 || chosen.stretches().len() > 1 {
            return None;
        }
        found = ValueKey::of(curve, keys.start);
    }
    found
}
