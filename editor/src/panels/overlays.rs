//! What lies over the panels: command palette, shortcut sheet, about, path field.

use super::commands::{self, Command, Id};
use super::shortcuts::ShortcutSheet;
use super::state::{Overlay, Request, State};
use super::style::{self, GRID, ROW};
use super::theme::Theme;
use super::widgets;
use crate::document::Source;
use egui::{Align2, Id as WidgetId, Key, Modal, RichText, ScrollArea, TextEdit, TextStyle, Ui, pos2, vec2};
use std::path::PathBuf;

/// What is typed into overlays.
#[derive(Debug, Default)]
pub struct Overlays {
    query: String,
    chosen: usize,
    path: String,
    shortcuts: ShortcutSheet,
    shown: Option<Overlay>,
}

impl Overlays {
    /// Draws the overlay that the state names.
    pub fn show(&mut self, ui: &mut Ui, state: &State, requests: &mut Vec<Request>) {
        let fresh = self.shown != state.overlay;
        if fresh {
            self.shown = state.overlay;
            self.query.clear();
            self.chosen = 0;
            self.shortcuts.begin(ui);
        }
        let Some(overlay) = state.overlay else { return };
        let id = WidgetId::unique(("overlay", format!("{overlay:?}")));
        let mut modal = Modal::new(id).backdrop_color(Theme::of(ui).backdrop);
        let margin = if overlay == Overlay::Palette { 8 } else { 20 };
        modal = modal.frame(egui::Frame::popup(ui.style()).inner_margin(margin));
        if overlay == Overlay::Palette {
            modal = modal.area(Modal::default_area(id).anchor(Align2::CENTER_TOP, vec2(0.0, 72.0)));
        }
        let response = modal.show(ui.ctx(), |ui| match overlay {
            Overlay::Palette => self.palette(ui, fresh, state, requests),
            Overlay::Shortcuts => self.shortcuts.show(ui, state, requests),
            Overlay::About => about(ui, state, requests),
            Overlay::MirrorPairs => super::mirror_pairs::show(ui, state, requests),
            Overlay::OpenPath => self.open_path(ui, fresh, requests),
        });
        if response.should_close() {
            requests.push(Request::Overlay(None));
        }
    }

    fn palette(&mut self, ui: &mut Ui, fresh: bool, state: &State, requests: &mut Vec<Request>) {
        ui.set_width(460.0);
        let (up, down, enter) = ui.input_mut(|input| {
            let mut take = |key| input.consume_key(egui::Modifiers::NONE, key);
            (take(Key::ArrowUp), take(Key::ArrowDown), take(Key::Enter))
        });
        let field =
            TextEdit::singleline(&mut self.query).hint_text("Find a command").desired_width(f32::INFINITY);
        let response = ui.add(field.margin(egui::Margin::symmetric(10, 7))).accessible_name("Find a command");
        if fresh {
            response.request_focus();
        }
        if response.changed() {
            self.chosen = 0;
        }
        let found = search(&self.query, state);
        if found.is_empty() {
            ui.label(RichText::new("Nothing is called that").color(Theme::of(ui).weak));
            return;
        }
        if down {
            self.chosen += 1;
        }
        self.chosen = self.chosen.min(found.len() - 1);
        if up {
            self.chosen = self.chosen.saturating_sub(1);
        }
        let mut run = enter.then(|| found[self.chosen].id);
        ui.spacing_mut().item_spacing.y = 0.0;
        // Said outright: a card that has just grown believes that there is no more room than before.
        let height = (found.len() as f32 * ROW).min(12.0 * ROW);
        ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
            for (index, command) in found.iter().enumerate() {
                let response = palette_row(ui, state, command, index == self.chosen);
                if index == self.chosen && (up || down) {
                    response.scroll_to_me(None);
                }
                if response.clicked() {
                    run = Some(command.id);
                }
            }
        });
        if let Some(id) = run {
            requests.push(Request::Overlay(None));
            requests.push(Request::Command(id));
        }
    }

    fn open_path(&mut self, ui: &mut Ui, fresh: bool, requests: &mut Vec<Request>) {
        ui.set_width(520.0);
        ui.label(RichText::new("Open by path").heading());
        let field = TextEdit::singleline(&mut self.path)
            .hint_text("/home/me/models/fox.glb")
            .desired_width(f32::INFINITY);
        let response = ui.add(field.font(TextStyle::Monospace).margin(egui::Margin::symmetric(10, 7)));
        let response = response.accessible_name("Path of the model");
        if fresh {
            response.request_focus();
            // What was typed last is there to be corrected, or to be typed over.
            let mut cursor = TextEdit::load_state(ui.ctx(), response.id).unwrap_or_default();
            cursor.cursor.set_char_range(Some(egui::text::CCursorRange::select_all_str(&self.path)));
            cursor.store(ui.ctx(), response.id);
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        ui.add_space(GRID);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let able = !self.path.trim().is_empty();
            let open = ui.add_enabled(able, egui::Button::new("Open")).clicked();
            if ui.button("Cancel").clicked() {
                requests.push(Request::Overlay(None));
            }
            if able && (open || entered) {
                let path = PathBuf::from(self.path.trim().trim_matches('"'));
                requests.push(Request::Overlay(None));
                requests.push(Request::Open(Source::File(path)));
            }
        });
    }
}

