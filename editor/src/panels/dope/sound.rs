//! The lane of the sound: its waveform, which a drag moves in time.

use super::head::to_frame;
use super::lane_drag::MarkDrag;
use super::sheet::Sheet;
use crate::panels::commands::Id;
use crate::panels::menu;
use crate::panels::request::Request;
use crate::panels::sound::{SoundSettings, SoundTrack};
use crate::panels::waveform::{Waveform, WaveformLook};
use crate::panels::widgets;
use egui::accesskit::Role;
use egui::{CornerRadius, CursorIcon, Rect, Sense, TextStyle, Ui, WidgetInfo, vec2};
use std::sync::Arc;

/// The lane.
#[derive(Debug, Default)]
pub(super) struct SoundLane {
    waveform: Waveform,
    drag: MarkDrag,
}

impl SoundLane {
    /// Draws the lane. A drag moves the sound by whole frames.
    pub(super) fn show(&mut self, ui: &Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
        let Sheet { areas, context, scale, theme, .. } = *sheet;
        let lane = areas.sound;
        if lane.height() < 4.0 {
            return;
        }
        let sound = context.sound;
        ui.painter().rect_filled(lane, CornerRadius::ZERO, theme.bar);
        let rate = context.frame_rate.max(1) as f32;
        let own = sound.settings().start as f32 / rate;
        let response = ui.interact(lane, ui.scope_id().with("sound"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Sound"));
        // The press may be anywhere on the sound, so the distance of the pointer counts.
        let pressed = ui.input(|input| input.pointer.press_origin()).map(|at| scale.time_at(at.x));
        let moved = self.drag.step(
            ui,
            (0, &response),
            |_| sound.peaks().map(|_| (0, own)),
            |_, _, at| (0, to_frame(own + scale.time_at(at.x) - pressed.unwrap_or_default(), context)),
        );
        if let Some((_, start)) = moved {
            let start = (start * rate).round() as i32;
            requests.push(Request::Sound(SoundSettings { start, ..sound.settings().clone() }));
        }
        let start = self.drag.time_of(0, own);
        if let Some(peaks) = sound.peaks() {
            let look = WaveformLook {
                peaks: Arc::clone(peaks),
                start: f64::from(start),
                times: 1.0,
                scale: *scale,
                rect: lane.shrink2(vec2(0.0, 1.0)),
                pixels_per_point: ui.ctx().pixels_per_point(),
                color: if response.hovered() || response.dragged() { theme.text } else { theme.weak },
            };
            self.waveform.show(ui.painter(), look);
        }
        let text = caption(sound);
        let place = Rect::from_min_size(lane.min + vec2(4.0, 0.0), vec2((lane.width() - 8.0).max(0.0), 12.0));
        let color = if sound.problem().is_some() { theme.warning } else { theme.faint };
        let cut = widgets::cut_in_middle(ui, &text, place.width(), &TextStyle::Small);
        widgets::text_in(ui, place, &cut, &TextStyle::Small, color);
        let frame = (start * rate).round() as i32;
        let hint = match (sound.problem(), sound.peaks()) {
            (Some(problem), _) => format!("{problem}\nRight-click to choose another sound"),
            (None, None) => format!("{text}\nThe sound is being read"),
            (None, Some(peaks)) => format!(
                "{text}\nStarts at frame {frame}, {:.2} s long, {} at {} Hz\n\
                 Drag to move it, right-click for more\nIt is only shown: this program plays no sound",
                peaks.seconds(),
                widgets::count(peaks.channels(), "channel", "channels"),
                peaks.rate(),
            ),
        };
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(hint);
        response.context_menu(|ui| {
            menu::item(ui, context, Id::ChooseSound, false, requests);
            menu::item(ui, context, Id::SoundToPlayhead, false, requests);
            menu::item(ui, context, Id::RemoveSound, false, requests);
        });
    }
}

/// Returns the text in the lane: the name of the file, or what is wrong with it.
fn caption(sound: &SoundTrack) -> String {
    match sound.problem() {
        Some(problem) => problem.to_owned(),
        None => sound.settings().file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
    }
}
