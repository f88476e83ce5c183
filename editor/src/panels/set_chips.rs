//! The selection sets of the model as a row of chips: a click selects the bones of a set.

use super::context::PanelContext;
use super::request::Request;
use super::selection_sets::{COLORS, SelectionSet, SetAction};
use super::style::GRID;
use super::theme::Theme;
use super::widgets;
use egui::accesskit::Role;
use egui::{
    Align2, Button, Color32, CornerRadius, Frame, Key, Margin, Response, Sense, TextEdit, TextStyle, Ui,
    WidgetInfo, pos2, vec2,
};

/// Height of a chip, points.
const HEIGHT: f32 = 20.0;
/// Largest width of the name of a chip, points.
const NAME: f32 = 120.0;

/// Draws the chips; nothing without sets.
pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    if context.sets.list().is_empty() {
        return;
    }
    let margin = Margin::symmetric(2 * GRID as i8, 0);
    Frame::NONE.inner_margin(margin).show(ui, |ui| chips(ui, context, requests));
    ui.add_space(GRID);
}

fn chips(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(GRID, GRID);
        for (at, set) in context.sets.list().iter().enumerate() {
            let response = chip(ui, context, set);
            if response.clicked() {
                let modifiers = ui.input(|input| input.modifiers);
                let action = match () {
                    () if modifiers.command => SetAction::Subtract(at),
                    () if modifiers.shift => SetAction::Extend(at),
                    () => SetAction::Select(at),
                };
                requests.push(Request::Sets(action));
            }
            response.context_menu(|ui| menu(ui, context, at, set, requests));
        }
    });
}

/// Draws a chip: a dot in the color of the set, and its name.
fn chip(ui: &mut Ui, context: &PanelContext<'_>, set: &SelectionSet) -> Response {
    let theme = Theme::of(ui);
    let name = widgets::cut_in_middle(ui, &set.name, NAME, &TextStyle::Small);
    let width = widgets::text_width(ui, &name, &TextStyle::Small);
    let (rect, response) = ui.allocate_exact_size(vec2(width + 26.0, HEIGHT), Sense::click());
    let is_selected = !set.bones.is_empty() && set.bones.iter().all(|&bone| context.selection.contains(bone));
    let title = format!("Selection set {}", set.name);
    response.widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), is_selected, &title));
    let [red, green, blue] = set.color;
    let color = Color32::from_rgb(red, green, blue);
    let fill = match () {
        () if is_selected => color.gamma_multiply(0.3),
        () if response.hovered() => theme.hover,
        () => color.gamma_multiply(0.12),
    };
    ui.painter().rect_filled(rect, CornerRadius::same(10), fill);
    ui.painter().circle_filled(pos2(rect.left() + 10.0, rect.center().y), 4.0, color);
    let text = egui::Rect::from_min_max(pos2(rect.left() + 18.0, rect.top()), rect.max);
    widgets::text_in(ui, text, &name, &TextStyle::Small, theme.text);
    widgets::focus_ring(ui, &response, rect);
    let bones = widgets::count(set.bones.len(), "bone", "bones");
    let help = "Click to select, Shift to add to the selection, Ctrl to remove from it";
    response.on_hover_text(format!("{}\n{bones}\n{help}", widgets::shortened(&set.name)))
}

/// Draws the context menu of a chip.
fn menu(ui: &mut Ui, context: &PanelContext<'_>, at: usize, set: &SelectionSet, requests: &mut Vec<Request>) {
    let id = ui.scope_id().with(("name of set", at));
    let mut name = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| set.name.clone());
    let field = ui
        .add(TextEdit::singleline(&mut name).align(Align2::LEFT_CENTER).desired_width(150.0))
        .accessible_name("Name of the set");
    if field.changed() {
        ui.data_mut(|data| data.insert_temp(id, name.clone()));
    }
    if field.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        if ui.input(|input| input.key_pressed(Key::Enter)) {
            requests.push(Request::Sets(SetAction::Rename(at, name)));
            ui.close();
        }
    }
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for color in COLORS {
            let [red, green, blue] = color;
            let button = Button::new("").fill(Color32::from_rgb(red, green, blue)).min_size(vec2(18.0, 18.0));
            if ui.add(button).clicked() {
                requests.push(Request::Sets(SetAction::Color(at, color)));
                ui.close();
            }
        }
    });
    ui.separator();
    let has_bones = context.selected().is_some();
    for (title, able, action) in [
        ("Select", true, SetAction::Select(at)),
        ("Add to selection", true, SetAction::Extend(at)),
        ("Remove from selection", true, SetAction::Subtract(at)),
        ("Add selected bones to the set", has_bones, SetAction::AddBones(at)),
        ("Remove selected bones from the set", has_bones, SetAction::RemoveBones(at)),
        ("Delete set", true, SetAction::Remove(at)),
    ] {
        if ui.add_enabled(able, Button::new(title).frame_when_inactive(false)).clicked() {
            requests.push(Request::Sets(action));
            ui.close();
        }
    }
}
