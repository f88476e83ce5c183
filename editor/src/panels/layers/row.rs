//! A row of the list: color, name, what the layer does, and its weight.

use super::{HEIGHT, Layers};
use crate::control::expression::Quantity;
use crate::panels::actions::layers::unchanged;
use crate::panels::context::PanelContext;
use crate::panels::keys::{KeyDragOp, KeysRequest};
use crate::panels::name_field::{INDENT, NameField, NameFieldEnd};
use crate::panels::number_field::{FieldEvent, NumberField};
use crate::panels::number_slider::{NumberSlider, SliderScale};
use crate::panels::number_text::Digits;
use crate::panels::request::Request;
use crate::panels::style::{GRID, RADIUS, ROW};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::layers::{LayerMode, LayerSettings};
use dragonfly_document::Change;
use dragonfly_document::adapter::TakeId;
use dragonfly_document::edit::{Edit, KeyLayerWeight, SetLayer, TakeRef};
use egui::accesskit::Role;
use egui::{
    Align2, Color32, CornerRadius, FontId, Id, Rect, Response, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2,
};

/// Width of the buttons for mute and solo, points.
const SWITCH: f32 = 20.0;
/// Width of the number of the weight, points.
const NUMBER: f32 = 56.0;
/// Largest weight that the slider reaches; more can be typed.
const SLIDER: f64 = 1.0;

/// A layer as its row shows it.
pub(super) struct LayerRow<'a> {
    index: usize,
    id: TakeId,
    settings: &'a LayerSettings,
    keys: usize,
    is_active: bool,
    /// Weight at the time shown.
    weight: f64,
}

impl<'a> LayerRow<'a> {
    /// Returns the row of a layer that the take has.
    pub(super) fn of(context: &PanelContext<'a>, index: usize) -> Self {
        let layer = &context.layers()[index];
        Self {
            index,
            id: layer.keys.id,
            settings: &layer.settings,
            keys: layer.keys.result.keys(),
            is_active: context.layer() == Some(index),
            weight: f64::from(layer.settings.weight_at(context.time())),
        }
    }

