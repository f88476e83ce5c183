//! The switch for the scope of edits, next to auto-key, and its menu, which number fields and the menu of poses show as well.

use super::commands::{self, Id};
use super::context::PanelContext;
use super::edit_scope::{EditScope, FalloffSettings, shape_title};
use super::icons::Icon;
use super::menu;
use super::request::Request;
use super::style::{GRID, RADIUS, icon_size};
use super::theme::Theme;
use super::widgets::{focus_ring, text_width};
use dragonfly_document::edit::FadeShape;
use egui::accesskit::Role;
use egui::{Button, Color32, CornerRadius, DragValue, Rect, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2};

/// The commands for the scope of edits, which have a menu of their own.
pub(super) const COMMANDS: [Id; 9] = [
    Id::EditFrame,
    Id::EditSelectedKeys,
    Id::EditPlayRange,
    Id::EditWholeTake,
    Id::NextEditScope,
    Id::ToggleFalloff,
    Id::WiderFalloff,
    Id::NarrowerFalloff,
    Id::NextFalloffShape,
];

/// Returns the name of the scope as the switch shows it in a bar of this width, points: nothing where that is small. The name
/// of a scope that changes more than this frame comes before less important parts of the bar.
pub(super) fn title_in(context: &PanelContext<'_>, width: f32) -> &'static str {
    let scope = context.over.scope;
    let needed = if scope == EditScope::Frame { 900.0 } else { 500.0 };
    if width > needed { scope.title() } else { "" }
}

/// Returns the width of the switch with this name, points.
pub(super) fn width(ui: &Ui, title: &str) -> f32 {
    let words = if title.is_empty() { 0.0 } else { text_width(ui, title, &TextStyle::Small) + GRID };
    icon_size().x + words + 12.0
}

/// Draws the switch: its icon and `title`, in the color of a warning where edits change more than this frame.
pub(super) fn switch(ui: &mut Ui, context: &PanelContext<'_>, title: &str, requests: &mut Vec<Request>) {
    let scope = context.over.scope;
    let (theme, wary) = (Theme::of(ui), scope != EditScope::Frame);
    let font = TextStyle::Small.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(title.to_owned(), font, Color32::PLACEHOLDER);
    let size = vec2(width(ui, title), icon_size().y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let name = format!("Edits apply to: {}", scope.title());
    response.widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), wary, name.as_str()));
    let color = match () {
        () if wary => theme.warning,
        () if response.hovered() => theme.text,
        () => theme.weak,
    };
    if wary {
        ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), theme.warning.gamma_multiply(0.14));
    } else if response.hovered() {
        ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), theme.hover);
    }
    Icon::EditScope.paint(ui.painter(), Rect::from_min_size(rect.min, icon_size()), color);
    let at = pos2(rect.left() + icon_size().x, rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, color);
    let arrow = Rect::from_center_size(pos2(rect.right() - 8.0, rect.center().y), vec2(12.0, 12.0));
    Icon::Down.paint(ui.painter(), arrow, color);
    focus_ring(ui, &response, rect);
    let keys = commands::shortcut_text(ui.ctx(), Id::NextEditScope);
    let hint = format!(
        "Edits apply to: {} ({keys}: next)\nGizmo, numbers, IK, shape keys and pasted poses offset all of these keys by the same amount",
        scope.title()
    );
    let response = response.on_hover_text(hint);
    egui::Popup::menu(&response).show(|ui| entries(ui, context, requests));
}

/// Draws the entries: the scopes, and the falloff.
pub(super) fn entries(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.set_min_width(220.0);
    for scope in EditScope::ALL {
        menu::item(ui, context, scope.command(), scope == context.over.scope, requests);
    }
    ui.separator();
    falloff(ui, context, requests);
}

/// Draws all commands for the scope and the falloff.
pub(super) fn all_entries(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    entries(ui, context, requests);
    ui.separator();
    for id in [Id::NextEditScope, Id::WiderFalloff, Id::NarrowerFalloff, Id::NextFalloffShape] {
        menu::item(ui, context, id, false, requests);
    }
}

/// Draws the entries for the falloff.
pub(super) fn falloff(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    menu::item(ui, context, Id::ToggleFalloff, context.over.falloff, requests);
    menu::outline_fields(ui);
    let now = context.settings.falloff;
    let mut new = now;
    ui.horizontal(|ui| {
        ui.add_space(GRID);
        let field = DragValue::new(&mut new.frames).range(1..=FalloffSettings::MOST).speed(0.2);
        let field = ui.add(field.update_while_editing(false));
        let label = ui.label("frames");
        field.labelled_by(label.id).on_hover_text("Distance at which nothing of an edit is left");
    });
    for shape in FadeShape::ALL {
        let button = Button::selectable(shape == now.shape, shape_title(shape));
        if ui.add(button).clicked() {
            new.shape = shape;
        }
    }
    if new != now {
        requests.push(Request::Falloff(new));
    }
}
