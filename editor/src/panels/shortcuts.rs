//! The sheet of keyboard and mouse shortcuts, in which shortcuts can be changed.

use super::commands::{self, Category, Command, Id, KeyScope, KeySettings, Keymap, MOUSE, Preset};
use super::context::PanelContext;
use super::icons::Icon;
use super::overlay_title;
use super::request::Request;
use super::style::{self, GRID};
use super::theme::Theme;
use super::widgets;
use egui::{Button, Event, Key, KeyboardShortcut, Modifiers, RichText, ScrollArea, TextEdit, TextStyle, Ui};

/// Room at the right end of a line, for the bar that scrolls, points.
const END: f32 = 3.0 * GRID;

/// State of the sheet.
#[derive(Debug, Default)]
pub(super) struct ShortcutSheet {
    query: String,
    /// The command whose key is being chosen, where that key applies, and its index; the number of its keys for a new one.
    asks: Option<(KeyScope, Id, usize)>,
    /// Result of the last change of a shortcut.
    note: String,
}

impl ShortcutSheet {
    /// Resets the sheet when it is opened.
    pub(super) fn begin(&mut self, ui: &Ui) {
        *self = Self::default();
        Keymap::set_asking(ui.ctx(), false);
    }

    pub(super) fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let room = ui.ctx().content_rect();
        ui.set_width((room.width() - 96.0).clamp(320.0, 860.0));
        overlay_title::show(ui, "Shortcuts", requests);
        self.listen(ui, &context.settings.keys, requests);
        self.head(ui, &context.settings.keys, requests);
        let height = (room.height() - 220.0).max(120.0);
        // As high with few hits as with all, so that nothing moves while the user types.
        let area = ScrollArea::vertical().auto_shrink(false).max_height(height).min_scrolled_height(height);
        area.show(ui, |ui| {
            let keymap = Keymap::of(ui.ctx());
            let found = |category: &Category| {
                commands::of(*category).iter().filter(|command| self.finds(command, &keymap)).count()
            };
            let counts: Vec<usize> = Category::ALL.iter().map(found).collect();
            let (all, keys) = (counts.iter().sum::<usize>(), &context.settings.keys);
            let gestures = found_gestures(&self.query);
            if all + gestures.len() == 0 {
                return widgets::empty(ui, "No shortcut found", "");
            }
            let columns = if ui.available_width() > 700.0 { 2 } else { 1 };
            ui.columns(columns, |columns| {
                let half = all.div_ceil(columns.len()).max(1);
                let mut before = 0;
                for (category, count) in Category::ALL.iter().zip(counts) {
                    let column = (before / half).min(columns.len() - 1);
                    before += count;
                    self.sheet(&mut columns[column], *category, keys, requests);
                }
                self.over_keys(&mut columns[0], keys, requests);
                mouse(&mut columns[0], &gestures);
            });
        });
        let hint = if self.note.is_empty() { "Click a shortcut to change it" } else { &self.note };
        ui.label(RichText::new(hint).size(style::SMALL).color(Theme::of(ui).weak));
    }

    /// Draws the search field and the presets.
    fn head(&mut self, ui: &mut Ui, keys: &KeySettings, requests: &mut Vec<Request>) {
        ui.horizontal_wrapped(|ui| {
            let field = TextEdit::singleline(&mut self.query).hint_text("Find a command or a key");
            ui.add(field.desired_width(200.0)).accessible_name("Find a command or a key");
            ui.add_space(2.0 * GRID);
            ui.label(RichText::new("Preset").color(Theme::of(ui).weak));
            for preset in Preset::ALL {
                if ui.selectable_label(keys.preset == *preset, preset.title()).clicked() {
                    requests.push(Request::Keys(KeySettings { preset: *preset, ..keys.clone() }));
                }
            }
            if !keys.is_preset() && ui.button("Reset my shortcuts").clicked() {
                let preset = keys.preset;
                requests.push(Request::Keys(KeySettings { preset, ..KeySettings::default() }));
            }
        });
    }

    /// Assigns the key that was pressed while a key is being chosen.
    fn listen(&mut self, ui: &Ui, keys: &KeySettings, requests: &mut Vec<Request>) {
        let Some((scope, id, place)) = self.asks else { return };
        let Some((key, modifiers)) = ui.input_mut(|input| take_key(&mut input.events)) else { return };
        self.ask(ui, None);
        let keymap = Keymap::of(ui.ctx());
        let mut shortcuts = keymap.shortcuts(scope, id).to_vec();
        match key {
            Key::Escape => return,
            Key::Delete | Key::Backspace if modifiers.is_none() => {
                if place < shortcuts.len() {
                    shortcuts.remove(place);
                }
                self.note = format!("Removed a shortcut of “{}”", commands::get(id).title);
            }
            _ => {
                let chosen = KeyboardShortcut::new(modifiers, key);
                let loser = keymap.command_of(scope, key, modifiers).filter(|other| *other != id);
                self.note = match loser {
                    Some(other) => format!(
                        "{} now runs “{}” instead of “{}”",
                        commands::text(&chosen),
                        commands::get(id).title,
                        commands::get(other).title
                    ),
                    None => format!("{} now runs “{}”", commands::text(&chosen), commands::get(id).title),
                };
                shortcuts.retain(|other| *other != chosen);
                let place = place.min(shortcuts.len());
                if place < shortcuts.len() {
                    shortcuts[place] = chosen;
                } else {
                    shortcuts.push(chosen);
                }
            }
        }
        let mut keys = keys.clone();
        // A shortcut that the user assigned to another command is removed from that command.
        for other in commands::all().map(|command| command.id).filter(|other| *other != id) {
            let taken = keymap.shortcuts(scope, other);
            let left: Vec<_> = taken.iter().filter(|taken| !shortcuts.contains(taken)).copied().collect();
            if keys.is_own(scope, other) && left.len() < taken.len() {
                keys.set(scope, other, &left);
            }
        }
        keys.set(scope, id, &shortcuts);
        requests.push(Request::Keys(keys));
    }

    fn ask(&mut self, ui: &Ui, asks: Option<(KeyScope, Id, usize)>) {
        self.asks = asks;
        Keymap::set_asking(ui.ctx(), asks.is_some());
        if asks.is_some() {
            self.note = "Press a shortcut · Esc keeps the old one · Delete removes it".to_owned();
        }
    }

    fn sheet(&mut self, ui: &mut Ui, category: Category, keys: &KeySettings, requests: &mut Vec<Request>) {
        let keymap = Keymap::of(ui.ctx());
        let found = commands::of(category).iter().filter(|command| self.finds(command, &keymap));
        let found: Vec<&Command> = found.collect();
        if found.is_empty() {
            return;
        }
        heading(ui, category.title());
        for command in found {
            self.row(ui, KeyScope::Window, command, keys, requests);
        }
    }

    /// Draws the keys that commands have over the timeline and the curves.
    fn over_keys(&mut self, ui: &mut Ui, keys: &KeySettings, requests: &mut Vec<Request>) {
        let keymap = Keymap::of(ui.ctx());
        let asked = self.asks.filter(|(scope, ..)| *scope == KeyScope::Keys).map(|(_, id, _)| id);
        let has_keys = |command: &&Command| {
            !keymap.shortcuts(KeyScope::Keys, command.id).is_empty()
                || keys.is_own(KeyScope::Keys, command.id)
                || asked == Some(command.id)
        };
        let found: Vec<&Command> =
            commands::all().filter(has_keys).filter(|command| self.finds(command, &keymap)).collect();
        if found.is_empty() {
            return;
        }
        heading(ui, "Over the timeline and the curves");
        for command in found {
            self.row(ui, KeyScope::Keys, command, keys, requests);
        }
    }

    /// Draws a command with its keys in a part of the window.
    fn row(
        &mut self,
        ui: &mut Ui,
        scope: KeyScope,
        command: &Command,
        keys: &KeySettings,
        requests: &mut Vec<Request>,
    ) {
        let (id, keymap) = (command.id, Keymap::of(ui.ctx()));
        let is_asked = |(by, asked, _): &(KeyScope, Id, usize)| (*by, *asked) == (scope, id);
        let asked = self.asks.filter(is_asked).map(|(.., place)| place);
        let shortcuts = keymap.shortcuts(scope, id);
        let mut asks = None;
        let row = line(ui, command.title, |ui| {
            if keys.is_own(scope, id) {
                let name = format!("Reset shortcuts of {}", command.title);
                if widgets::icon_button(ui, Icon::Close, &name, false).on_hover_text(&name).clicked() {
                    let mut keys = keys.clone();
                    keys.reset(scope, id);
                    requests.push(Request::Keys(keys));
                }
            }
            // Drawn from right to left, so that the first shortcut is the leftmost.
            let places = shortcuts.len().max(1) + usize::from(asked == Some(shortcuts.len().max(1)));
            for place in (0..places.min(4)).rev() {
                let text = match shortcuts.get(place) {
                    _ if asked == Some(place) => "Press a key".to_owned(),
                    Some(shortcut) => commands::text(shortcut),
                    None => inherited(ui, scope, id).unwrap_or_else(|| "–".to_owned()),
                };
                let name = match scope {
                    KeyScope::Window => command.title.to_owned(),
                    KeyScope::Keys => format!("{} over keys", command.title),
                };
                if cap(ui, &name, &text, asked == Some(place)).clicked() {
                    asks = Some((scope, id, place));
                }
            }
        });
        row.context_menu(|ui| {
            if ui.button("Add a shortcut").clicked() {
                asks = Some((scope, id, shortcuts.len()));
            }
            let over_keys = keymap.shortcuts(KeyScope::Keys, id).len();
            if scope == KeyScope::Window
                && ui.button("Add a shortcut over the timeline and the curves").clicked()
            {
                asks = Some((KeyScope::Keys, id, over_keys));
            }
            if ui.button("Remove all shortcuts").clicked() {
                let mut keys = keys.clone();
                keys.set(scope, id, &[]);
                requests.push(Request::Keys(keys));
            }
        });
        if asks.is_some() {
            self.ask(ui, asks);
        }
    }

    fn finds(&self, command: &Command, keymap: &Keymap) -> bool {
        let query = self.query.trim().to_lowercase();
        let has = |text: &str| text.to_lowercase().contains(&query);
        has(command.title)
            || KeyScope::ALL
                .iter()
                .flat_map(|scope| keymap.shortcuts(*scope, command.id))
                .any(|shortcut| has(&commands::text(shortcut)))
            || commands::counterparts_of(command.id)
                .filter_map(|other| keymap.first_shortcut(other))
                .any(|shortcut| has(&commands::text(shortcut)))
    }
}

