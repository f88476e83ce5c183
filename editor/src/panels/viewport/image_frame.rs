//! The image of the camera through which the viewport looks: its edges, thirds and safe areas.

use crate::panels::context::PanelContext;
use dragonfly_picture::ThroughCamera;
use egui::{Color32, Rect, Stroke, StrokeKind, Ui, vec2};

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
    if !context.settings.look.image_guides {
        return;
    }
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

/// Returns the place of an image of this size in a viewport: as large as it fits, in the middle.
pub(super) fn image_of(viewport: Rect, [width, height]: [u32; 2]) -> Rect {
    let aspect = width.max(1) as f32 / height.max(1) as f32;
    let size = vec2(
        viewport.width().min(viewport.height() * aspect),
        viewport.height().min(viewport.width() / aspect),
    );
    Rect::from_center_size(viewport.center(), size)
}
