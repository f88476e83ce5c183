//! The bar over the timeline: buttons, repeat, speed, time.

use super::command_button::command_button;
use super::commands::{self, Id};
use super::context::PanelContext;
use super::edit_scope_menu;
use super::frame_rate::{OFFERED, RATES};
use super::icons::Icon;
use super::menu::outline_fields;
use super::request::Request;
use super::ruler;
use super::settings::SPEEDS;
use super::style::{self, CONTROL, GRID};
use super::theme::Theme;
use super::widgets::{icon_button, quiet_button, text_width};
use crate::control::expression::{Quantity, evaluate};
use dragonfly_picture::playback::{LATEST, Repeat};
use egui::{Align, Button, DragValue, FontId, Layout, RichText, TextStyle, Ui, vec2};

/// Draws the bar.
pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let able = context.playback.take.is_some();
    ui.horizontal(|ui| {
        ui.set_height(32.0);
        ui.add_space(2.0 * GRID);
        ui.spacing_mut().item_spacing.x = 2.0;
        let scope = edit_scope_menu::title_in(context, ui.available_width());
        let room = Room::of(ui.available_width() - edit_scope_menu::width(ui, scope));
        ui.add_enabled_ui(able, |ui| buttons(ui, context, requests));
        if room >= Room::Keying {
            divider(ui);
            match context.scene() {
                // With it, things of a scene are moved from the playhead on.
                Some(_) => {
                    command_button(ui, Icon::AutoKey, Id::AutoKey, context.settings.auto_key, requests);
                }
                None => keying(ui, context, scope, requests),
            }
        }
        if room >= Room::Repeat {
            divider(ui);
            repeat(ui, context, requests);
        }
        if room >= Room::Speed {
            divider(ui);
            speed(ui, context, requests);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(2.0 * GRID);
            ui.spacing_mut().item_spacing.x = GRID;
            if room >= Room::Rate {
                frame_rate(ui, context, requests);
                divider(ui);
            }
            if room >= Room::Frame {
                ui.add_enabled_ui(able, |ui| time(ui, context, room, requests));
            }
        });
    });
}

/// The parts of the bar that fit, the most important first: menus and keys have the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Room {
    Buttons,
    Frame,
    Keying,
    Rate,
    Repeat,
    Seconds,
    Speed,
}

impl Room {
    /// Returns what fits into a width, points.
    fn of(width: f32) -> Self {
        let needed = [
            (Self::Speed, 660.0),
            (Self::Seconds, 596.0),
            (Self::Repeat, 540.0),
            (Self::Rate, 420.0),
            (Self::Keying, 330.0),
            (Self::Frame, 260.0),
        ];
        needed.into_iter().find(|(_, needed)| width >= *needed).map_or(Self::Buttons, |(room, _)| room)
    }
}

fn buttons(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let playing = context.playback.playing;
    let (forward, backward) =
        (playing && context.playback.speed >= 0.0, playing && context.playback.speed < 0.0);
    command_button(ui, Icon::First, Id::Start, false, requests);
    command_button(ui, Icon::KeyBack, Id::PreviousKey, false, requests);
    command_button(ui, Icon::FrameBack, Id::PreviousFrame, false, requests);
    ui.add_enabled_ui(context.take_bounds().1 > 0.0, |ui| {
        let icon = if backward { Icon::Pause } else { Icon::Reverse };
        command_button(ui, icon, Id::PlayBackwards, backward, requests);
        let icon = if forward { Icon::Pause } else { Icon::Play };
        command_button(ui, icon, Id::PlayPause, forward, requests);
    });
    command_button(ui, Icon::FrameForward, Id::NextFrame, false, requests);
    command_button(ui, Icon::KeyForward, Id::NextKey, false, requests);
    command_button(ui, Icon::Last, Id::End, false, requests);
}

fn keying(ui: &mut Ui, context: &PanelContext<'_>, scope: &str, requests: &mut Vec<Request>) {
    command_button(ui, Icon::AutoKey, Id::AutoKey, context.settings.auto_key, requests);
    edit_scope_menu::switch(ui, context, scope, requests);
    let waits = context.pending_here().is_some();
    ui.add_enabled_ui(context.take().is_some(), |ui| {
        command_button(ui, Icon::Key, Id::Key, waits, requests);
    });
}

fn repeat(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let shortcut = commands::shortcut_text(ui.ctx(), Id::CycleRepeat);
    for (icon, repeat, name) in [
        (Icon::Loop, Repeat::Loop, "Loop"),
        (Icon::PingPong, Repeat::PingPong, "Ping-pong"),
        (Icon::Once, Repeat::Once, "Play once"),
    ] {
        let button = icon_button(ui, icon, name, context.playback.repeat == repeat);
        if button.on_hover_text(format!("{name} ({shortcut}: next repeat mode)")).clicked() {
            requests.push(Request::Repeat(repeat));
        }
    }
}

