//! The image of the camera through which the viewport looks: its titles, edges, thirds and safe areas.

use crate::panels::context::PanelContext;
use crate::panels::style;
use dragonfly_anim::stage::ShownTitle;
use dragonfly_picture::{ThroughCamera, TitleLook};
use egui::accesskit::Role;
use egui::{Color32, FontId, Painter, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2};
use std::sync::Arc;

/// Parts of the image in which everything that happens, and every title, is safe from being cut off.
const SAFE: [f32; 2] = [0.93, 0.9];

/// Draws the edges of the image and darkens what is outside of it; nothing while the viewport looks through the free camera.
pub(super) fn show(ui: &Ui, rect: Rect, context: &PanelContext<'_>) {
    if *context.through != ThroughCamera::Free {
        frame(ui, rect, context);
    }
}

/// Draws the edges of the image of a camera of the scene in a rectangle, and darkens what is outside of it.
pub(super) fn frame(ui: &Ui, rect: Rect, context: &PanelContext<'_>) {
    let Some(script) = context.scene().and_then(|scene| scene.script.as_ref()) else { return };
    let image = image_of(rect, script.size());
    let painter = ui.painter().with_clip_rect(rect);
    let outside = Color32::from_black_alpha(110);
    for part in [
        Rect::from_min_max(rect.min, egui::pos2(rect.right(), image.top())),
        Rect::from_min_max(egui::pos2(rect.left(), image.bottom()), rect.max),
        Rect::from_min_max(egui::pos2(rect.left(), image.top()), image.left_bottom()),
        Rect::from_min_max(image.right_top(), egui::pos2(rect.right(), image.bottom())),
    ] {
        if part.is_positive() {
            painter.rect_filled(part, 0.0, outside);
        }
    }
    let edge = Stroke::new(1.0, Color32::from_white_alpha(150));
    painter.rect_stroke(image, 0.0, edge, StrokeKind::Outside);
    if context.settings.look.image_guides {
        guides(&painter, image);
    }
    // Over the guides, which would strike them through.
    titles(ui, image, context);
}

/// Draws the thirds and the safe areas of an image.
fn guides(painter: &Painter, image: Rect) {
    let line = Stroke::new(1.0, Color32::from_white_alpha(38));
    for third in [1.0 / 3.0, 2.0 / 3.0] {
        painter.vline(image.left() + image.width() * third, image.y_range(), line);
        painter.hline(image.x_range(), image.top() + image.height() * third, line);
    }
    for part in SAFE {
        let safe = Rect::from_center_size(image.center(), image.size() * part);
        painter.rect_stroke(safe, 2.0, line, StrokeKind::Inside);
    }
}

/// Draws the titles at the time shown into an image, as movies have them.
fn titles(ui: &Ui, image: Rect, context: &PanelContext<'_>) {
    let Some(plan) = context.scene().and_then(|scene| scene.plan.as_ref()) else { return };
    let mut shown = Vec::new();
    plan.shown_titles(context.scene_time(), &mut shown);
    let look = TitleLook::of(image.height());
    // Letters outside of the image are cut off.
    let painter = ui.painter().with_clip_rect(image);
    for ShownTitle { title: index, weight } in shown {
        let Some(title) = plan.titles().get(index) else { continue };
        let font = FontId::new(look.size, style::title_font());
        let galley = painter.layout_no_wrap(title.text.to_string(), font, Color32::WHITE);
        let middle = image.min + vec2(title.at[0], title.at[1]) * image.size();
        let corner = middle - galley.size() / 2.0;
        let faded = |color: Color32, opacity: f32| color.gamma_multiply(opacity.clamp(0.0, 1.0));
        let shadow = faded(Color32::BLACK, look.shadow_opacity * weight);
        let place = Rect::from_min_size(corner, galley.size());
        painter.galley_with_override_text_color(
            corner + vec2(look.shadow, look.shadow),
            Arc::clone(&galley),
            shadow,
        );
        painter.galley_with_override_text_color(corner, galley, faded(Color32::WHITE, weight));
        let response =
            ui.interact(place, ui.scope_id().with(("title", index, image.left() as i32)), Sense::hover());
        let name = format!("Title: {}", title.text);
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &name));
    }
}

/// Returns the place of an image of this size in a viewport: as large as it fits, in the middle.
pub(super) fn image_of(viewport: Rect, [width, height]: [u32; 2]) -> Rect {
    let aspect = width.max(1) as f32 / height.max(1) as f32;
    let size = vec2(
        viewport.width().min(viewport.height() * aspect),
        viewport.height().min(viewport.width() / aspect),
    );
    Rect::from_center_size(viewport.center(), size)
}
