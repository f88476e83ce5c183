//! The ruler of a scene: frames or seconds, and the drag of the playhead.

use super::sheet::SceneSheet;
use super::snap::{frame_at, snapped_time};
use crate::panels::commands::Id;
use crate::panels::dope;
use crate::panels::menu::item;
use crate::panels::request::Request;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_picture::between;
use egui::{CornerRadius, CursorIcon, Painter, PointerButton, Sense, Stroke, Ui, WidgetInfo};

/// Height of the ruler.
pub(super) const HEIGHT: f32 = 24.0;

/// The drag of the playhead.
#[derive(Debug, Default)]
pub(super) struct SceneScrub {
    /// The command that resumes playback after scrubbing.
    resume: Option<Id>,
}

impl SceneScrub {
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        painter: &Painter,
        sheet: &SceneSheet<'_>,
        requests: &mut Vec<Request>,
    ) {
        let (head, context, scale, theme) = (sheet.head, sheet.context, sheet.scale, sheet.theme);
        painter.rect_filled(head, CornerRadius::ZERO, theme.bar);
        painter.hline(head.x_range(), head.bottom(), Stroke::new(1.0, theme.line));
        dope::ticks(
            &painter.with_clip_rect(head.intersect(painter.clip_rect())),
            head,
            head.bottom(),
            scale,
            context,
            theme,
        );
        let name = "Time of the scene";
        let response = ui.interact(head, ui.scope_id().with(name), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::slider(true, f64::from(context.time()), name));
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        let (primary, modifiers) = ui.input(|input| (input.pointer.primary_down(), input.modifiers));
        let down = response.is_pointer_button_down_on() && primary;
        if down && context.playback.playing && self.resume.is_none() {
            // Playback pauses while the pointer is down.
            let command = if context.playback.speed < 0.0 { Id::PlayBackwards } else { Id::PlayPause };
            self.resume = Some(command);
            requests.push(Request::Command(command));
        }
        if (down || response.clicked_by(PointerButton::Primary))
            && let Some(pointer) = response.interact_pointer_pos()
            && let Some(script) = &sheet.scene.script
        {
            let window = scale.window;
            let time =
                between(f64::from(scale.time_at(pointer.x)), window.start, window.start + window.length);
            let time = StageTime::from_seconds(time.max(0.0));
            let reach = StageTime::from_seconds(f64::from(scale.seconds(4.0)));
            // No action has the number 0: all ends count.
            let snapped = match context.keys.snap() != modifiers.command {
                true => {
                    snapped_time(time, sheet.lanes, 0, frame_at(time, script.rate()), reach, script.rate())
                }
                false => time,
            };
            requests.push(Request::Seek(snapped.seconds() as f32));
        }
        if !down && let Some(command) = self.resume.take() {
            requests.push(Request::Command(command));
        }
        if response.double_clicked() {
            requests.push(Request::Command(Id::FitScene));
        }
        response.context_menu(|ui| {
            item(ui, context, Id::FitScene, false, requests);
            item(ui, context, Id::ToggleSnap, context.keys.snap(), requests);
            item(ui, context, Id::ToggleRulerSeconds, context.keys.ruler_in_seconds(), requests);
        });
        dope::wheel(ui, &response, scale, requests);
    }
}
