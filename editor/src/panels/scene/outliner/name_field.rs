//! The field that renames a thing in its row.

use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::scene::{SceneBase, SceneRequest, ScriptChange};
use crate::panels::style::{RADIUS, ROW};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::stage::splice::rename;
use egui::{
    CornerRadius, Frame, Id, Key, Margin, Modifiers, Rect, Stroke, StrokeKind, TextEdit, Ui, pos2, vec2,
};

/// A name that is being typed.
#[derive(Debug, Default)]
pub(super) struct NameField {
    /// The thing, and its new name.
    typed: Option<(Box<str>, String)>,
    /// Whether the field had the focus.
    had_focus: bool,
}

impl NameField {
    /// Draws the field in place of the row of a thing.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        thing: &str,
        requests: &mut Vec<Request>,
    ) {
        let id = Id::unique("name of a thing");
        let is_new = self.typed.as_ref().is_none_or(|(of, _)| **of != *thing);
        if is_new {
            (self.typed, self.had_focus) = (Some((thing.into(), thing.to_owned())), false);
        }
        let Some((_, text)) = &mut self.typed else { return };
        let has_focus = ui.memory(|memory| memory.has_focus(id));
        let enter = has_focus && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
        let escape = ui.input(|input| input.key_pressed(Key::Escape));
        let theme = Theme::of(ui);
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), egui::Sense::hover());
        let rect = Rect::from_min_max(
            pos2(rect.left() + 30.0, rect.top() + 1.0),
            pos2(rect.right() - 8.0, rect.bottom() - 1.0),
        );
        ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), theme.sunken);
        let field = TextEdit::singleline(text)
            .id(id)
            .frame(Frame::NONE.inner_margin(Margin::symmetric(6, 0)))
            .align(egui::Align2::LEFT_CENTER)
            .char_limit(200)
            .desired_width(rect.width());
        let response = ui.place(rect, field).accessible_name("Name of the thing");
        ui.painter().rect_stroke(
            rect,
            CornerRadius::same(RADIUS),
            Stroke::new(1.0, theme.accent),
            StrokeKind::Inside,
        );
        if is_new {
            response.request_focus();
        } else if has_focus && !self.had_focus {
            self.had_focus = true;
            widgets::select_all(ui.ctx(), id, text);
        }
        let left = self.had_focus && !response.has_focus();
        if !(enter || left || escape) {
            return;
        }
        if !escape && **text != *thing {
            requests.push(Request::Scene(renamed(context, thing, text)));
        }
        self.typed = None;
        requests.push(Request::Scene(SceneRequest::Rename(None)));
    }
}

/// Whether a field still has the keyboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FieldEnd {
    /// The name is still typed.
    Open,
    /// Enter was pressed, or the field was left.
    Kept,
    /// Escape was pressed.
    GivenUp,
}

/// Draws a field for a name in place of a row. It has the keyboard until it is left.
pub(super) fn typed_name(ui: &mut Ui, label: &str, text: &mut String) -> FieldEnd {
    let id = Id::unique(label);
    let had_focus = ui.memory(|memory| memory.has_focus(id));
    let enter = had_focus && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
    let escape = ui.input(|input| input.key_pressed(Key::Escape));
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), egui::Sense::hover());
    let rect = Rect::from_min_max(
        pos2(rect.left() + 30.0, rect.top() + 1.0),
        pos2(rect.right() - 8.0, rect.bottom() - 1.0),
    );
    ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), Theme::of(ui).sunken);
    let field = TextEdit::singleline(text)
        .id(id)
        .frame(Frame::NONE.inner_margin(Margin::symmetric(6, 0)))
        .align(egui::Align2::LEFT_CENTER)
        .char_limit(200)
        .desired_width(rect.width());
    let response = ui.place(rect, field).accessible_name(label);
    if !had_focus && !response.lost_focus() {
        response.request_focus();
    }
    match () {
        () if escape => FieldEnd::GivenUp,
        () if enter || response.lost_focus() => FieldEnd::Kept,
        () => FieldEnd::Open,
    }
}

/// Returns the request that gives a thing another name, wherever it is used.
fn renamed(context: &PanelContext<'_>, thing: &str, name: &str) -> SceneRequest {
    let Some(scene) = context.scene() else { return SceneRequest::Rename(None) };
    let base = match SceneBase::of(scene, context.scene_editing.text(scene)) {
        Ok(base) => base,
        Err(refusal) => return SceneRequest::Refused(refusal.to_string()),
    };
    let tree = base.script.tree();
    match base.script.thing_element(thing).and_then(|element| rename(tree, element, name)) {
        Some(splices) => SceneRequest::Text(ScriptChange {
            from: std::sync::Arc::clone(tree.text()),
            text: splices.apply(tree.text()),
            label: "Rename",
            gesture: None,
        }),
        None => SceneRequest::Refused(format!(
            "\"{name}\" cannot be a name here: it is used already, or has other characters than letters, digits, _ and -"
        )),
    }
}
