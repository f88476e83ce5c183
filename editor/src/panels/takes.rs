//! The list of takes.

use super::state::{Request, State};
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::{Panel, Place, widgets};
use egui::{Rect, ScrollArea, TextStyle, Ui, pos2};

/// The list of takes.
#[derive(Debug, Default)]
pub struct Takes;

impl Panel for Takes {
    fn id(&self) -> &'static str {
        "takes"
    }

    fn title(&self) -> &'static str {
        "Takes"
    }

    fn place(&self) -> Place {
        Place::LeftBelow
    }

    fn show(&mut self, ui: &mut Ui, state: &State, requests: &mut Vec<Request>) {
        if state.view.is_none() {
            return widgets::empty(ui, "", "Takes appear here");
        }
        let takes = &state.digest.takes;
        ui.add_space(GRID);
        ui.spacing_mut().item_spacing.y = 0.0;
        // The rest pose stands first: it is always there.
        ScrollArea::vertical().auto_shrink(false).show_rows(ui, ROW, takes.len() + 1, |ui, range| {
            for index in range {
                match index.checked_sub(1).and_then(|take| takes.get(take).map(|row| (take, row))) {
                    None => {
                        if line(ui, "Rest pose", "", "", state.playback.take.is_none()).clicked() {
                            requests.push(Request::ShowTake(None));
                        }
                    }
                    Some((take, row)) => {
                        let keys = widgets::grouped(row.keys);
                        let length = format!("{:.2} s", row.length);
                        let response = line(ui, &row.name, &keys, &length, state.playback.take == Some(take));
                        let response = response.on_hover_text(widgets::dot_separated(&[
                            length,
                            widgets::count(row.keys, "key", "keys"),
                            widgets::count(row.tracks, "track", "tracks"),
                        ]));
                        if response.clicked() {
                            requests.push(Request::ShowTake(Some(take)));
                        }
                    }
                }
            }
        });
    }
}

/// Name at the left, number of keys and length at the right.
fn line(ui: &mut Ui, name: &str, keys: &str, length: &str, selected: bool) -> egui::Response {
    let theme = Theme::of(ui);
    let (rect, response) = widgets::row(ui, name, selected, false);
    let color = if selected { theme.accent } else { theme.text };
    let y = rect.center().y;
    let numbers = if selected { theme.accent } else { theme.weak };
    let right = widgets::number_at(ui, rect.right() - 12.0, y, length, numbers);
    let column = (rect.right() - 76.0).min(right - 8.0);
    let right = if rect.width() > 200.0 && !keys.is_empty() {
        widgets::number_at(ui, column, y, keys, theme.faint)
    } else {
        right
    };
    let text = Rect::from_min_max(pos2(rect.left() + 12.0, rect.top()), pos2(right - 8.0, rect.bottom()));
    widgets::text_in(ui, text, name, &TextStyle::Body, color);
    response
}
