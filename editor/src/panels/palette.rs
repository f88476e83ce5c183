//! The command palette: finds every command, every take and every gesture of the mouse by typed text.

use super::commands::{self, Command, Id, MOUSE};
use super::context::PanelContext;
use super::overlay::Overlay;
use super::request::Request;
use super::style::{self, ROW};
use super::theme::Theme;
use super::widgets;
use egui::{
    Align2, FontId, Key, Margin, Modifiers, Rect, RichText, ScrollArea, TextEdit, TextStyle, Ui, pos2,
};
use std::borrow::Cow;

/// Largest number of takes that are listed: more are found by typing on.
const TAKES: usize = 50;

/// Typed text and chosen entry.
#[derive(Debug, Default)]
pub(super) struct Palette {
    query: String,
    chosen: usize,
}

/// An entry that can be found.
#[derive(Clone, Copy)]
enum PaletteEntry<'a> {
    Command(&'static Command),
    /// Index of the take, and its name.
    Take(usize, &'a str),
    /// A gesture of the mouse, and its action.
    Gesture(&'static str, &'static str),
}

impl Palette {
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        fresh: bool,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        ui.set_width(460.0);
        let (up, down, enter) = ui.input_mut(|input| {
            let mut take = |key| input.consume_key(Modifiers::NONE, key);
            (take(Key::ArrowUp), take(Key::ArrowDown), take(Key::Enter))
        });
        let name = "Find a command or a take";
        let field = TextEdit::singleline(&mut self.query).hint_text(name).desired_width(f32::INFINITY);
        let response = ui.add(field.margin(Margin::symmetric(10, 7))).accessible_name(name);
        if fresh {
            response.request_focus();
        }
        if response.changed() {
            self.chosen = 0;
        }
        let found = search(&self.query, context);
        if found.is_empty() {
            ui.label(RichText::new("No command or take matches").color(Theme::of(ui).weak));
            return;
        }
        if down {
            self.chosen += 1;
        }
        self.chosen = self.chosen.min(found.len() - 1);
        if up {
            self.chosen = self.chosen.saturating_sub(1);
        }
        let mut run = enter.then(|| found[self.chosen]);
        ui.spacing_mut().item_spacing.y = 0.0;
        // Set explicitly: a card that has just grown is still laid out with its previous height.
        let height = (found.len() as f32 * ROW).min(12.0 * ROW);
        ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
            for (index, entry) in found.iter().enumerate() {
                let response = entry.row(ui, context, index == self.chosen);
                if index == self.chosen && (up || down) {
                    response.scroll_to_me(None);
                }
                if response.clicked() {
                    run = Some(*entry);
                }
            }
        });
        if let Some(entry) = run {
            requests.push(Request::Overlay(None));
            requests.push(entry.request());
        }
    }
}

/// Returns the commands whose title, category or help contains every word of `query`, and the takes whose names do;
/// those with a match in the title first.
fn search<'a>(query: &str, context: &'a PanelContext<'a>) -> Vec<PaletteEntry<'a>> {
    let words: Vec<String> = query.to_lowercase().split_whitespace().map(str::to_owned).collect();
    let has = |text: &str| {
        let text = text.to_lowercase();
        // A plural finds the singular as well.
        let has = |word: &str| {
            text.contains(word)
                || word.strip_suffix('s').is_some_and(|one| one.len() > 2 && text.contains(one))
        };
        words.iter().all(|word| has(word))
    };
    let commands = commands::all().filter(|command| command.id != Id::Palette).map(PaletteEntry::Command);
    // An empty field lists the commands; takes have a list of their own.
    let takes = if words.is_empty() { &[][..] } else { &context.digest.takes };
    let takes = takes.iter().enumerate().map(|(index, take)| PaletteEntry::Take(index, &take.name));
    let takes = takes.filter(|entry| has(&entry.about())).take(TAKES);
    let gestures = if words.is_empty() { &[][..] } else { MOUSE };
    let gestures = gestures.iter().map(|(gesture, action)| PaletteEntry::Gesture(gesture, action));
    let gestures = gestures.filter(|entry| has(&entry.about()));
    let mut found: Vec<PaletteEntry<'_>> =
        commands.filter(|entry| has(&entry.about())).chain(takes).chain(gestures).collect();
    // Titles that begin with the first word come first, then those with a match, then commands that are not available now, with the
    // reason, and gestures last.
    let first = words.first().map_or("", String::as_str);
    let begins = |title: &str| title.to_lowercase().starts_with(first);
    found.sort_by_key(|entry| {
        (entry.is_gesture(), !has(entry.title()), !entry.is_able(context), !begins(entry.title()))
    });
    found
}

