//! The field that finds a text in the script: all its places, the next one, the one before.

use super::lines::byte_of;
use super::text_choice::ShownText;
use crate::panels::icons::Icon;
use crate::panels::style::{self, GRID};
use crate::panels::theme::Theme;
use crate::panels::widgets::{icon_button, select_all};
use egui::text::CCursor;
use egui::text_edit::{TextEditOutput, TextEditState};
use egui::{Align, Id, Key, Layout, Rect, RichText, TextEdit, Ui, UiBuilder};
use std::ops::Range;

/// Height of the bar, points.
pub(super) const HEIGHT: f32 = 32.0;
/// Width of the field, points.
const FIELD: f32 = 190.0;
/// Largest number of places that are marked.
const MOST_MARKED: usize = 2_000;

/// Returns the id of the field.
fn field_id() -> Id {
    Id::unique("find in the script")
}

/// Returns whether the user types in the script, or looks for something in it.
pub(in crate::panels::scene) fn has_focus(ui: &Ui) -> bool {
    let fields = [ShownText::Script.field(), ShownText::Project.field(), field_id()];
    ui.memory(|memory| memory.focused()).is_some_and(|focused| fields.contains(&focused))
}

/// The search in the text.
#[derive(Debug, Default)]
pub(super) struct ScriptFind {
    is_open: bool,
    takes_focus: bool,
    query: String,
    /// The text and the query that the places are of.
    of: (String, String),
    /// First byte of each place.
    places: Vec<usize>,
    /// Position of the place that is shown, among the places.
    at: usize,
}

/// An outcome of the bar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum FindEvent {
    /// Went to a place.
    Show(Range<usize>),
    /// Closed the bar, at this byte.
    Close(Option<usize>),
}

impl ScriptFind {
    /// Opens the bar and puts the cursor into its field.
    pub(super) fn open(&mut self) {
        (self.is_open, self.takes_focus) = (true, true);
    }

    /// Returns whether the bar is shown.
    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Draws the bar. `edited` is the field of the text: a new query is found from its cursor on.
    pub(super) fn show(&mut self, ui: &mut Ui, rect: Rect, text: &str, edited: Id) -> Option<FindEvent> {
        let caret = TextEditState::load(ui.ctx(), edited).and_then(|state| state.cursor.char_range());
        let caret = caret.map_or(0, |range| byte_of(text, range.primary.index.0));
        let layout = Layout::left_to_right(Align::Center);
        let inside = rect.shrink2(egui::vec2(2.0 * GRID, GRID));
        let mut ui = ui.new_child(UiBuilder::new().max_rect(inside).layout(layout).id_salt("find"));
        let ui = &mut ui;
        ui.spacing_mut().item_spacing.x = GRID;
        let width = FIELD.min(ui.available_width() - 110.0).max(40.0);
        let field =
            TextEdit::singleline(&mut self.query).id(field_id()).hint_text("Find").desired_width(width);
        let response = ui.add(field).accessible_name("Find in the script");
        if std::mem::take(&mut self.takes_focus) {
            response.request_focus();
            select_all(ui.ctx(), response.id, &self.query);
        }
        let is_new = self.update(text, caret);
        let mut by = 0;
        if response.lost_focus() {
            let [enter, escape, back] = ui.input(|input| {
                [input.key_pressed(Key::Enter), input.key_pressed(Key::Escape), input.modifiers.shift]
            });
            if escape {
                return Some(self.close());
            }
            if enter {
                by = if back { -1 } else { 1 };
                response.request_focus();
            }
        }
        let theme = Theme::of(ui);
        let (count, color) = match (self.places.len(), self.query.is_empty()) {
            (_, true) => (String::new(), theme.weak),
            (0, false) => ("Not found".to_owned(), theme.warning),
            (count, false) => (format!("{} of {count}", self.at + 1), theme.weak),
        };
        ui.label(RichText::new(count).size(style::SMALL).color(color));
        for (icon, name, step) in
            [(Icon::FrameBack, "Previous place", -1), (Icon::FrameForward, "Next place", 1)]
        {
            if icon_button(ui, icon, name, false).on_hover_text(name).clicked() {
                by = step;
            }
        }
        if icon_button(ui, Icon::Close, "Close the search", false).on_hover_text("Close").clicked() {
            return Some(self.close());
        }
        if by != 0 && !self.places.is_empty() {
            self.at = (self.at as isize + by).rem_euclid(self.places.len() as isize) as usize;
        }
        (is_new || by != 0).then(|| self.place(self.at)).flatten().map(FindEvent::Show)
    }

    /// Marks the places in the text as it is drawn.
    pub(super) fn mark(&self, ui: &Ui, text: &str, output: &TextEditOutput) {
        if !self.is_open || self.places.len() > MOST_MARKED {
            return;
        }
        let (theme, clip) = (Theme::of(ui), ui.clip_rect());
        let length = self.of.1.chars().count();
        // Byte and character up to which characters are counted.
        let (mut byte, mut character) = (0, 0);
        for (index, &place) in self.places.iter().enumerate() {
            let Some(between) = text.get(byte..place) else { return };
            (byte, character) = (place, character + between.chars().count());
            let [from, to] = [character, character + length].map(|character| {
                let caret = output.galley.pos_from_cursor(CCursor::new(character));
                caret.translate(output.galley_pos.to_vec2())
            });
            let rect = Rect::from_min_max(from.left_top(), to.right_bottom());
            if rect.intersects(clip) {
                let color = theme.accent.gamma_multiply(if index == self.at { 0.4 } else { 0.18 });
                ui.painter().rect_filled(rect, 2.0, color);
            }
        }
    }

    fn close(&mut self) -> FindEvent {
        self.is_open = false;
        FindEvent::Close(self.place(self.at).map(|range| range.start))
    }

    fn place(&self, index: usize) -> Option<Range<usize>> {
        let start = *self.places.get(index)?;
        Some(start..start + self.of.1.len())
    }

    /// Finds the places again where text or query have changed. Returns whether the query has.
    fn update(&mut self, text: &str, caret: usize) -> bool {
        let is_new = self.of.1 != self.query;
        if !is_new && self.of.0 == text {
            return false;
        }
        self.of = (text.to_owned(), self.query.clone());
        self.places = places_of(text, &self.query);
        self.at = match is_new {
            true => self.places.iter().position(|&place| place >= caret).unwrap_or(0),
            false => self.at.min(self.places.len().saturating_sub(1)),
        };
        is_new
    }
}

/// Returns the first byte of each place of a query in a text, whose letters may be large or small.
fn places_of(text: &str, query: &str) -> Vec<usize> {
    if query.is_empty() {
        return Vec::new();
    }
    // Same bytes, so that places are those of the text itself.
    let [text, query] = [text, query].map(str::to_ascii_lowercase);
    text.match_indices(&query).map(|(at, _)| at).collect()
}

#[cfg(test)]
mod tests {
    use super::places_of;

    #[test]
    fn letters_may_be_large_or_small_and_places_are_bytes() {
        assert_eq!(places_of("é Walk walk WALK", "walk"), [3, 8, 13]);
        assert_eq!(places_of("aaaa", "aa"), [0, 2]);
        assert_eq!(places_of("text", ""), [0; 0]);
    }
}
