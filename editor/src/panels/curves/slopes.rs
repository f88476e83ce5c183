//! Number fields for the tangents of the selected keys: slopes before and after them.

use super::canvas::component_name;
use super::curve::Curve;
use super::form::RotationForm;
use super::id::CurveId;
use super::key_numbers::{KeyNumbers, KeySlopes, MOST_SLOPES, selected, with};
use super::paint::color;
use super::values::ValueChange;
use crate::control::expression::Quantity;
use crate::panels::command_button::text_button;
use crate::panels::commands::Id as CommandId;
use crate::panels::context::PanelContext;
use crate::panels::keys::{Drawn, KeyDragOp, KeysRequest};
use crate::panels::number_field::{FieldEvent, NumberField, RelativeNumber};
use crate::panels::number_text::Digits;
use crate::panels::request::Request;
use crate::panels::style::{CONTROL, GRID};
use crate::panels::theme::Theme;
use dragonfly_document::edit::{
    BoneRef, Edit, MeshRef, SetManyTangents, SetShapeKeys, ShapeKeyAt, ShapeRef, TakeRef, TangentsAt,
};
use egui::{
    Align2, Button, FontId, Id, Popup, PopupCloseBehavior, RichText, Sense, TextStyle, Ui, pos2, vec2,
};
use std::sync::Arc;

/// The side of a key on which a field edits the slope.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum KeySide {
    Both,
    Before,
    After,
}

/// The slope that a field edits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct SlopeField {
    side: KeySide,
    component: usize,
}

/// A slope that is dragged: the keys as they were, and the distance from there.
#[derive(Clone, Debug)]
struct HeldSlope {
    field: SlopeField,
    keys: Vec<(Arc<Curve>, usize)>,
    slopes: KeySlopes,
    by: f32,
}

/// The fields, with the one that is dragged.
#[derive(Debug, Default)]
pub(super) struct SlopeFields {
    held: Option<HeldSlope>,
}

/// Width of a field.
const WIDTH: f32 = 92.0;
/// Width of the names of the rows.
const NAME: f32 = 48.0;

impl SlopeFields {
    /// Draws the button that opens the fields, if keys of splines are selected.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        numbers: Option<&KeyNumbers>,
        curves: &[Arc<Curve>],
        drawn: &Drawn,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        self.held.take_if(|held| held.by != 0.0 && !context.keys.drag().is_some_and(|drag| drag.held()));
        let Some(numbers) = numbers.filter(|numbers| numbers.splines) else { return };
        let text = RichText::new("Slopes").small().color(Theme::of(ui).weak);
        let button = ui.add(Button::new(text).frame(false));
        let button = button.on_hover_text("Slopes\nThe tangents of the selected keys as numbers");
        Popup::menu(&button).close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
            let Some(now) = KeySlopes::of(curves, drawn) else { return };
            let slopes = self.held.as_ref().map_or(now, |held| held.slopes);
            ui.spacing_mut().item_spacing = vec2(GRID, 2.0);
            for side in [KeySide::Both, KeySide::Before, KeySide::After] {
                ui.horizontal(|ui| {
                    let (rect, _) = ui.allocate_exact_size(vec2(NAME, CONTROL), Sense::hover());
                    let theme = Theme::of(ui);
                    crate::panels::widgets::text_in(ui, rect, side.name(), &TextStyle::Body, theme.text);
                    for component in 0..numbers.first.width() {
                        let field = SlopeField { side, component };
                        self.field(ui, field, numbers, &slopes, (curves, drawn, context), requests);
                    }
                });
            }
            ui.horizontal_wrapped(|ui| {
                for id in [
                    CommandId::TangentsUnified,
                    CommandId::TangentsAuto,
                    CommandId::TangentsClamped,
                    CommandId::TangentsFlat,
                    CommandId::TangentsLinear,
                ] {
                    text_button(ui, id, requests);
                }
            });
        });
    }

    fn field(
        &mut self,
        ui: &mut Ui,
        of: SlopeField,
        numbers: &KeyNumbers,
        slopes: &KeySlopes,
        (curves, drawn, context): (&[Arc<Curve>], &Drawn, &PanelContext<'_>),
        requests: &mut Vec<Request>,
    ) {
        let SlopeField { side, component } = of;
        let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, CONTROL), Sense::hover());
        let letter = if numbers.first.id.is_shape() { "" } else { component_name(component) };
        let tone = color(Theme::of(ui), component);
        let at = pos2(rect.left(), rect.center().y);
        ui.painter().text(at, Align2::LEFT_CENTER, letter, FontId::proportional(11.0), tone);
        let mut place = rect;
        place.min.x += 12.0;
        let key = &numbers.first;
        let angle = key.id.is_rotation() && key.form != RotationForm::Quaternion;
        let [before, after] = slopes.slopes.map(|side| side[component]);
        let shared = match side {
            KeySide::Both => slopes.both(component),
            KeySide::Before => before,
            KeySide::After => after,
        };
        let by = self.held.as_ref().filter(|held| held.field == of).map_or(0.0, |held| held.by);
        let field = NumberField {
            id: Id::unique(("slope of the selected keys", of)),
            name: &format!("Slope {} {letter}", side.name().to_lowercase()),
            value: shared.map(|slope| f64::from(slope + by)),
            quantity: if angle { Quantity::Angle } else { Quantity::Number },
            unit: if angle { "°/s" } else { "/s" },
            speed: if angle { 1.0 } else { 0.01 },
            snap: if angle { 15.0 } else { 0.1 },
            grain: 1e-4,
            digits: if angle { Digits::Fixed(1) } else { Digits::Fitting },
            range: -1e6..=1e6,
            locked: (numbers.count > MOST_SLOPES).then_some("At most 2,000 keys can be given slopes at once"),
            help: side.help(),
            quiet: false,
            relative: true,
        };
        let (event, _) = field.show(ui, place);
        let change = match event {
            FieldEvent::Typed(value) => Some(ValueChange::Set(value as f32)),
            FieldEvent::Changed(RelativeNumber::Add(by)) => Some(ValueChange::Add(by as f32)),
            FieldEvent::Changed(RelativeNumber::Multiply(by)) => Some(ValueChange::Multiply(by as f32)),
            FieldEvent::Dragged(by) => {
                let keys = || selected(curves, drawn).map(|(curve, key)| (Arc::clone(curve), key)).collect();
                let held = || HeldSlope { field: of, keys: keys(), slopes: *slopes, by: 0.0 };
                self.held.get_or_insert_with(held).by = by as f32;
                Some(ValueChange::Add(by as f32))
            }
            FieldEvent::Released => {
                requests.extend(self.held.take().map(|_| Request::Timeline(KeysRequest::Release)));
                None
            }
            FieldEvent::Cancelled => {
                requests.extend(self.held.take().map(|_| Request::Timeline(KeysRequest::Cancel)));
                None
            }
            FieldEvent::Nothing | FieldEvent::Touched => None,
        };
        let (Some(change), Some(take)) = (change, context.take_ref()) else { return };
        let edit = match &self.held {
            Some(held) => slope_edit(take, held.keys.iter().map(|(curve, key)| (curve, *key)), of, change),
            None => slope_edit(take, selected(curves, drawn), of, change),
        };
        let Some(edit) = edit else { return };
        requests.push(Request::Timeline(KeysRequest::Drag(KeyDragOp::Edit(edit))));
        if self.held.is_none() {
            requests.push(Request::Timeline(KeysRequest::Release));
        }
    }
}