fn speed(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let mut speed = context.settings.speed;
    let field = DragValue::new(&mut speed)
        .range(SPEEDS)
        .speed(0.01)
        .fixed_decimals(2)
        .suffix("×")
        .update_while_editing(false)
        .custom_parser(number);
    let response = ui.add_sized(vec2(52.0, CONTROL), field).accessible_name("Speed");
    if response.on_hover_text("Speed\nDrag, or click to type").changed() {
        requests.push(Request::Speed(speed));
    }
}

fn frame_rate(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let own = context.frames_per_second();
    let rate = own.round() as u32;
    // Such as 23.976 frames in a scene.
    let text = format!("{} fps", (own * 1000.0).round() / 1000.0);
    let response = quiet_button(ui, Icon::Down, false, &text, &text);
    let response = response.on_hover_text("Frame rate of this document: display, stepping and baking");
    let menu = egui::Popup::menu(&response).close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
    menu.show(|ui| {
        ui.set_width(96.0);
        for &choice in OFFERED {
            if ui.add(Button::selectable(choice == rate, format!("{choice} fps"))).clicked() {
                requests.push(Request::FrameRate(choice));
                ui.close();
            }
        }
        outline_fields(ui);
        let mut typed = rate;
        let field = DragValue::new(&mut typed)
            .range(RATES)
            .speed(0.1)
            .suffix(" fps")
            .update_while_editing(false)
            .custom_parser(|text| number(text.trim_end_matches("fps")));
        let width = ui.available_width();
        let response = ui.add_sized(vec2(width, CONTROL), field).accessible_name("Frame rate");
        if response.on_hover_text("Any other frame rate\nDrag, or click to type").changed() {
            requests.push(Request::FrameRate(typed));
        }
    });
}

/// Smallest width of the field for the frame.
const FRAME: f32 = 50.0;
/// Size of the number of the frame, which is what animators count in, points.
const FRAME_DIGITS: f32 = 16.0;
/// Smallest width of the field for the time.
const TIME: f32 = 62.0;

/// Returns the width of a number field with this text.
fn field_width(ui: &Ui, text: &str) -> f32 {
    text_width(ui, text, &TextStyle::Monospace) + 2.0 * ui.spacing().button_padding.x
}

/// Draws the time from right to left: frames, seconds.
fn time(ui: &mut Ui, context: &PanelContext<'_>, room: Room, requests: &mut Vec<Request>) {
    let theme = Theme::of(ui);
    let rate = context.frames_per_second();
    let (start, length) = context.take_bounds();
    let mut frame = ruler::frame_of(context.time(), rate);
    let last = format!("/ {}", ruler::frame_of(start + length, rate));
    // Long numbers need the room of the last frame's number themselves.
    let fields = [format!("{frame}"), format!("{:.3} s", context.time())].map(|text| field_width(ui, &text));
    // The frame is large, the time small.
    let frame_width = (fields[0] * FRAME_DIGITS / style::NUMBER).max(FRAME);
    let time_width = (fields[1] * style::SMALL / style::NUMBER).max(TIME);
    let needed = frame_width + time_width + text_width(ui, &last, &TextStyle::Monospace);
    if ui.available_width() > needed + 3.0 * ui.spacing().item_spacing.x {
        ui.label(RichText::new(last).monospace().color(theme.weak));
    }
    let field = DragValue::new(&mut frame)
        .range(ruler::frame_of(start.min(0.0), rate)..=ruler::frame_of(LATEST, rate))
        .speed(0.2)
        .update_while_editing(false)
        .custom_parser(number);
    let large = |ui: &mut Ui| {
        ui.style_mut().override_font_id = Some(FontId::monospace(FRAME_DIGITS));
        ui.add_sized(vec2(FRAME, CONTROL), field).accessible_name("Frame")
    };
    let response = ui.scope(large).inner;
    if response
        .on_hover_text(
            "Frame\nDrag, or click to type an expression such as 3*30+12; frames after the end are allowed",
        )
        .changed()
    {
        requests.push(Request::Seek(ruler::time_of(frame, rate)));
    }
    if room < Room::Seconds {
        return;
    }
    let mut seconds = context.time();
    let field = DragValue::new(&mut seconds)
        .range(start.min(0.0)..=LATEST)
        .speed(0.005)
        .fixed_decimals(3)
        .suffix(" s")
        .update_while_editing(false)
        .custom_parser(number);
    let small = |ui: &mut Ui| {
        ui.style_mut().override_font_id = Some(FontId::monospace(style::SMALL));
        ui.add_sized(vec2(TIME, CONTROL), field).accessible_name("Time")
    };
    let response = ui.scope(small).inner;
    if response.on_hover_text("Time in seconds\nDrag, or click to type an expression such as 45/30").changed()
    {
        requests.push(Request::Seek(seconds));
    }
}

/// Parses the text of a field: a number or an expression, with or without the unit that the field shows.
fn number(text: &str) -> Option<f64> {
    let text = text.trim().trim_end_matches(['s', '×']);
    evaluate(text, Quantity::Number).ok()
}

fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(13.0, 16.0), egui::Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), egui::Stroke::new(1.0, Theme::of(ui).line));
}
