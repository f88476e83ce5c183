//! The strip of heat: the largest distance at each time, from left to right.

use super::profile::ShownProfile;
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::ruler::Ruler;
use crate::panels::style::{GRID, RADIUS};
use crate::panels::theme::Theme;
use egui::{Color32, Rect, Sense, Stroke, Ui, pos2, vec2};

/// Height of the strip, points.
const HEIGHT: f32 = 30.0;

/// Draws the strip with the playhead. A click or a drag goes to a time.
pub(super) fn show(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    profile: &ShownProfile,
    requests: &mut Vec<Request>,
) {
    let theme = Theme::of(ui);
    let size = vec2(ui.available_width(), HEIGHT + 2.0 * GRID);
    let (outer, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let rect = outer.shrink2(vec2(3.0 * GRID, GRID));
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::Meter, true, "Differences over time".to_owned())
    });
    let painter = ui.painter();
    painter.rect_filled(rect, f32::from(RADIUS), theme.sunken);
    let (Some(&start), Some(&end)) = (profile.times().first(), profile.times().last()) else { return };
    let ruler = Ruler { left: rect.left(), width: rect.width(), start, length: end - start };
    let step = rect.width() / profile.times().len() as f32;
    for (at, part) in profile.parts().enumerate() {
        let left = rect.left() + step * at as f32;
        // Height and color both say how large it is, for eyes that see few colors.
        let top = rect.bottom() - rect.height() * (0.08 + 0.92 * part);
        let bar = Rect::from_min_max(pos2(left, top), pos2(left + step, rect.bottom()));
        if part > 0.0 {
            painter.rect_filled(bar, 0.0, heat(theme, part));
        }
    }
    let x = ruler.x_of(context.time());
    painter.vline(x, rect.y_range(), Stroke::new(1.5, theme.accent));
    let pointed = response.hover_pos().map(|at| ruler.time_at(at.x));
    if let Some(time) = pointed.filter(|_| response.is_pointer_button_down_on() || response.clicked()) {
        requests.push(Request::Seek(time));
    }
    if let Some(text) = pointed.and_then(|time| profile.text_at(time, context)) {
        response.on_hover_text(text);
    }
}

/// Returns the color of a part of the largest distance: from calm to alarming.
fn heat(theme: &Theme, part: f32) -> Color32 {
    let (low, high) = if part < 0.5 { (theme.weak, theme.warning) } else { (theme.warning, theme.error) };
    let part = (part * 2.0).fract().max(if part >= 1.0 { 1.0 } else { 0.0 });
    low.lerp_to_gamma(high, part)
}
