//! The line at the bottom: the newest message, all of them on a click, the state of the device.

use super::buttonless_keys;
use super::commands::{self, Id};
use super::context::PanelContext;
use super::icons::Icon;
use super::key_aim;
use super::request::Request;
use super::scene::{NOT_DRAWN, effect_on};
use super::status::{MessageSeverity, StatusMessage};
use super::style::{self, GRID};
use super::theme::Theme;
use super::widgets;
use super::window_status::DeviceStatus;
use dragonfly_anim::lint::{LintRule, LintThresholds};
use dragonfly_document::edit::SAME_TIME;
use egui::{Align, Color32, Layout, Rect, RichText, ScrollArea, Sense, TextStyle, Ui, pos2, vec2};

/// Draws the line.
pub fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(3.0 * GRID);
        corner(ui, context);
        ui.add_space(GRID);
        unrecorded(ui, context);
        pending(ui, context, requests);
        foot_slide(ui, context, requests);
        message(ui, context);
    });
}

fn corner(ui: &mut Ui, context: &PanelContext<'_>) {
    let theme = Theme::of(ui);
    match context.window.device() {
        DeviceStatus::Starting => {
            ui.label(RichText::new("Starting the graphics device…").small().color(theme.faint));
        }
        DeviceStatus::Paused { .. } => {
            ui.label(RichText::new("Viewport paused").small().color(theme.warning));
        }
        // The name of the device and the time of a frame are in “About”.
        DeviceStatus::Ready { .. } => {}
    }
}

/// Shows that unsaved work is not recorded, for as long as that is so.
fn unrecorded(ui: &mut Ui, context: &PanelContext<'_>) {
    if !context.view.is_some_and(|view| view.is_unrecorded) {
        return;
    }
    let text = RichText::new("Not recorded").small().color(Theme::of(ui).warning);
    ui.label(text).on_hover_text(
        "A crash would lose unsaved work: its journal cannot be written\nIt is tried again; save to be safe",
    );
    ui.add_space(2.0 * GRID);
}

/// Shows the number of pending poses; a click goes to the next one.
fn pending(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let (here, all) = context.pending_poses();
    if all == 0 {
        return;
    }
    let theme = Theme::of(ui);
    let elsewhere = if here == 0 { " in other takes" } else { "" };
    let text = format!("{} pending{elsewhere}", widgets::count(all, "pose", "poses"));
    let [key, all_keys] = [Id::Key, Id::KeyAllPending].map(|id| commands::shortcut_text(ui.ctx(), id));
    let hint = format!(
        "Changed with auto-key off: shown, but in no key and in no saved file yet\n\
         {key} keys what is pending at this time, {all_keys} all of this take\nClick to go to the next one"
    );
    let button = egui::Button::new(RichText::new(text).small().color(theme.warning)).frame(false);
    if ui.add(button).on_hover_text(hint).clicked() {
        let now = context.time();
        let next = context.pending_times().find(|&time| time > now + SAME_TIME);
        requests.extend(next.or(context.pending_times().next()).map(Request::Seek));
    }
    ui.add_space(2.0 * GRID);
}

/// Shows how fast the worst foot slides in its contact; a click goes there.
fn foot_slide(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let Some(worst) = context.contacts.worst() else { return };
    let theme = Theme::of(ui);
    let speed = worst.millimeters_per_second;
    // As in the check of takes.
    let slides = LintThresholds::default().limit(LintRule::FootSlide);
    let color = if slides.is_some_and(|most| speed > most) { theme.warning } else { theme.weak };
    let text = format!("Foot slide {speed:.0} mm/s");
    let (name, contact) = (context.bone_name(worst.contact.bone), worst.contact);
    let hint = format!(
        "{name} slides most of all feet in contact with the ground: from {:.3} s to {:.3} s\n\
         “Lock feet in contacts” holds it\nClick to go there",
        contact.from, contact.to
    );
    let button = egui::Button::new(RichText::new(text).small().color(color)).frame(false);
    if ui.add(button).on_hover_text(hint).clicked() {
        requests.push(Request::Select(Some(contact.bone)));
        requests.push(Request::Seek(contact.from));
    }
    ui.add_space(2.0 * GRID);
}

fn message(ui: &mut Ui, context: &PanelContext<'_>) {
    let theme = Theme::of(ui);
    let size = vec2(ui.available_width(), ui.available_height());
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let (text, level) = match (context.loading, context.status.current()) {
        _ if let Some(drag) = context.keys.buttonless() => {
            (buttonless_keys::hint(drag).to_owned(), MessageSeverity::Info)
        }
        _ if let Some(aim) = context.keys.aim() => (key_aim::hint(aim).to_owned(), MessageSeverity::Info),
        (Some(loading), _) => {
            let percent = (loading.progress.done * 100.0) as u32;
            let text = format!("{} {}… {percent} %", loading.progress.stage.title(), loading.title);
            (text, MessageSeverity::Info)
        }
        (None, Some(line)) => (sentence(line), line.level),
        (None, None) => (rest_text(context), MessageSeverity::Info),
    };
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, format!("Messages: {text}"))
    });
    let (icon, color) = tone(level, theme);
    let mark = Rect::from_center_size(pos2(rect.left() + 18.0, rect.center().y), vec2(16.0, 16.0));
    let color = if response.hovered() { theme.text } else { color };
    icon.paint(ui.painter(), mark, if level == MessageSeverity::Info { theme.faint } else { color });
    let inside = Rect::from_min_max(pos2(rect.left() + 32.0, rect.top()), rect.max);
    widgets::text_in(ui, inside, &text, &TextStyle::Small, color);
    let response = response.on_hover_text("Shows all messages");
    egui::Popup::menu(&response).show(|ui| {
        ui.set_width(520.0);
        // Next to the text, not over it.
        ui.spacing_mut().scroll.floating_allocated_width = 10.0;
        ScrollArea::vertical().max_height(260.0).stick_to_bottom(true).show(ui, |ui| {
            ui.set_width(ui.available_width());
            let mut any = false;
            for line in context.status.lines() {
                any = true;
                let (_, color) = tone(line.level, Theme::of(ui));
                ui.label(RichText::new(sentence(line)).size(style::SMALL).color(color));
            }
            if !any {
                ui.label(RichText::new("No messages yet").color(Theme::of(ui).weak));
            }
        });
    });
}

/// Returns the text that is shown while there is no message: that an effect that is on at the playhead is not drawn, if there is one.
fn rest_text(context: &PanelContext<'_>) -> String {
    let at = context.scene().map(|_| context.scene_time());
    match at.and_then(|at| effect_on(context.scene_editing.lanes(), at)) {
        Some(effect) => format!("{NOT_DRAWN}: {effect} is on here"),
        None => "Ready".to_owned(),
    }
}

/// Returns the text of a message, with the number of times that it was added in a row.
pub(super) fn sentence(line: &StatusMessage) -> String {
    if line.times > 1 { format!("{} ({} times)", line.text, line.times) } else { line.text.clone() }
}

/// Returns the icon and the color of a severity.
pub(super) fn tone(level: MessageSeverity, theme: &Theme) -> (Icon, Color32) {
    match level {
        MessageSeverity::Info => (Icon::Info, theme.weak),
        MessageSeverity::Warning => (Icon::Warning, theme.warning),
        MessageSeverity::Error => (Icon::Error, theme.error),
    }
}
