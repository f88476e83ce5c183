//! Sliders that change the values of the selected keys: in-betweens, smoothing, noise.
//!
//! While a slider is dragged, the keys follow; the release makes one step of undo. A slider of an amount returns to its neutral
//! position then; one of a setting, such as a frequency, stays.

mod error;
mod row;
mod tool;

pub use tool::{ChosenKeys, InBetweenTool, TurnAxis};

use super::commands::{self, Id, When};
use super::context::PanelContext;
use super::keys::{KeyDragOp, KeysRequest};
use super::number_field::FieldEvent;
use super::request::Request;
use super::style::GRID;
use super::theme::Theme;
use super::{Panel, PanelPlace, widgets};
use dragonfly_anim::data::Take;
use egui::{Align, Button, Layout, Popup, RichText, ScrollArea, Ui};
use error::DragError;
use row::Row;
use std::sync::Arc;

/// The sliders, and the one that is dragged.
#[derive(Debug, Default)]
pub struct InBetween {
    /// Settings that were changed: of the tools that keep them.
    settings: Vec<(InBetweenTool, f64)>,
    held: Option<HeldSlider>,
    error: DragError,
    /// Number of drags so far: each gets other noise.
    drags: u32,
    /// The take toward which keys are blended, if one was chosen.
    other: Option<usize>,
    /// The axis of full turns between keys of the same rotation.
    axis: TurnAxis,
}

/// A slider that is dragged, and the keys that it changes.
#[derive(Clone, Debug)]
struct HeldSlider {
    tool: InBetweenTool,
    start: f64,
    value: f64,
    keys: ChosenKeys,
    /// The take when the drag began.
    before: Option<Arc<Take>>,
}

impl Panel for InBetween {
    fn id(&self) -> &'static str {
        "inbetween"
    }

    fn title(&self) -> &'static str {
        "In-between"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::BelowRight
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        if context.take().is_none() {
            let text = if context.view.is_none() {
                "Sliders for keys appear here"
            } else {
                "The rest pose does not move"
            };
            return widgets::empty(ui, text, "");
        }
        // The drag was cancelled from elsewhere.
        self.held.take_if(|_| !context.keys.is_dragging());
        ui.add_space(GRID);
        ui.horizontal(|ui| {
            ui.add_space(2.0 * GRID);
            let before = self.held.as_ref().and_then(|held| held.before.as_ref());
            let text = before.and_then(|before| self.error.text(before, context));
            let text = text.unwrap_or_else(|| heading(context));
            ui.label(RichText::new(text).small().color(Theme::of(ui).weak));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add_space(2.0 * GRID);
                self.choose_take(ui, context);
                self.choose_axis(ui);
            });
        });
        hold_feet(ui, context, requests);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            let width = ui.available_width();
            let columns = if width >= 2.0 * row::NARROWEST { 2 } else { 1 };
            let per_column = InBetweenTool::ALL.len().div_ceil(columns);
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = 0.0;
                for tools in InBetweenTool::ALL.chunks(per_column) {
                    ui.vertical(|ui| {
                        ui.set_width(width / columns as f32);
                        for &tool in tools {
                            self.row(ui, tool, context, requests);
                        }
                    });
                }
            });
        });
    }
}

/// Returns the take after the one that is shown; after the last one the first. `None` if there is no other.
pub(super) fn next_take(context: &PanelContext<'_>) -> Option<usize> {
    let (takes, shown) = (context.digest.takes.len(), context.playback.take?);
    (takes > 1).then(|| (shown + 1) % takes)
}

/// Returns what the sliders change, in a few words.
fn heading(context: &PanelContext<'_>) -> String {
    match context.take() {
        Some(take) if When::Keys.holds(context) => {
            widgets::count(context.keys.selection().count(take), "selected key", "selected keys")
        }
        Some(_) | None => format!("{}: select keys in the timeline or the curves", When::Keys.reason()),
    }
}

/// Draws the switch that lets smoothing hold feet, where the take has contacts.
fn hold_feet(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    if !context.can_hold_feet() {
        return;
    }
    ui.horizontal(|ui| {
        ui.add_space(2.0 * GRID);
        let mut on = context.keys.holds_feet();
        let text = RichText::new("Hold feet").small().color(Theme::of(ui).weak);
        let switch = ui.checkbox(&mut on, text);
        widgets::hint_beside(&switch, commands::tooltip(ui.ctx(), Id::ToggleHoldFeet));
        if switch.changed() {
            requests.push(Request::Command(Id::ToggleHoldFeet));
        }
    });
}

