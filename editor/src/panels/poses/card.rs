//! The card of a pose: its picture and its name.

use crate::panels::drag::{DragEvent, PanelDrag, PointerInput, readout};
use crate::panels::style::{GRID, RADIUS};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_document::PoseFile;
use dragonfly_document::posing::StickLine;
use egui::accesskit::Role;
use egui::{
    Color32, CornerRadius, CursorIcon, Id, PointerButton, Rect, Response, Sense, Stroke, StrokeKind,
    TextStyle, Ui, WidgetInfo, pos2, vec2,
};

/// Size of a card, points.
pub(super) const CARD: [f32; 2] = [84.0, 100.0];
/// Distance of a drag that blends from 0 to 100 %, points.
const WHOLE: f32 = 120.0;

/// A pose as its card shows it.
pub(super) struct Card<'a> {
    pub(super) file: &'a PoseFile,
    pub(super) figure: &'a [StickLine],
    pub(super) is_chosen: bool,
    /// Amount of the blend towards it, 0 to 1, while it is dragged.
    pub(super) amount: Option<f32>,
}

/// An action of the user on a card.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CardEvent {
    Nothing,
    Clicked,
    Applied,
    /// Dragged sideways: blends by this amount, 0 to 1.
    Blended(f32),
    Released,
    Cancelled,
}

impl Card<'_> {
    pub(super) fn show(&self, ui: &mut Ui) -> (CardEvent, Response) {
        let (rect, _) = ui.allocate_exact_size(vec2(CARD[0], CARD[1]), Sense::hover());
        let id = Id::unique(("pose card", &self.file.file));
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let name = &self.file.pose.name;
        response.widget_info(|| WidgetInfo::selected(Role::ListItem, ui.is_enabled(), self.is_chosen, name));
        self.paint(ui, rect, &response);
        let event = self.event(ui, &response);
        let bones = widgets::count(self.file.pose.poses.len(), "bone", "bones");
        let tags = self.file.pose.tags.join(", ");
        let about = if tags.is_empty() { bones } else { widgets::dot_separated(&[bones, tags]) };
        let help = "Double-click to apply it to the selected bones, drag sideways to blend";
        (event, response.on_hover_text(format!("{}\n{about}\n{help}", widgets::shortened(name))))
    }

    fn event(&self, ui: &Ui, response: &Response) -> CardEvent {
        type CardDrag = PanelDrag<(), f32>;
        if response.double_clicked() {
            return CardEvent::Applied;
        }
        let id = response.id.with("drag");
        let pointer = response.interact_pointer_pos();
        if response.drag_started_by(PointerButton::Primary)
            && let Some(origin) = ui.input(|input| input.pointer.press_origin())
        {
            ui.data_mut(|data| data.insert_temp(id, CardDrag::dragging(origin.x)));
        }
        let Some(mut drag) = ui.data(|data| data.get_temp::<CardDrag>(id)) else {
            return if response.clicked() { CardEvent::Clicked } else { CardEvent::Nothing };
        };
        let input = PointerInput::of_widget(ui, response);
        let event = match drag.step(&input, input.primary_down, |_| ()) {
            DragEvent::Moved(_) => match (drag.drag(), pointer) {
                (Some(from), Some(pointer)) => {
                    ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
                    let amount = ((pointer.x - from) / WHOLE).clamp(0.0, 1.0);
                    readout(ui, pointer, &format!("{:.0} %", 100.0 * amount));
                    CardEvent::Blended(amount)
                }
                _ => CardEvent::Nothing,
            },
            DragEvent::Dropped(_) => CardEvent::Released,
            DragEvent::Cancelled(_) => CardEvent::Cancelled,
            DragEvent::Nothing | DragEvent::Pressed | DragEvent::Started(_) | DragEvent::Clicked(_) => {
                CardEvent::Nothing
            }
        };
        ui.data_mut(|data| {
            if drag.is_busy() {
                data.insert_temp(id, drag);
            } else {
                data.remove::<CardDrag>(id);
            }
        });
        event
    }

    fn paint(&self, ui: &Ui, rect: Rect, response: &Response) {
        let theme = Theme::of(ui);
        let fill = match () {
            () if self.is_chosen => theme.accent_soft,
            () if response.hovered() => theme.hover,
            () => Color32::TRANSPARENT,
        };
        let painter = ui.painter();
        painter.rect_filled(rect, CornerRadius::same(RADIUS), fill);
        painter.rect_stroke(
            rect,
            CornerRadius::same(RADIUS),
            Stroke::new(1.0, theme.line),
            StrokeKind::Inside,
        );
        widgets::focus_ring(ui, response, rect);
        let side = rect.width() - 4.0 * GRID;
        let picture = Rect::from_min_size(rect.min + vec2(2.0 * GRID, GRID), vec2(side, side));
        let at = |place: [f32; 2]| picture.min + vec2(place[0] * side, place[1] * side);
        // Bones of the pose are drawn over the others.
        for posed in [false, true] {
            let color = if posed { theme.accent } else { theme.faint };
            let stroke = Stroke::new(if posed { 2.0 } else { 1.0 }, color);
            for line in self.figure.iter().filter(|line| line.posed == posed) {
                painter.line_segment([at(line.from), at(line.to)], stroke);
            }
        }
        if let Some(amount) = self.amount {
            let bar = Rect::from_min_size(
                pos2(picture.left(), picture.bottom() - 3.0),
                vec2(side * amount.clamp(0.0, 1.0), 3.0),
            );
            painter.rect_filled(bar, CornerRadius::same(1), theme.accent);
        }
        let text =
            Rect::from_min_max(pos2(rect.left() + GRID, picture.bottom() + 2.0), rect.max - vec2(GRID, 2.0));
        let name = widgets::cut_in_middle(ui, &self.file.pose.name, text.width(), &TextStyle::Small);
        widgets::text_in(ui, text, &name, &TextStyle::Small, theme.text);
    }
}
