//! A question as it is drawn: its sentences, and its row of buttons.

use crate::panels::looked_folder::LookedFolder;
use crate::panels::request::Request;
use crate::panels::style::{GRID, RADIUS};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_document::View;
use dragonfly_store::folder_of;
use egui::{
    Button, CornerRadius, Frame, Key, Margin, Response, RichText, Stroke, TextEdit, TextStyle, Ui, vec2,
};
use std::ops::Range;
use std::path::PathBuf;

/// A question that is being drawn.
pub(super) struct Ask<'a> {
    pub(super) ui: &'a mut Ui,
    /// The newest view of the document.
    pub(super) view: Option<&'a View>,
    /// The folder that was looked at last.
    pub(super) looked_folder: Option<&'a LookedFolder>,
    /// Whether this is its first frame, in which the default button gets the focus.
    pub(super) fresh: bool,
    pub(super) requests: &'a mut Vec<Request>,
    pub(super) fields: &'a mut QuestionFields,
}

/// The path that the user typed in a question, and the line that the user chose.
#[derive(Debug, Default)]
pub(super) struct QuestionFields {
    pub(super) path: String,
    pub(super) chosen: usize,
    /// The folder of the path that is being looked at, or was.
    pub(super) asked: Option<PathBuf>,
}

/// The part of a path that is selected when its field is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathPart {
    /// None: the cursor is at the end.
    Nothing,
    /// The name of the file without its ending.
    Name,
}

/// Style of a button.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Tone {
    /// The default button, which Enter presses.
    First,
    Plain,
    /// The button of a choice that discards something, or moves it where it is hard to find.
    Loses,
}

impl Ask<'_> {
    pub(super) fn title(&mut self, text: &str) {
        self.ui.label(RichText::new(text).heading());
    }

    /// Draws a sentence.
    pub(super) fn says(&mut self, text: impl Into<String>) {
        self.ui.label(text.into());
    }

    /// Draws a secondary sentence.
    pub(super) fn adds(&mut self, text: impl Into<String>) {
        let weak = Theme::of(self.ui).weak;
        self.ui.label(RichText::new(text).color(weak));
    }

    /// Draws a warning.
    pub(super) fn warns(&mut self, text: impl Into<String>) {
        let warning = Theme::of(self.ui).warning;
        self.ui.label(RichText::new(text).color(warning));
    }

    /// Draws the row of buttons: those that discard something on the left, the others on the right with the default one
    /// last. Returns the one that was pressed.
    pub(super) fn buttons<T: Copy>(&mut self, choices: &[(&str, &str, Tone, T)]) -> Option<T> {
        self.ui.add_space(GRID);
        let mut pressed = None;
        let fresh = self.fresh;
        self.ui.horizontal(|ui| {
            for (title, help, tone, choice) in choices.iter().filter(|(_, _, tone, _)| *tone == Tone::Loses) {
                if button(ui, title, *tone, true).on_hover_text(*help).clicked() {
                    pressed = Some(*choice);
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let rest = choices.iter().filter(|(_, _, tone, _)| *tone != Tone::Loses);
                for (title, help, tone, choice) in rest {
                    let response = button(ui, title, *tone, true).on_hover_text(*help);
                    if fresh && *tone == Tone::First {
                        response.request_focus();
                    }
                    if response.clicked() {
                        pressed = Some(*choice);
                    }
                }
            });
        });
        pressed
    }

    /// Draws a field for a path, called `name` for screen readers, and the buttons `confirm` and `cancel`, each a title and its
    /// tooltip. `selected` is selected at first. Returns the path once it is confirmed; a cancel dismisses the question.
    pub(super) fn path(
        &mut self,
        name: &str,
        confirm: (&str, &str),
        cancel: (&str, &str),
        selected: PathPart,
    ) -> Option<PathBuf> {
        let entered = self.path_field(name, selected);
        self.path_buttons(confirm, cancel, entered)
    }

    /// Draws a field for a path, called `name` for screen readers; `selected` is selected at first. Returns whether Enter was pressed in it.
    pub(super) fn path_field(&mut self, name: &str, selected: PathPart) -> bool {
        let field = TextEdit::singleline(&mut self.fields.path)
            .desired_width(f32::INFINITY)
            .font(TextStyle::Monospace)
            .margin(Margin::symmetric(10, 7));
        let response = self.ui.add(field).accessible_name(name);
        if self.fresh {
            response.request_focus();
            match selected {
                PathPart::Nothing => {}
                // As in the dialogs of desktops: typing replaces the name, not the folder or the ending.
                PathPart::Name => {
                    widgets::select_characters(self.ui.ctx(), response.id, stem_of(&self.fields.path));
                }
            }
        }
        response.lost_focus() && self.ui.input(|input| input.key_pressed(Key::Enter))
    }

    /// Draws which folders a save at the typed path creates.
    pub(super) fn new_folders(&mut self) {
        let Some(path) = self.typed_path() else { return };
        let folder = folder_of(&path);
        if self.fields.asked.as_deref() != Some(folder) {
            self.fields.asked = Some(folder.to_path_buf());
            self.requests.push(Request::LookAtFolder(folder.to_path_buf()));
        } else if let Some(hint) = self.looked_folder.and_then(|looked| looked.hint(folder)) {
            self.adds(hint);
        }
    }

    /// Returns the path that was typed.
    fn typed_path(&self) -> Option<PathBuf> {
        let typed = self.fields.path.trim().trim_matches('"');
        (!typed.is_empty()).then(|| PathBuf::from(typed))
    }

    /// Draws the buttons `confirm` and `cancel` below a field for a path, each a title and its tooltip. Returns the path once it is confirmed, also
    /// by Enter in the field; a cancel dismisses the question.
    pub(super) fn path_buttons(
        &mut self,
        confirm: (&str, &str),
        cancel: (&str, &str),
        entered: bool,
    ) -> Option<PathBuf> {
        // The field has the focus, not the default button.
        let fresh = std::mem::replace(&mut self.fresh, false);
        let pressed = self
            .buttons(&[(confirm.0, confirm.1, Tone::First, true), (cancel.0, cancel.1, Tone::Plain, false)]);
        self.fresh = fresh;
        if let Some(path) = self.typed_path().filter(|_| entered || pressed == Some(true)) {
            return Some(path);
        }
        if pressed == Some(false) {
            self.requests.push(Request::Dismiss);
        }
        None
    }
}

