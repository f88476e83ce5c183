//! The question what to do with unsaved work of an earlier session.

use super::ask::{Ask, Tone, inset};
use super::kind::QuestionKind;
use crate::panels::request::FileAction;
use crate::panels::request::Request;
use crate::panels::style::{GRID, ROW};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_document::{Decision, DocumentMessage, Offer};
use egui::{Rect, RichText, ScrollArea, TextStyle, pos2};
use std::time::Duration;

/// Unsaved work of an earlier run.
#[derive(Clone, Debug, PartialEq)]
pub struct RecoverQuestion {
    /// The recoverable documents, last written first.
    pub offers: Vec<Offer>,
    /// Whether the work was lost in this run, by an internal error.
    pub lost: bool,
}

impl QuestionKind for RecoverQuestion {
    fn name(&self) -> &'static str {
        "offered unsaved work"
    }

    fn show(&self, ask: &mut Ask<'_>) {
        ask.ui.set_width(520.0);
        let Self { offers, lost } = self;
        ask.fields.chosen = ask.fields.chosen.min(offers.len().saturating_sub(1));
        ask.title(if *lost { "The document was closed by an error" } else { "Unsaved work" });
        if *lost {
            ask.says("An internal error closed the document. Everything that you did is in its journal.");
        } else {
            ask.says("The program ended before this was saved. You can continue where you left off.");
        }
        if offers.len() > 1 {
            list(ask, offers);
        }
        let Some(offer) = offers.get(ask.fields.chosen) else { return };
        about(ask, offer);
        let keep = ("Restore", "Open it as it was, with its undo history", Tone::First, Decision::Keep);
        let beside = (
            "Open as a copy",
            "Open it as a separate document; the file is not changed",
            Tone::Plain,
            Decision::Beside,
        );
        let later = ("Later", "Keep it and ask again later", Tone::Plain, Decision::Later);
        let discard =
            ("Discard", "Move it to the bin of the autosave folder", Tone::Loses, Decision::Discard);
        let pressed = if offer.can_be_kept() {
            ask.buttons(&[keep, beside, later, discard])
        } else if offer.is_missing() {
            let some =
                |(title, help, tone, decision): (_, _, Tone, Decision)| (title, help, tone, Some(decision));
            let find = (
                "Locate the file…",
                "Choose the moved file; it is accepted if its content is unchanged",
                Tone::First,
                None,
            );
            let pressed = ask.buttons(&[find, some(later), some(discard)]);
            if pressed == Some(None) {
                ask.requests.push(Request::Answer(FileAction::Find(Box::new(offer.clone()))));
            }
            pressed.flatten()
        } else {
            let later = (later.0, later.1, Tone::First, later.3);
            ask.buttons(&[later, discard])
        };
        if let Some(decision) = pressed {
            ask.requests.push(Request::Answer(FileAction::Send(DocumentMessage::Decide(
                Box::new(offer.clone()),
                decision,
            ))));
        }
    }
}

fn list(ask: &mut Ask<'_>, offers: &[Offer]) {
    let chosen = &mut ask.fields.chosen;
    let height = (offers.len() as f32 * ROW).min(6.0 * ROW);
    ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ask.ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for (index, offer) in offers.iter().enumerate() {
            let (rect, response) = widgets::row(ui, &offer.title, index == *chosen, false);
            let theme = Theme::of(ui);
            let inside = rect.shrink2(egui::vec2(3.0 * GRID, 0.0));
            let right =
                widgets::number_at(ui, inside.right(), inside.center().y, &ago(offer.age()), theme.weak);
            let name = Rect::from_min_max(inside.min, pos2(right - 2.0 * GRID, inside.max.y));
            widgets::text_in(ui, name, &offer.title, &TextStyle::Body, theme.text);
            if response.clicked() || response.has_focus() {
                *chosen = index;
            }
        }
    });
}

fn about(ask: &mut Ask<'_>, offer: &Offer) {
    let theme = Theme::of(ask.ui);
    inset(theme).inner_margin(3.0 * GRID).show(ask.ui, |ui| {
        ui.set_width(ui.available_width());
        ui.spacing_mut().item_spacing.y = GRID;
        ui.label(RichText::new(&offer.title).strong());
        let place = match &offer.found.document {
            Some(path) => path.display().to_string(),
            None => "never saved".to_owned(),
        };
        ui.label(RichText::new(place).small().color(theme.weak));
        let facts = [widgets::count(offer.steps, "step", "steps"), ago(offer.age())];
        ui.label(widgets::dot_separated(&facts));
        if !offer.labels.is_empty() {
            let what = if offer.steps > offer.labels.len() { "The last of them" } else { "What was done" };
            let last = format!("{what}: {}", offer.labels.join(", "));
            ui.label(RichText::new(last).color(theme.weak));
        }
    });
    for warning in offer.warnings() {
        ask.warns(warning);
    }
}

/// Returns an age as text: `3 minutes ago`.
fn ago(age: Option<Duration>) -> String {
    let Some(age) = age.map(|age| age.as_secs()) else { return "a while ago".to_owned() };
    let (number, unit) = match age {
        0..60 => return "just now".to_owned(),
        60..3600 => (age / 60, "minute"),
        3600..86_400 => (age / 3600, "hour"),
        _ => (age / 86_400, "day"),
    };
    format!("{number} {unit}{} ago", if number == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_age_is_shown_in_the_largest_whole_unit() {
        let said = |seconds| ago(Some(Duration::from_secs(seconds)));
        assert_eq!(said(59), "just now");
        assert_eq!(said(60), "1 minute ago");
        assert_eq!(said(7200), "2 hours ago");
        assert_eq!(said(86_400 * 3), "3 days ago");
        assert_eq!(ago(None), "a while ago");
    }
}
