//! The lane of the sound: its waveform, which a drag moves in time.

use super::head::to_frame;
use super::lane_drag::MarkDrag;
use super::sheet::Sheet;
use crate::panels::commands::Id;
use crate::panels::keys::TimeScale;
use crate::panels::menu;
use crate::panels::request::Request;
use crate::panels::sound::{SoundSettings, SoundTrack};
use crate::panels::widgets;
use dragonfly_document::SoundPeaks;
use egui::accesskit::Role;
use egui::{
    Color32, CornerRadius, CursorIcon, Mesh, Rect, Sense, Shape, TextStyle, Ui, WidgetInfo, pos2, vec2,
};
use std::sync::Arc;

/// The lane, with the triangles of the waveform, rebuilt only when something that they depend on changed.
#[derive(Debug, Default)]
pub(super) struct SoundLane {
    made_of: Option<WaveformKey>,
    mesh: Arc<Mesh>,
    drag: MarkDrag,
}

/// Everything that the triangles depend on.
#[derive(Debug)]
struct WaveformKey {
    peaks: Arc<SoundPeaks>,
    start: f32,
    scale: TimeScale,
    lane: Rect,
    pixels_per_point: f32,
    color: Color32,
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
            let key = WaveformKey {
                peaks: Arc::clone(peaks),
                start,
                scale: *scale,
                lane,
                pixels_per_point: ui.ctx().pixels_per_point(),
                color: if response.hovered() || response.dragged() { theme.text } else { theme.weak },
            };
            self.waveform(ui, key);
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

    fn waveform(&mut self, ui: &Ui, key: WaveformKey) {
        if !self.made_of.as_ref().is_some_and(|old| old.same(&key)) {
            self.mesh = Arc::new(key.mesh());
            self.made_of = Some(key);
        }
        let painter = ui.painter().with_clip_rect(ui.clip_rect());
        painter.add(Shape::Mesh(Arc::clone(&self.mesh)));
    }
}

/// Returns the text in the lane: the name of the file, or what is wrong with it.
fn caption(sound: &SoundTrack) -> String {
    match sound.problem() {
        Some(problem) => problem.to_owned(),
        None => sound.settings().file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
    }
}

impl WaveformKey {
    /// Compares without reading the peaks.
    fn same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.peaks, &other.peaks)
            && (self.start, self.scale, self.lane) == (other.start, other.scale, other.lane)
            && (self.pixels_per_point, self.color) == (other.pixels_per_point, other.color)
    }

    /// Returns a bar from the least to the greatest sample in every column of pixels.
    fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let (middle, half) = (self.lane.center().y, self.lane.height() / 2.0 - 1.0);
        let step = 1.0 / self.pixels_per_point.max(0.1);
        let columns = (self.lane.width() / step).max(0.0) as usize;
        for column in 0..columns.min(20_000) {
            let x = self.lane.left() + column as f32 * step;
            let [from, to] = [x, x + step].map(|x| f64::from(self.scale.time_at(x)) - f64::from(self.start));
            let Some([low, high]) = self.peaks.between(from, to) else { continue };
            let thin = (0.5 - half * (high - low) / 2.0).max(0.0);
            let (top, bottom) = (middle - half * high - thin, middle - half * low + thin);
            mesh.add_colored_rect(Rect::from_min_max(pos2(x, top), pos2(x + step, bottom)), self.color);
        }
        mesh
    }
}