/// Returns the key that a command without a key of its own has while a scene is open: that of its counterpart for models; `None` where there is none.
fn inherited(ui: &Ui, scope: KeyScope, id: Id) -> Option<String> {
    let text = match scope {
        KeyScope::Window => commands::shortcut_of_counterpart(ui.ctx(), id),
        KeyScope::Keys => String::new(),
    };
    Some(text).filter(|text| !text.is_empty())
}

/// Removes the first pressed key from the events. Returns it with its modifier keys.
fn take_key(events: &mut Vec<Event>) -> Option<(Key, Modifiers)> {
    let place = events.iter().position(|event| {
        matches!(event, Event::Key { pressed: true, .. } | Event::Copy | Event::Cut | Event::Paste(_))
    })?;
    let found = match events.remove(place) {
        Event::Key { key, modifiers, .. } => (key, plain(modifiers)),
        Event::Copy => (Key::C, Modifiers::COMMAND),
        Event::Cut => (Key::X, Modifiers::COMMAND),
        _ => (Key::V, Modifiers::COMMAND),
    };
    // The text of the key must not go into the search field.
    events.retain(|event| !matches!(event, Event::Text(_)));
    Some(found)
}

/// Returns the modifiers in the form that the tables of commands use.
fn plain(held: Modifiers) -> Modifiers {
    Modifiers { alt: held.alt, shift: held.shift, command: held.command || held.ctrl, ..Modifiers::NONE }
}