impl<'a> PaletteEntry<'a> {
    fn title(self) -> &'a str {
        match self {
            Self::Command(command) => command.title,
            Self::Take(_, name) => name,
            Self::Gesture(_, action) => action,
        }
    }

    fn is_gesture(self) -> bool {
        matches!(self, Self::Gesture(..))
    }

    /// Returns the category that is shown next to the title.
    fn category(self) -> &'static str {
        match self {
            Self::Command(command) => commands::category_of(command.id).title(),
            Self::Take(..) => "Show take",
            Self::Gesture(..) => "Mouse",
        }
    }

    /// Returns the text that is searched.
    fn about(self) -> String {
        let help = match self {
            Self::Command(command) => command.help,
            Self::Take(..) => "",
            Self::Gesture(gesture, _) => gesture,
        };
        format!("{} {} {help}", self.category(), self.title())
    }

    fn is_able(self, context: &PanelContext<'_>) -> bool {
        match self {
            Self::Command(command) => command.when.holds(context),
            Self::Take(..) | Self::Gesture(..) => true,
        }
    }

    fn request(self) -> Request {
        match self {
            Self::Command(command) => Request::Command(command.id),
            Self::Take(index, _) => Request::ShowTake(Some(index)),
            // The sheet lists all gestures.
            Self::Gesture(..) => Request::Overlay(Some(Overlay::Shortcuts)),
        }
    }

    fn row(self, ui: &mut Ui, context: &PanelContext<'_>, chosen: bool) -> egui::Response {
        let theme = Theme::of(ui);
        let name = match self {
            Self::Gesture(gesture, action) => Cow::Owned(format!("{action}: {gesture}")),
            Self::Command(_) | Self::Take(..) => Cow::Borrowed(self.title()),
        };
        let (rect, response) = widgets::row(ui, &name, chosen, false);
        let able = self.is_able(context);
        let color = match (able, chosen) {
            (false, _) => theme.faint,
            (true, true) => theme.accent,
            (true, false) => theme.text,
        };
        let inside = Rect::from_min_max(
            pos2(rect.left() + 12.0, rect.top()),
            pos2(rect.right() - 12.0, rect.bottom()),
        );
        let right = widgets::text_in(ui, inside, self.title(), &TextStyle::Body, color);
        let font = FontId::proportional(style::SMALL);
        let (shortcut, note) = match self {
            Self::Command(command) if !able => {
                (commands::shortcut_text(ui.ctx(), command.id), command.when.reason())
            }
            Self::Command(command) => (commands::shortcut_text(ui.ctx(), command.id), self.category()),
            Self::Take(..) => (String::new(), self.category()),
            Self::Gesture(gesture, _) => (gesture.to_owned(), self.category()),
        };
        let at = pos2(rect.right() - 12.0, rect.center().y);
        let keys = ui.painter().text(at, Align2::RIGHT_CENTER, shortcut, font.clone(), theme.weak);
        if right + 80.0 < keys.left() {
            let at = pos2(right + 10.0, rect.center().y);
            ui.painter().text(at, Align2::LEFT_CENTER, note, font, theme.faint);
        }
        response
    }
}