impl KeySide {
    fn name(self) -> &'static str {
        match self {
            Self::Both => "Both",
            Self::Before => "Before",
            Self::After => "After",
        }
    }

    fn help(self) -> &'static str {
        match self {
            Self::Both => "Slope of the selected keys, the same before and after them",
            Self::Before => {
                "Slope before the selected keys; the slope after them stays, so that tangents break"
            }
            Self::After => {
                "Slope after the selected keys; the slope before them stays, so that tangents break"
            }
        }
    }
}

/// Returns the edit that changes a slope of keys; `None` if none of them is of a spline.
fn slope_edit<'a>(
    take: TakeRef,
    keys: impl Iterator<Item = (&'a Arc<Curve>, usize)>,
    SlopeField { side, component }: SlopeField,
    change: ValueChange,
) -> Option<Edit> {
    let (mut bones, mut shapes) = (Vec::new(), Vec::new());
    for (curve, key) in keys {
        if curve.id.is_shape() {
            shapes.extend(shape_slope(curve, key, side, change));
        } else {
            bones.extend(bone_slope(curve, key, (side, component), change));
        }
    }
    if !shapes.is_empty() {
        return Some(Edit::SetShapeKeys(SetShapeKeys { take, keys: shapes }));
    }
    (!bones.is_empty()).then_some(Edit::SetManyTangents(SetManyTangents { take, at: bones }))
}

/// Returns a key of a shape key with a new slope.
fn shape_slope(curve: &Curve, key: usize, side: KeySide, change: ValueChange) -> Option<ShapeKeyAt> {
    let CurveId::Shape { instance, shape } = curve.id else { return None };
    let slopes = curve.slopes(key)?;
    let slope = |slopes: [f32; 4]| change.of(slopes[0]).clamp(-1e6, 1e6);
    Some(ShapeKeyAt {
        time: *curve.times().get(key)?,
        mesh: Some(MeshRef::Index(instance)),
        shape: ShapeRef::Index(shape),
        weight: None,
        arrive: (side != KeySide::After).then(|| slope(slopes.arrive)),
        leave: (side != KeySide::Before).then(|| slope(slopes.leave)),
    })
}

/// Returns a key of a bone with a new slope of one component.
fn bone_slope(
    curve: &Curve,
    key: usize,
    (side, component): (KeySide, usize),
    change: ValueChange,
) -> Option<TangentsAt> {
    let slopes = curve.slopes(key)?;
    let tangent = |arrive: bool, slopes: [f32; 4]| {
        let slope = change.of(slopes[component]).clamp(-1e6, 1e6);
        curve.tangent(key, arrive, with(slopes, component, slope))
    };
    let (bone, property) = curve.id.channel()?;
    Some(TangentsAt {
        time: *curve.times().get(key)?,
        bone: BoneRef::Index(bone),
        property,
        arrive: if side == KeySide::After { None } else { Some(tangent(true, slopes.arrive)?) },
        leave: if side == KeySide::Before { None } else { Some(tangent(false, slopes.leave)?) },
    })
}