fn cap(ui: &mut Ui, title: &str, text: &str, asked: bool) -> egui::Response {
    let theme = Theme::of(ui);
    let color = if asked { theme.accent } else { theme.weak };
    let button = Button::new(RichText::new(text).size(style::SMALL).color(color)).small();
    let response = ui.add(button);
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, format!("{title}: {text}"))
    });
    response
}

/// Returns the gestures of the mouse that contain every word of `query`.
fn found_gestures(query: &str) -> Vec<&'static (&'static str, &'static str)> {
    let query = query.to_lowercase();
    let finds = |(gesture, action): &&(&str, &str)| {
        let text = format!("{gesture} {action}").to_lowercase();
        query.split_whitespace().all(|word| text.contains(word))
    };
    MOUSE.iter().filter(finds).collect()
}

/// Draws gestures of the mouse.
fn mouse(ui: &mut Ui, found: &[&(&str, &str)]) {
    if found.is_empty() {
        return;
    }
    heading(ui, "Mouse");
    for (gesture, action) in found {
        let gesture_text = RichText::new(*gesture).small().color(Theme::of(ui).weak);
        let needed = widgets::text_width(ui, action, &TextStyle::Body)
            + widgets::text_width(ui, gesture, &TextStyle::Small);
        if needed + END + 2.0 * GRID < ui.available_width() {
            line(ui, action, |ui| {
                ui.label(gesture_text);
            });
        } else {
            // Too long for one line: the gesture is below what it does.
            ui.label(*action);
            line(ui, "", |ui| {
                ui.label(gesture_text);
            });
        }
    }
}

fn heading(ui: &mut Ui, text: &str) {
    ui.add_space(2.0 * GRID);
    ui.label(RichText::new(text).color(Theme::of(ui).accent));
}

fn line(ui: &mut Ui, title: &str, add: impl FnOnce(&mut Ui)) -> egui::Response {
    ui.horizontal(|ui| {
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = GRID;
            ui.add_space(END);
            add(ui);
            // The title has the room that is left.
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                ui.add(egui::Label::new(title).truncate());
            });
        });
    })
    .response
}