impl InBetween {
    fn row(
        &mut self,
        ui: &mut Ui,
        tool: InBetweenTool,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let value = match &self.held {
            Some(held) if held.tool == tool => held.value,
            Some(_) | None => self.setting(tool),
        };
        let locked = if !When::Keys.holds(context) {
            Some(When::Keys.reason())
        } else if tool == InBetweenTool::Take && self.other(context).is_none() {
            Some("The model has no other take")
        } else if tool == InBetweenTool::Pose && context.copied_pose.is_none() {
            Some("Copy a pose first: go to its frame and choose “Copy pose”")
        } else {
            None
        };
        let event = Row { tool, value, locked }.show(ui);
        self.apply(tool, event, context, requests);
    }

    /// Returns the take toward which keys are blended: the chosen one, or the next in the list.
    fn other(&self, context: &PanelContext<'_>) -> Option<usize> {
        let chosen = self.other.filter(|&take| take < context.digest.takes.len());
        chosen.filter(|&take| Some(take) != context.playback.take).or_else(|| next_take(context))
    }

    /// Draws the button that chooses the take toward which keys are blended.
    fn choose_take(&mut self, ui: &mut Ui, context: &PanelContext<'_>) {
        let Some(other) = self.other(context) else { return };
        let name = |take: usize| widgets::shortened(&context.digest.takes[take].name);
        let text = RichText::new(format!("To take: {}", name(other))).small().color(Theme::of(ui).weak);
        let button = ui.add(Button::new(text).frame(false).truncate());
        let button = button.on_hover_text("Other take\nThe take toward which “To take” moves keys");
        Popup::menu(&button).show(|ui| {
            ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
                for take in
                    (0..context.digest.takes.len()).filter(|&take| Some(take) != context.playback.take)
                {
                    if ui.add(Button::selectable(take == other, name(take))).clicked() {
                        self.other = Some(take);
                    }
                }
            });
        });
    }

    /// Draws the button that chooses the axis of full turns.
    fn choose_axis(&mut self, ui: &mut Ui) {
        let text = format!("Turn axis: {}", self.axis.name());
        let button = ui
            .add(Button::new(RichText::new(text).small().color(Theme::of(ui).weak)).frame(false).truncate());
        let button = button.on_hover_text(
            "Turn axis\nThe axis of the bone about which “Full turns” turns between keys of the same rotation",
        );
        Popup::menu(&button).show(|ui| {
            for axis in TurnAxis::ALL {
                if ui.add(Button::selectable(axis == self.axis, axis.name())).clicked() {
                    self.axis = axis;
                }
            }
        });
    }

    /// Returns the selected keys with the settings of the panel; `None` without any.
    fn chosen(&self, context: &PanelContext<'_>) -> Option<ChosenKeys> {
        ChosenKeys::of(context, self.drags, self.other(context)).map(|keys| keys.about(self.axis))
    }

    /// Returns the number at which a slider rests.
    fn setting(&self, tool: InBetweenTool) -> f64 {
        let set = self.settings.iter().find(|(other, _)| *other == tool);
        set.map_or(tool.neutral(), |(_, value)| *value)
    }

    /// Sets the number at which a slider rests, if it stays where it was released.
    fn keep(&mut self, tool: InBetweenTool, value: f64) {
        if tool.keeps_number() {
            self.settings.retain(|(other, _)| *other != tool);
            self.settings.push((tool, value));
        }
    }

    fn apply(
        &mut self,
        tool: InBetweenTool,
        event: FieldEvent,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let mut push = |request| requests.push(Request::Timeline(request));
        match event {
            FieldEvent::Nothing | FieldEvent::Touched | FieldEvent::Changed(_) => {}
            FieldEvent::Dragged(by) => {
                let start = self.held.as_ref().map_or_else(|| self.setting(tool), |held| held.start);
                if self.held.is_none() {
                    if by == 0.0 {
                        return;
                    }
                    self.drags += 1;
                    let Some(keys) = self.chosen(context) else { return };
                    let before = context.shared_take().cloned();
                    self.held = Some(HeldSlider { tool, start, value: start, keys, before });
                }
                let Some(held) = self.held.as_mut().filter(|held| held.tool == tool) else { return };
                held.value = tool.within(start + by);
                if let Some(edit) = tool.edit(held.value, &held.keys) {
                    push(KeysRequest::Drag(KeyDragOp::Edit(edit)));
                }
            }
            FieldEvent::Released => {
                if let Some(held) = self.held.take() {
                    let came_back = held.value == held.start;
                    push(if came_back { KeysRequest::Cancel } else { KeysRequest::Release });
                    self.keep(tool, held.value);
                }
            }
            FieldEvent::Cancelled => {
                if self.held.take().is_some() {
                    push(KeysRequest::Cancel);
                }
            }
            FieldEvent::Typed(value) if tool.changes_nothing(value) => {}
            FieldEvent::Typed(value) => {
                self.drags += 1;
                let Some(keys) = self.chosen(context) else { return };
                let Some(edit) = tool.edit(tool.within(value), &keys) else { return };
                push(KeysRequest::Drag(KeyDragOp::Edit(edit)));
                push(KeysRequest::Release);
                self.keep(tool, value);
            }
        }
    }
}
