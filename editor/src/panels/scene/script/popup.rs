//! The list of suggestions under the cursor.

use crate::panels::plain_words::plain_words;
use crate::panels::style::{CARD_RADIUS, RADIUS};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::stage::writing::{CompletionKind, Completions};
use egui::accesskit::Role;
use egui::{
    Area, CornerRadius, Frame, Id, Key, Modifiers, Order, Pos2, Rect, ScrollArea, Sense, Stroke, TextStyle,
    Ui, WidgetInfo, pos2, vec2,
};

/// Height of a suggestion, and largest number that is visible.
const ROW: f32 = 20.0;
const MOST: usize = 9;
/// Width of the list.
const WIDTH: f32 = 340.0;

/// The suggestions that are shown.
#[derive(Debug, Default)]
pub(super) struct SuggestionList {
    shown: Option<Completions>,
    chosen: usize,
    /// Whether the chosen one is to be scrolled to.
    follows: bool,
}

/// The effect of the keys on the list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum SuggestionKey {
    /// Nothing.
    Nothing,
    /// The suggestion with this index is taken.
    Taken(usize),
}

impl SuggestionList {
    /// Shows suggestions, or none.
    pub(super) fn set(&mut self, shown: Option<Completions>) {
        (self.shown, self.chosen, self.follows) = (shown, 0, true);
    }

    /// Returns the suggestions.
    pub(super) fn shown(&self) -> Option<&Completions> {
        self.shown.as_ref()
    }

    /// Takes the keys that are for the list: arrows, Enter, Tab, Escape.
    pub(super) fn keys(&mut self, ui: &Ui) -> SuggestionKey {
        let Some(count) = self.shown.as_ref().map(|shown| shown.items.len()) else {
            return SuggestionKey::Nothing;
        };
        let take = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
        if take(Key::Escape) {
            self.shown = None;
            return SuggestionKey::Nothing;
        }
        if take(Key::ArrowDown) {
            (self.chosen, self.follows) = ((self.chosen + 1) % count.max(1), true);
        }
        if take(Key::ArrowUp) {
            (self.chosen, self.follows) = ((self.chosen + count.max(1) - 1) % count.max(1), true);
        }
        if take(Key::Enter) || take(Key::Tab) {
            return SuggestionKey::Taken(self.chosen);
        }
        SuggestionKey::Nothing
    }

    /// Draws the list below `at`, or above the line where there is no room. Returns the suggestion that was clicked.
    pub(super) fn show(&mut self, ui: &Ui, at: Rect) -> Option<usize> {
        let shown = self.shown.as_ref()?;
        let theme = Theme::of(ui);
        let height = shown.items.len().min(MOST) as f32 * ROW + 8.0;
        let screen = ui.ctx().content_rect();
        let below = at.bottom() + 2.0 + height + 18.0 < screen.bottom();
        let y = if below { at.bottom() + 2.0 } else { (at.top() - height - 20.0).max(screen.top()) };
        let corner = pos2(at.left().min(screen.right() - WIDTH - 8.0).max(screen.left()), y);
        let mut clicked = None;
        let area = Area::new(Id::unique("suggestions"))
            .order(Order::Foreground)
            .fixed_pos(corner)
            .interactable(true);
        area.show(ui.ctx(), |ui| {
            let frame = Frame::NONE
                .fill(theme.raised)
                .stroke(Stroke::new(1.0, theme.line))
                .corner_radius(CornerRadius::same(CARD_RADIUS))
                .inner_margin(4.0);
            frame.show(ui, |ui| {
                ui.set_width(WIDTH);
                ui.spacing_mut().item_spacing.y = 0.0;
                ScrollArea::vertical().max_height(MOST as f32 * ROW).show(ui, |ui| {
                    for (index, item) in shown.items.iter().enumerate() {
                        let (rect, response) =
                            ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
                        let is_chosen = index == self.chosen;
                        response.widget_info(|| {
                            WidgetInfo::selected(Role::ListBoxOption, true, is_chosen, &item.label)
                        });
                        if is_chosen && self.follows {
                            ui.scroll_to_rect(rect, None);
                        }
                        if is_chosen || response.hovered() {
                            let fill = if is_chosen { theme.accent_soft } else { theme.hover };
                            ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), fill);
                        }
                        let text = Rect::from_min_max(
                            rect.min + vec2(8.0, 0.0),
                            pos2(rect.right() - 6.0, rect.bottom()),
                        );
                        let color = if is_chosen { theme.accent } else { theme.text };
                        let end = widgets::text_in(ui, text, &item.label, &TextStyle::Monospace, color);
                        let note =
                            if item.help.is_empty() { word(item.kind) } else { &plain_words(&item.help) };
                        let place = Rect::from_min_max(
                            pos2((end + 10.0).max(rect.left() + 110.0), rect.top()),
                            text.max,
                        );
                        if place.width() > 24.0 {
                            widgets::text_in(ui, place, note, &TextStyle::Small, theme.weak);
                        }
                        if response.clicked() {
                            clicked = Some(index);
                        }
                    }
                });
            });
        });
        self.follows = false;
        clicked
    }

    /// Returns whether a point is over the list, so that a click there does not end typing.
    pub(super) fn contains(&self, ui: &Ui, at: Pos2) -> bool {
        let id = Id::unique("suggestions");
        self.shown.is_some() && ui.ctx().layer_id_at(at).is_some_and(|layer| layer.id == id)
    }
}

/// Returns the word for a kind of suggestion.
fn word(kind: CompletionKind) -> &'static str {
    match kind {
        CompletionKind::Element => "element",
        CompletionKind::Attribute => "attribute",
        CompletionKind::Word => "",
        CompletionKind::Thing => "thing",
        CompletionKind::Moment => "moment",
        CompletionKind::Take => "take",
        CompletionKind::Bone => "bone",
        CompletionKind::File => "file",
    }
}