    /// Draws the row. Returns the response of its upper line.
    pub(super) fn show(
        self,
        ui: &mut Ui,
        panel: &mut Layers,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) -> Response {
        let theme = Theme::of(ui);
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::click());
        let name = &self.settings.name;
        response.widget_info(|| WidgetInfo::selected(Role::ListItem, ui.is_enabled(), self.is_active, name));
        let inside = rect.shrink2(vec2(GRID, 1.0));
        let fill = match () {
            () if self.is_active => theme.accent_soft,
            () if response.hovered() => theme.hover,
            () => Color32::TRANSPARENT,
        };
        ui.painter().rect_filled(inside, CornerRadius::same(RADIUS), fill);
        widgets::focus_ring(ui, &response, inside);
        let [red, green, blue] = self.settings.color;
        let bar =
            Rect::from_min_max(inside.min + vec2(2.0, 4.0), pos2(inside.left() + 5.0, inside.bottom() - 4.0));
        ui.painter().rect_filled(bar, CornerRadius::same(1), Color32::from_rgb(red, green, blue));
        let line = Rect::from_min_max(rect.min, pos2(rect.right(), rect.top() + ROW));
        self.name(ui, line, panel, context, requests);
        self.switches(ui, line, context, requests);
        let lower =
            Rect::from_min_max(pos2(rect.left() + 18.0, line.bottom() - 3.0), rect.max - vec2(10.0, 3.0));
        self.weight(ui, lower, context, requests);
        if response.clicked() || response.secondary_clicked() {
            requests.push(Request::ChooseLayer(Some(self.id)));
        }
        if response.double_clicked() {
            panel.renaming = Some((self.id, NameField::of(name)));
        }
        response.on_hover_text(self.about(context))
    }

    /// Returns the tooltip.
    fn about(&self, context: &PanelContext<'_>) -> String {
        let kind = match self.settings.mode {
            LayerMode::Additive => "offsets over the take",
            LayerMode::Override => "poses in place of those of the take",
        };
        let bones = match &self.settings.bones {
            None => "all bones".to_owned(),
            Some(bones) => match bones[..] {
                [bone] => context.bone_name(bone),
                _ => widgets::count(bones.len(), "bone", "bones"),
            },
        };
        let parts = [kind.to_owned(), widgets::count(self.keys, "key", "keys"), bones];
        format!("{}\n{}", widgets::shortened(&self.settings.name), widgets::dot_separated(&parts))
    }

    fn name(
        &self,
        ui: &mut Ui,
        line: Rect,
        panel: &mut Layers,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let theme = Theme::of(ui);
        let place = Rect::from_min_max(
            pos2(line.left() + 18.0, line.top()),
            pos2(line.right() - 2.0 * SWITCH - 14.0, line.bottom()),
        );
        if let Some((_, field)) = panel.renaming.as_mut().filter(|(id, _)| *id == self.id) {
            let rect = Rect::from_min_max(
                pos2(place.left() - INDENT, place.top() + 1.0),
                pos2(place.right(), place.bottom() - 1.0),
            );
            let end = field.show(ui, rect, "Name of the layer", TextStyle::Body);
            let name =
                Some(field.text()).filter(|name| *name != self.settings.name && !name.trim().is_empty());
            let name = name.map(str::to_owned);
            match end {
                NameFieldEnd::Open => return,
                NameFieldEnd::Entered | NameFieldEnd::Left if name.is_some() => {
                    self.set(context, requests, |take| SetLayer { name, ..unchanged(take) });
                }
                NameFieldEnd::Entered | NameFieldEnd::Left | NameFieldEnd::GivenUp => {}
            }
            panel.renaming = None;
            return;
        }
        let color = match () {
            () if self.settings.is_muted => theme.faint,
            () if self.is_active => theme.accent,
            () => theme.text,
        };
        let mark = match self.settings.mode {
            LayerMode::Additive => "+ ",
            LayerMode::Override => "= ",
        };
        let text = format!("{mark}{}", self.settings.name);
        widgets::text_in(ui, place, &text, &TextStyle::Body, color);
    }

    /// Draws the letters that mute the layer and make it solo.
    fn switches(&self, ui: &mut Ui, line: Rect, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let theme = Theme::of(ui);
        let switches = [
            ("M", "Mute", "Mute: the layer does nothing", self.settings.is_muted, theme.warning),
            (
                "S",
                "Solo",
                "Solo: only this layer, and others that are solo, over the take",
                self.settings.is_solo,
                theme.accent,
            ),
        ];
        for (place, (letter, name, help, is_on, color)) in switches.into_iter().enumerate() {
            let left = line.right() - 10.0 - (2 - place) as f32 * SWITCH;
            let rect = Rect::from_min_size(pos2(left, line.top()), vec2(SWITCH, line.height()));
            let response = ui.interact(rect, ui.scope_id().with((self.id, letter)), Sense::click());
            let title = format!("{name} {}", self.settings.name);
            response
                .widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), is_on, title.as_str()));
            if is_on || response.hovered() {
                let fill = if is_on { color.gamma_multiply(0.25) } else { theme.hover };
                ui.painter().rect_filled(rect.shrink(2.0), CornerRadius::same(RADIUS), fill);
            }
            let color = if is_on { color } else { theme.weak };
            ui.painter().text(
                rect.center(),
                Align2::CENTER_CENTER,
                letter,
                FontId::proportional(11.0),
                color,
            );
            if response.on_hover_text(help).clicked() {
                self.set(context, requests, |take| match letter {
                    "M" => SetLayer { muted: Some(!is_on), ..unchanged(take) },
                    _ => SetLayer { solo: Some(!is_on), ..unchanged(take) },
                });
            }
        }
    }

    fn weight(&self, ui: &mut Ui, rect: Rect, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let theme = Theme::of(ui);
        let number = Rect::from_min_max(pos2(rect.right() - NUMBER, rect.top()), rect.max);
        let line = Rect::from_min_max(rect.min, pos2(number.left() - 2.0 * GRID, rect.bottom()));
        let name = format!("Weight of {}", self.settings.name);
        let slider = NumberSlider {
            id: Id::unique(("weight of a layer", self.id)),
            name: &format!("{name}, slider"),
            value: Some(self.weight),
            scale: SliderScale::Upward(SLIDER),
            snap: 0.1,
            color: if self.settings.is_muted { theme.faint } else { theme.accent },
            enabled: true,
        };
        let by_slider = if line.width() > 24.0 { slider.show(ui, line) } else { FieldEvent::Nothing };
        let is_keyed = !self.settings.weights.is_empty();
        let field = NumberField {
            id: Id::unique(("weight of a layer, number", self.id)),
            name: &name,
            value: Some(self.weight),
            quantity: Quantity::Number,
            unit: "",
            speed: 0.01,
            snap: 0.1,
            grain: 1e-9,
            digits: Digits::Fixed(2),
            range: 0.0..=10.0,
            locked: None,
            help: if is_keyed {
                "Weight of the layer, which has keys: a key is set at the playhead"
            } else {
                "Weight of the layer at all times"
            },
            quiet: self.weight == 1.0,
            relative: false,
        };
        let (by_number, _) = field.show(ui, number);
        let event = if by_number == FieldEvent::Nothing { by_slider } else { by_number };
        let mut push = |request| requests.push(Request::Timeline(request));
        match event {
            FieldEvent::Nothing | FieldEvent::Touched | FieldEvent::Changed(_) => {}
            FieldEvent::Dragged(by) => {
                let start = ui.data_mut(|data| *data.get_temp_mut_or(self.drag(), self.weight));
                if let Some(edit) = self.weight_edit(context, start + by) {
                    push(KeysRequest::Drag(KeyDragOp::Edit(edit)));
                }
            }
            FieldEvent::Released => {
                ui.data_mut(|data| data.remove::<f64>(self.drag()));
                push(KeysRequest::Release);
            }
            FieldEvent::Cancelled => {
                ui.data_mut(|data| data.remove::<f64>(self.drag()));
                push(KeysRequest::Cancel);
            }
            FieldEvent::Typed(weight) => {
                if let Some(edit) = self.weight_edit(context, weight) {
                    requests.push(Request::Change(Change::Edit(edit, None)));
                }
            }
        }
    }

    /// Returns the place where the weight at the start of a drag is kept.
    fn drag(&self) -> Id {
        Id::unique(("weight when its drag began", self.id))
    }

    /// Returns the edit that gives the layer a weight: at the time shown if the weight has keys, else at all times.
    fn weight_edit(&self, context: &PanelContext<'_>, weight: f64) -> Option<Edit> {
        let (take, weight) = (context.layer_ref(self.index)?, Some((weight.max(0.0) as f32).min(10.0)));
        Some(if self.settings.weights.is_empty() {
            Edit::SetLayer(SetLayer { weight, ..unchanged(take) })
        } else {
            Edit::KeyLayerWeight(KeyLayerWeight { take, time: context.time(), weight })
        })
    }

    fn set(
        &self,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
        edit: impl FnOnce(TakeRef) -> SetLayer,
    ) {
        if let Some(take) = context.layer_ref(self.index) {
            requests.push(Request::Change(Change::Edit(Edit::SetLayer(edit(take)), None)));
        }
    }
}
