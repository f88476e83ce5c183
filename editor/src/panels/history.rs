//! The list of all steps: a click on a step undoes or redoes everything up to it.

use super::command_button;
use super::commands::Id;
use super::context::PanelContext;
use super::icons::Icon;
use super::request::Request;
use super::step_text;
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::{Panel, PanelPlace, PanelSubject, widgets};
use dragonfly_document::{Change, HistoryView};
use egui::{Rect, ScrollArea, TextStyle, Ui, pos2, vec2};

/// The list of steps.
#[derive(Debug, Default)]
pub struct History {
    /// The position in the history that was scrolled to last: the steps done, and all steps.
    followed: Option<(usize, usize)>,
}

impl Panel for History {
    fn id(&self) -> &'static str {
        "history"
    }

    fn title(&self) -> &'static str {
        "History"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Right
    }

    fn subject(&self) -> PanelSubject {
        PanelSubject::Any
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some(view) = context.view else {
            return widgets::empty(ui, "The history of edits appears here", "");
        };
        let history = &view.history;
        buttons(ui, context, history, requests);
        ui.spacing_mut().item_spacing.y = 0.0;
        let here = (history.done, history.steps.len());
        let follow = self.followed.replace(here) != Some(here);
        let mut area = ScrollArea::vertical().auto_shrink(false);
        if follow {
            // The current step is centered, so that the steps before and after it are visible.
            let middle = (ui.available_height() - ROW) / 2.0;
            area = area.vertical_scroll_offset((history.done as f32 * ROW - middle).max(0.0));
        }
        area.show_rows(ui, ROW, history.steps.len() + 1, |ui, range| {
            for done in range {
                if row(ui, history, (done, context.frame_rate)).clicked() && done != history.done {
                    requests.push(Request::Change(Change::GoTo(done)));
                }
            }
        });
    }
}

fn buttons(ui: &mut Ui, context: &PanelContext<'_>, history: &HistoryView, requests: &mut Vec<Request>) {
    ui.add_space(GRID);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.add_space(2.0 * GRID);
        for (icon, id) in [(Icon::Revert, Id::Undo), (Icon::Redo, Id::Redo)] {
            let when = super::commands::get(id).when;
            ui.add_enabled_ui(when.holds(context), |ui| {
                command_button::command_button(ui, icon, id, false, requests);
            });
        }
        ui.add_space(2.0 * GRID);
        let text = match history.steps.len() {
            0 => "There is nothing to undo".to_owned(),
            steps => {
                format!("{} of {}", widgets::grouped(history.done), widgets::count(steps, "step", "steps"))
            }
        };
        let text = egui::RichText::new(text).small().color(Theme::of(ui).weak);
        ui.add(egui::Label::new(text).truncate());
    });
    ui.add_space(GRID);
}

/// Draws the row of the state after `done` steps.
fn row(ui: &mut Ui, history: &HistoryView, (done, frame_rate): (usize, u32)) -> egui::Response {
    let theme = Theme::of(ui);
    let (label, about) = match done.checked_sub(1) {
        None => ("Opened".to_owned(), String::new()),
        Some(step) => step_text::step_text(history, step, frame_rate),
    };
    let (here, ahead, saved) = (done == history.done, done > history.done, history.saved_at == Some(done));
    let mut name = label.clone();
    for (is, word) in [(!about.is_empty(), about.as_str()), (ahead, "undone"), (saved && done > 0, "saved")] {
        if is {
            name.push_str(", ");
            name.push_str(word);
        }
    }
    let (rect, response) = widgets::row(ui, &name, here, false);
    let [color, weak] = match () {
        () if here => [theme.accent, theme.accent],
        () if ahead => [theme.faint, theme.faint],
        () => [theme.text, theme.weak],
    };
    let mut right = rect.right() - 12.0;
    if saved && done > 0 {
        let mark = Rect::from_center_size(pos2(right - 4.0, rect.center().y), vec2(16.0, 16.0));
        Icon::Saved.paint(ui.painter(), mark, weak);
        right -= 20.0;
    }
    let text = Rect::from_min_max(pos2(rect.left() + 12.0, rect.top()), pos2(right, rect.bottom()));
    let end = widgets::text_in(ui, text, &label, &TextStyle::Body, color);
    if !about.is_empty() && right - end > 40.0 {
        let text = Rect::from_min_max(pos2(end + 8.0, rect.top()), pos2(right, rect.bottom()));
        widgets::text_in(ui, text, &about, &TextStyle::Small, weak);
    }
    let action = match () {
        () if here => "Current state",
        () if ahead => "Click to redo everything up to here",
        () => "Click to undo everything after this",
    };
    let saved = if saved && done > 0 { "\nThis state is saved" } else { "" };
    let about = if about.is_empty() { String::new() } else { format!("\n{about}") };
    response.on_hover_text(format!("{label}{about}\n{action}{saved}"))
}
