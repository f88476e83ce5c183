//! The field in which a name is typed, in place of the row of a list or over a lane.

use super::style::RADIUS;
use super::theme::Theme;
use super::widgets;
use egui::{
    CornerRadius, Frame, Id, Key, Margin, Modifiers, Rect, Stroke, StrokeKind, TextEdit, TextStyle, Ui,
};

/// Longest name that can be typed, in characters.
const LONGEST: usize = 10_000;

/// Distance of the text from the left end of the field, points.
pub(super) const INDENT: f32 = 8.0;

/// A name that is being typed.
#[derive(Clone, Debug)]
pub(super) struct NameField {
    text: String,
    stage: NameFieldStage,
    /// Reason why the name is not accepted.
    refused: Option<String>,
}

/// State of the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum NameFieldStage {
    Fresh,
    /// The focus is requested for the field.
    Asked,
    Typing,
}

/// State of a field after a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NameFieldEnd {
    /// The name is still typed.
    Open,
    /// Enter was pressed.
    Entered,
    /// The focus went elsewhere.
    Left,
    /// Escape was pressed.
    GivenUp,
}

impl NameField {
    /// Returns a field with a name, which is selected as soon as the field has the focus.
    pub(super) fn of(name: &str) -> Self {
        Self { text: name.to_owned(), stage: NameFieldStage::Fresh, refused: None }
    }

    /// Returns the name as it is typed.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Shows the reason why the name is not accepted, until it is changed.
    pub(super) fn refuse(&mut self, reason: String) {
        self.refused = Some(reason);
    }

    /// Draws the field; `label` is its accessible name, and at most one field of each label is shown. It takes the focus.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        label: &'static str,
        style: TextStyle,
    ) -> NameFieldEnd {
        let id = Id::unique(label);
        let has_focus = ui.memory(|memory| memory.has_focus(id));
        let is_fresh = self.stage == NameFieldStage::Fresh;
        if is_fresh {
            self.stage = NameFieldStage::Asked;
        } else if self.stage == NameFieldStage::Asked && has_focus {
            self.stage = NameFieldStage::Typing;
            // Typing replaces the old name.
            widgets::select_all(ui.ctx(), id, &self.text);
        }
        let (enter, escape) = ui.input_mut(|input| {
            let enter = has_focus && input.consume_key(Modifiers::NONE, Key::Enter);
            (enter, input.key_pressed(Key::Escape))
        });
        let theme = Theme::of(ui);
        ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), theme.sunken);
        let field = TextEdit::singleline(&mut self.text)
            .id(id)
            .font(style)
            .frame(Frame::NONE.inner_margin(Margin::symmetric(INDENT as i8, 0)))
            .align(egui::Align2::LEFT_CENTER)
            .char_limit(LONGEST)
            .desired_width(rect.width());
        let response = ui.place(rect, field).accessible_name(label);
        if is_fresh {
            response.request_focus();
        }
        // A drag that begins elsewhere ends the field as a click does.
        let is_left = !is_fresh
            && ui.input(|input| {
                let at = input.pointer.interact_pos().filter(|_| input.pointer.any_pressed());
                at.is_some_and(|at| !rect.contains(at))
            });
        if is_left {
            response.surrender_focus();
        }
        if response.changed() {
            self.refused = None;
        }
        let edge = if self.refused.is_some() { theme.error } else { theme.accent };
        let edge = Stroke::new(1.0, edge);
        ui.painter().rect_stroke(rect, CornerRadius::same(RADIUS), edge, StrokeKind::Inside);
        if let Some(reason) = &self.refused {
            let anchor = response.rect;
            egui::Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), id.with("hint"), anchor)
                .show(|ui| ui.colored_label(theme.error, reason));
        }
        match () {
            () if escape => NameFieldEnd::GivenUp,
            () if enter => NameFieldEnd::Entered,
            () if is_left || !is_fresh && !response.has_focus() => NameFieldEnd::Left,
            () => NameFieldEnd::Open,
        }
    }
}
