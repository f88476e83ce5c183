//! The field that renames a take in its row.

use super::super::context::PanelContext;
use super::super::request::Request;
use super::super::style::RADIUS;
use super::super::theme::Theme;
use super::super::widgets;
use dragonfly_document::Change;
use dragonfly_document::adapter::take_name;
use dragonfly_document::edit::{Edit, RenameTake, TakeRef};
use dragonfly_document::text::sentence;
use egui::{CornerRadius, Frame, Id, Key, Margin, Modifiers, Rect, Stroke, StrokeKind, TextEdit, Ui};

/// Longest name that can be typed, in characters.
const LONGEST: usize = 10_000;

/// A name that is being typed.
#[derive(Debug, Default)]
pub(super) struct Rename {
    text: String,
    stage: RenameStage,
    /// Reason why the name is not accepted.
    refused: Option<String>,
}

/// State of the field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum RenameStage {
    #[default]
    Fresh,
    /// The focus is requested for the field.
    Asked,
    Typing,
}

impl Rename {
    /// Draws the field. Returns `false` when renaming is done.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        context: &PanelContext<'_>,
        index: usize,
        requests: &mut Vec<Request>,
    ) -> bool {
        let Some(view) = context.view else { return false };
        let Some(take) = view.takes.get(index) else { return false };
        let own = view.slots.get(index).map(|slot| slot.id);
        let id = Id::unique("name of a take");
        let has_focus = ui.memory(|memory| memory.has_focus(id));
        let first = self.stage == RenameStage::Fresh;
        if first {
            self.text.clone_from(&take.name);
            self.stage = RenameStage::Asked;
        } else if self.stage == RenameStage::Asked && has_focus {
            self.stage = RenameStage::Typing;
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
            .frame(Frame::NONE.inner_margin(Margin::symmetric(8, 0)))
            .align(egui::Align2::LEFT_CENTER)
            .char_limit(LONGEST)
            .desired_width(rect.width());
        let response = ui.place(rect, field).accessible_name("Name of the take");
        if first {
            response.request_focus();
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
        // The present name is always allowed.
        let changed = self.text != take.name;
        let fits = if changed { take_name(&view.slots, &self.text, own) } else { Ok(()) };
        if enter && let Err(reason) = &fits {
            self.refused = Some(sentence(&reason.to_string()));
            return true;
        }
        let left = !first && !response.has_focus();
        // A name that is not accepted is refused by the document, which reports the reason.
        if (enter || left) && !escape && changed {
            let edit = Edit::RenameTake(RenameTake {
                take: TakeRef::Index(index),
                name: std::mem::take(&mut self.text),
            });
            requests.push(Request::Change(Change::Edit(edit, None)));
        }
        !(enter || left || escape)
    }
}
