//! The ruler of a scene: frames or seconds, and the drag of the playhead.

use super::sheet::SceneSheet;
use super::snap::{frame_at, snapped_time};
use crate::panels::commands::Id;
use crate::panels::dope::{self, Scrub, ScrubRuler};
use crate::panels::menu::item;
use crate::panels::request::Request;
use dragonfly_anim::stage::time::StageTime;
use egui::{CornerRadius, Painter, Stroke, Ui};

/// Height of the ruler.
pub(super) const HEIGHT: f32 = 24.0;

/// Draws the ruler and follows the drag of the playhead.
pub(super) fn show(
    scrub: &mut Scrub,
    ui: &Ui,
    painter: &Painter,
    sheet: &SceneSheet<'_>,
    requests: &mut Vec<Request>,
) {
    let (head, context, scale, theme) = (sheet.head, sheet.context, sheet.scale, sheet.theme);
    painter.rect_filled(head, CornerRadius::ZERO, theme.bar);
    painter.hline(head.x_range(), head.bottom(), Stroke::new(1.0, theme.line));
    let inside = painter.with_clip_rect(head.intersect(painter.clip_rect()));
    dope::ticks(&inside, head, head.bottom(), scale, context, theme);
    let ruler = ScrubRuler { head, name: "Time of the scene", scale, context };
    let seconds = |time: f32, snaps: bool| {
        let rate = sheet.scene.script.as_ref()?.rate();
        let time = StageTime::from_seconds(f64::from(time).max(0.0));
        let reach = StageTime::from_seconds(f64::from(scale.seconds(4.0)));
        let snapped =
            if snaps { snapped_time(time, sheet.lanes, frame_at(time, rate), reach, rate) } else { time };
        Some(context.playhead_at(snapped))
    };
    let response = scrub.follow(ui, &ruler, seconds, requests);
    if response.double_clicked() {
        requests.push(Request::Command(Id::FitScene));
    }
    response.context_menu(|ui| {
        for id in [Id::LoopFromHere, Id::LoopToHere, Id::LoopActions, Id::LoopWhole] {
            item(ui, context, id, false, requests);
        }
        ui.separator();
        item(ui, context, Id::FitScene, false, requests);
        item(ui, context, Id::ToggleSnap, context.keys.snap(), requests);
        item(ui, context, Id::ToggleRulerSeconds, context.keys.ruler_in_seconds(), requests);
    });
    dope::range_ends(ui, head, scale, context, requests);
    dope::wheel(ui, &response, scale, requests);
}
