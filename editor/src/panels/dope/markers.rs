//! The lane of markers below the ruler.

use super::lane_drag::MarkDrag;
use super::sheet::Sheet;
use crate::panels::context::PanelContext;
use crate::panels::keys::{KeysRequest, MarkerAction, TimeScale};
use crate::panels::name_field::{NameField, NameFieldEnd};
use crate::panels::request::Request;
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_picture::between;
use egui::{
    Button, CornerRadius, CursorIcon, PointerButton, Rect, Sense, Shape, Stroke, TextStyle, Ui, WidgetInfo,
    pos2, vec2,
};

/// The marker that is dragged or renamed.
#[derive(Debug, Default)]
pub(super) struct MarkerLane {
    renaming: Option<(usize, NameField)>,
    drag: MarkDrag,
}

impl MarkerLane {
    pub(super) fn show(&mut self, ui: &mut Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
        let Sheet { areas, scale, context, .. } = *sheet;
        let lane = areas.markers;
        if lane.height() < 4.0 {
            *self = Self::default();
            return;
        }
        let theme = Theme::of(ui);
        ui.painter().rect_filled(lane, CornerRadius::ZERO, theme.bar);
        let painter = ui.painter().with_clip_rect(lane);
        let markers = context.markers();
        let mut ask = |action: MarkerAction| requests.push(Request::Timeline(KeysRequest::Marker(action)));
        let mut seek = None;
        for (index, marker) in markers.iter().enumerate() {
            let time = self.drag.time_of(index, marker.time);
            let x = scale.x_of(time);
            let end = markers.get(index + 1).map_or(f32::INFINITY, |next| scale.x_of(next.time));
            let grip = Rect::from_min_max(
                pos2(x - 5.0, lane.top()),
                pos2((x + 64.0).min(end - 5.0).max(x + 6.0), lane.bottom()),
            );
            if grip.right() < lane.left() || grip.left() > lane.right() {
                continue;
            }
            let response = ui.interact(
                grip.intersect(lane),
                ui.scope_id().with(("marker", index)),
                Sense::click_and_drag(),
            );
            response.widget_info(|| {
                WidgetInfo::labeled(egui::accesskit::Role::Button, true, format!("Marker {}", marker.name))
            });
            let lit = response.hovered() || response.dragged();
            let color = if lit { theme.warning } else { theme.warning.gamma_multiply(0.85) };
            let flag =
                vec![pos2(x, lane.top() + 2.0), pos2(x + 6.0, lane.top() + 5.5), pos2(x, lane.top() + 9.0)];
            painter.vline(x, lane.y_range(), Stroke::new(1.0, color));
            painter.add(Shape::convex_polygon(flag, color, Stroke::NONE));
            let name = Rect::from_min_max(
                pos2(x + 9.0, lane.top()),
                pos2((end - 6.0).min(lane.right()), lane.bottom()),
            );
            if name.width() > 12.0 {
                widgets::text_in(ui, name, &marker.name, &TextStyle::Small, theme.weak);
            }
            let response = response.on_hover_cursor(CursorIcon::PointingHand).on_hover_text(format!(
                "{}\n{time:.3} s\nClick to move the playhead here, drag to move, double-click to rename",
                marker.name
            ));
            if response.clicked_by(PointerButton::Primary) {
                seek = Some(marker.time);
            }
            if response.double_clicked() {
                self.renaming = Some((index, NameField::of(&marker.name)));
            }
            if let Some(time) = self.drag.step_mark(ui, sheet, (index, marker.time), &response) {
                ask(MarkerAction::Move(index, time));
            }
            response.context_menu(|ui| {
                if ui.add(Button::new("Rename").frame_when_inactive(false)).clicked() {
                    self.renaming = Some((index, NameField::of(&marker.name)));
                    ui.close();
                }
                if ui.add(Button::new("Delete marker").frame_when_inactive(false)).clicked() {
                    ask(MarkerAction::Delete(index));
                    ui.close();
                }
            });
        }
        if let Some(action) = self.rename(ui, lane, scale, context) {
            ask(action);
        }
        if let Some(time) = seek {
            requests.push(Request::Seek(time));
        }
    }

    /// Draws the field for the name of a marker. Returns the action when the name is entered.
    fn rename(
        &mut self,
        ui: &mut Ui,
        lane: Rect,
        scale: &TimeScale,
        context: &PanelContext<'_>,
    ) -> Option<MarkerAction> {
        let (index, field) = self.renaming.as_mut()?;
        let Some(marker) = context.markers().get(*index) else {
            self.renaming = None;
            return None;
        };
        let left = between(scale.x_of(marker.time), lane.left(), lane.right() - 120.0);
        let rect = Rect::from_min_size(pos2(left, lane.top() - 3.0), vec2(120.0, lane.height() + 6.0));
        let end = field.show(ui, rect, "Name of the marker", TextStyle::Small);
        if end == NameFieldEnd::Open {
            return None;
        }
        let (index, field) = self.renaming.take()?;
        let action = MarkerAction::Rename(index, field.text().to_owned());
        (end != NameFieldEnd::GivenUp).then_some(action)
    }
}