/// Returns the characters of the name of a file in a path, without its ending.
fn stem_of(path: &str) -> Range<usize> {
    let start = path.rfind(['/', '\\']).map_or(0, |at| at + 1);
    let end = path[start..].rfind('.').filter(|&at| at > 0).map_or(path.len(), |at| start + at);
    path[..start].chars().count()..path[..end].chars().count()
}

/// Returns a frame for details in a question, with a line around it: in the light theme card and frame are both white.
pub(super) fn inset(theme: &Theme) -> Frame {
    Frame::NONE.fill(theme.sunken).stroke(Stroke::new(1.0, theme.line)).corner_radius(RADIUS)
}

/// Draws a button of a question.
pub(super) fn button(ui: &mut Ui, title: &str, tone: Tone, able: bool) -> Response {
    let theme = Theme::of(ui);
    let text = match tone {
        Tone::First => RichText::new(title).color(theme.on_accent),
        Tone::Plain => RichText::new(title),
        Tone::Loses => RichText::new(title).color(theme.error),
    };
    let mut button = Button::new(text).min_size(vec2(88.0, 28.0)).corner_radius(CornerRadius::same(RADIUS));
    if tone == Tone::First {
        button = button.fill(theme.accent);
    }
    let response = ui.add_enabled(able, button);
    widgets::focus_ring(ui, &response, response.rect.expand(2.0));
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_in_a_path_is_without_its_folder_and_its_ending() {
        for (path, stem) in [
            ("/models/Fox.glb", 8..11),
            ("Fox", 0..3),
            ("C:\\models.old\\Fox.v2.glb", 14..20),
            ("/models/.hidden", 8..15),
            ("/möbel/Stühle.glb", 7..13),
            ("/models/", 8..8),
            ("", 0..0),
        ] {
            assert_eq!(stem_of(path), stem, "{path}");
        }
    }
}
