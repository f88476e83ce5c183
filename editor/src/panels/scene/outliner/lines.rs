//! The list of the drawn lines of a project: selected, renamed, colored, hidden, deleted.

use super::rename;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::menu::submenu;
use crate::panels::name_field::{NameField, NameFieldEnd};
use crate::panels::request::Request;
use crate::panels::scene::{
    LINE_COLORS, LineColor, LineRequest, SceneRequest, color_text, line_name, line_named,
};
use crate::panels::style::{GRID, ROW};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::stage::line::DrawnLine;
use dragonfly_document::bones::Choice;
use egui::accesskit::Role;
use egui::{Color32, Rect, RichText, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2};

/// The section of the list that has the lines.
#[derive(Debug, Default)]
pub(super) struct LineRows {
    /// The line whose name is typed, and the new name.
    typed: Option<(Box<str>, NameField)>,
}

impl LineRows {
    /// Draws the heading and a row for each line; nothing where there is none.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some(lines) = context.scene().and_then(|scene| scene.lines.as_ref()) else { return };
        if lines.list().is_empty() {
            return;
        }
        if let Some(name) = context.scene_editing.lines().renaming() {
            self.typed = Some((name.into(), NameField::of(name)));
            send(requests, LineRequest::Rename(None));
        }
        ui.add_space(GRID);
        ui.horizontal(|ui| {
            ui.add_space(3.0 * GRID);
            ui.label(RichText::new("Lines").small().color(Theme::of(ui).weak));
        });
        let clip = ui.clip_rect();
        for (index, line) in lines.list().iter().enumerate() {
            let is_named = |of: &str| line_named(lines, of) == Some(index);
            let Some((_, field)) = self.typed.as_mut().filter(|(of, _)| is_named(of)) else {
                let top = ui.cursor().top();
                match top + ROW < clip.top() || top > clip.bottom() {
                    true => ui.add_space(ROW),
                    false => self.row(ui, context, (&line_name(index, line), line), requests),
                }
                continue;
            };
            let name = line_name(index, line);
            let rect = rename::row(ui);
            let end = field.show(ui, rect, "Name of the line", TextStyle::Body);
            let new = field.text().trim().to_owned();
            match end {
                NameFieldEnd::Open => continue,
                NameFieldEnd::Entered | NameFieldEnd::Left if !new.is_empty() && *new != *name => {
                    send(requests, LineRequest::Set(name, "id", Some(new)));
                }
                NameFieldEnd::Entered | NameFieldEnd::Left | NameFieldEnd::GivenUp => {}
            }
            self.typed = None;
        }
    }

    fn row(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        (name, line): (&str, &DrawnLine),
        requests: &mut Vec<Request>,
    ) {
        let (theme, editing) = (Theme::of(ui), context.scene_editing.lines());
        let (is_selected, is_hidden) = (editing.is_selected(name), editing.is_hidden(name));
        let (rect, response) = widgets::row(ui, &format!("{name}, line"), is_selected, false);
        let mark = Rect::from_center_size(pos2(rect.left() + 22.0, rect.center().y), vec2(16.0, 16.0));
        let [red, green, blue] = line.color;
        Icon::Pencil.paint(ui.painter(), mark, Color32::from_rgb(red, green, blue));
        let text = Rect::from_min_max(
            pos2(rect.left() + 36.0, rect.top()),
            pos2(rect.right() - 34.0, rect.bottom()),
        );
        let shown = widgets::cut_in_middle(ui, name, text.width(), &TextStyle::Body);
        let color = match (is_selected, is_hidden) {
            (true, _) => theme.accent,
            (false, true) => theme.faint,
            (false, false) => theme.text,
        };
        widgets::text_in(ui, text, &shown, &TextStyle::Body, color);
        let place = Rect::from_center_size(pos2(rect.right() - 16.0, rect.center().y), vec2(20.0, ROW));
        let button = ui.interact(place, response.id.with("hide"), Sense::click());
        let verb = if is_hidden { "Show" } else { "Hide" };
        button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("{verb} {name}")));
        if is_hidden || ui.rect_contains_pointer(rect) || button.has_focus() {
            let icon = if is_hidden { Icon::Hidden } else { Icon::Shown };
            icon.paint(ui.painter(), place, if button.hovered() { theme.text } else { theme.faint });
            widgets::focus_ring(ui, &button, place);
        }
        if button.clicked() {
            send(requests, LineRequest::Hide(name.into(), !is_hidden));
        }
        response.context_menu(|ui| self.menu(ui, name, requests));
        if response.double_clicked() {
            self.typed = Some((name.into(), NameField::of(name)));
        }
        if response.clicked() {
            self.choose(ui, context, name, requests);
        } else if response.secondary_clicked() && !is_selected {
            send(requests, LineRequest::Select(Some(name.into())));
        }
        response.on_hover_ui(|ui| {
            let length = line.samples().length();
            ui.label(format!("line {name}, {length:.2} m\nDouble-click: rename"));
        });
    }

    /// Selects by a click: with Ctrl it toggles, with Shift it adds all rows from the active one up to this one.
    fn choose(&mut self, ui: &Ui, context: &PanelContext<'_>, name: &str, requests: &mut Vec<Request>) {
        let modifiers = ui.input(|input| input.modifiers);
        let Some(lines) = context.scene().and_then(|scene| scene.lines.as_ref()) else { return };
        let active = context.scene_editing.lines().selected().and_then(|name| line_named(lines, name));
        let range = active.zip(line_named(lines, name)).filter(|_| modifiers.shift);
        let (names, choice) = match range {
            Some((from, to)) => {
                let between = lines.list().iter().enumerate().take(from.max(to) + 1).skip(from.min(to));
                let names = between.map(|(index, line)| line_name(index, line));
                // The one that was clicked becomes the active one.
                let mut names: Vec<Box<str>> = names.filter(|other| **other != *name).collect();
                names.push(name.into());
                (names, Choice::Add)
            }
            None if modifiers.command => (vec![name.into()], Choice::Toggle),
            None if modifiers.shift => (vec![name.into()], Choice::Add),
            None => (vec![name.into()], Choice::Replace),
        };
        send(requests, LineRequest::Choose(names, choice));
    }

    fn menu(&mut self, ui: &mut Ui, name: &str, requests: &mut Vec<Request>) {
        let entry = |ui: &mut Ui, title: &str| {
            let is_clicked = ui.add(egui::Button::new(title).frame_when_inactive(false)).clicked();
            if is_clicked {
                ui.close();
            }
            is_clicked
        };
        if entry(ui, "Use as path") {
            send(requests, LineRequest::UseAsPath(name.into()));
        }
        if entry(ui, "Rename") {
            self.typed = Some((name.into(), NameField::of(name)));
        }
        submenu(ui, "Color", |ui| {
            for LineColor { title, rgb } in LINE_COLORS {
                if entry(ui, title) {
                    send(requests, LineRequest::Set(name.into(), "color", Some(color_text(rgb))));
                }
            }
        });
        if entry(ui, "Delete") {
            send(requests, LineRequest::Delete(name.into()));
        }
    }
}

fn send(requests: &mut Vec<Request>, request: LineRequest) {
    requests.push(Request::Scene(SceneRequest::Line(request)));
}