/// Commands whose title, category or help has every word of `query`, those with it in the title first.
fn search(query: &str, state: &State) -> Vec<&'static Command> {
    let words: Vec<String> = query.to_lowercase().split_whitespace().map(str::to_owned).collect();
    let has = |text: &str| {
        let text = text.to_lowercase();
        // One is meant by those who ask for several.
        let has = |word: &str| {
            text.contains(word)
                || word.strip_suffix('s').is_some_and(|one| one.len() > 2 && text.contains(one))
        };
        words.iter().all(|word| has(word))
    };
    let mut found: Vec<&Command> = commands::all()
        .filter(|command| command.id != Id::Palette)
        .filter(|command| {
            has(&format!("{} {} {}", commands::category_of(command.id).title(), command.title, command.help))
        })
        .collect();
    // What is called so stands before what is about it; then what cannot be given now stands last, with its reason.
    found.sort_by_key(|command| (!has(command.title), !command.when.holds(state)));
    found
}

fn palette_row(ui: &mut Ui, state: &State, command: &Command, chosen: bool) -> egui::Response {
    let theme = Theme::of(ui);
    let (rect, response) = widgets::row(ui, command.title, chosen, false);
    let able = command.when.holds(state);
    let color = match (able, chosen) {
        (false, _) => theme.faint,
        (true, true) => theme.accent,
        (true, false) => theme.text,
    };
    let inside = egui::Rect::from_min_max(pos2(rect.left() + 12.0, rect.top()), rect.max);
    let right = widgets::text_in(ui, inside, command.title, &TextStyle::Body, color);
    let shortcut = commands::shortcut_text(ui.ctx(), command.id);
    let at = pos2(rect.right() - 12.0, rect.center().y);
    let font = egui::FontId::proportional(style::SMALL);
    let keys = ui.painter().text(at, Align2::RIGHT_CENTER, shortcut, font.clone(), theme.weak);
    let category = pos2(right + 10.0, rect.center().y);
    if right + 80.0 < keys.left() {
        ui.painter().text(
            category,
            Align2::LEFT_CENTER,
            if able { commands::category_of(command.id).title() } else { command.when.reason() },
            font,
            theme.faint,
        );
    }
    response
}

fn about(ui: &mut Ui, state: &State, requests: &mut Vec<Request>) {
    ui.set_width(420.0);
    title(ui, "Dragonfly", requests);
    let theme = Theme::of(ui);
    ui.label(RichText::new(concat!("Version ", env!("CARGO_PKG_VERSION"))).color(theme.weak));
    ui.add_space(2.0 * GRID);
    ui.label("An editor for skeletal animation, built on messages between threads.");
    ui.add_space(2.0 * GRID);
    ui.label(
        RichText::new("MIT or Apache 2.0. Typeface Inter: SIL Open Font License 1.1.")
            .small()
            .color(theme.weak),
    );
    if let super::state::Device::Ready { adapter } = &state.device {
        ui.label(RichText::new(adapter).small().color(theme.faint));
    }
}

pub(super) fn title(ui: &mut Ui, text: &str, requests: &mut Vec<Request>) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(text).heading());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if widgets::icon_button(ui, super::icons::Icon::Close, "Close", false).clicked() {
                requests.push(Request::Overlay(None));
            }
        });
    });
}
