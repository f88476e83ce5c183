//! A button that shows a bone, with a menu to choose another.

use super::context::PanelContext;
use super::style::ROW;
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::data::BoneIndex;
use egui::{Align, Align2, Button, Key, Layout, Popup, Response, RichText, ScrollArea, TextEdit, Ui};

/// The names among which a bone is chosen.
pub(super) struct BoneChoice<'a> {
    /// Names of all bones.
    pub(super) names: &'a [String],
    /// Text of the entry for no bone; `None` where a bone must be chosen.
    pub(super) none: Option<&'a str>,
    /// Accessible name, before the name of the bone, and first line of the tooltip.
    pub(super) label: &'a str,
    /// Width of the button, points.
    pub(super) width: f32,
}

impl BoneChoice<'_> {
    /// Draws the button for `chosen`. Returns the newly chosen bone, or that none was chosen.
    pub(super) fn show(&self, ui: &mut Ui, chosen: Option<BoneIndex>) -> Option<Option<BoneIndex>> {
        let name = |bone: BoneIndex| self.names.get(bone as usize).map_or("", String::as_str);
        let text = chosen.map_or(self.none.unwrap_or("Choose a bone"), name);
        let color = if chosen.is_some() { Theme::of(ui).text } else { Theme::of(ui).weak };
        let text = widgets::cut_in_middle(ui, text, self.width - 16.0, &egui::TextStyle::Body);
        let button = Button::new(RichText::new(text).color(color));
        let button = add_left(ui, button, self.width);
        let shown = chosen.map_or(self.none.unwrap_or("no bone"), name).to_owned();
        let button = button.accessible_name(format!("{}: {shown}", self.label));
        let button = button.on_hover_text(format!("{}\n{shown}", self.label));
        let mut picked = None;
        Popup::menu(&button).show(|ui| {
            let id = button.id.with("filter");
            let mut filter = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
            let width = self.width.max(160.0);
            let text = TextEdit::singleline(&mut filter).hint_text("Filter").align(Align2::LEFT_CENTER);
            let field = ui.add(text.desired_width(width));
            // Letters that are typed while the menu is open filter it.
            if button.clicked() {
                filter.clear();
                field.request_focus();
            }
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            let wanted = filter.to_lowercase();
            let fits: Vec<usize> = (0..self.names.len())
                .filter(|&bone| self.names[bone].to_lowercase().contains(&wanted))
                .collect();
            if let Some(&first) = fits.first().filter(|_| entered) {
                picked = Some(Some(first as BoneIndex));
                ui.close();
            }
            ui.data_mut(|data| data.insert_temp(id, filter));
            if let Some(none) = self.none
                && ui.add(Button::selectable(chosen.is_none(), none)).clicked()
            {
                picked = Some(None);
            }
            ScrollArea::vertical().max_height(10.0 * ROW).show_rows(ui, ROW, fits.len(), |ui, rows| {
                for &bone in &fits[rows] {
                    let is_chosen = chosen == Some(bone as BoneIndex);
                    if ui.add(Button::selectable(is_chosen, &self.names[bone])).clicked() {
                        picked = Some(Some(bone as BoneIndex));
                    }
                }
            });
        });
        picked
    }
}

/// Draws a button of this width with its text at the left.
pub(super) fn add_left(ui: &mut Ui, button: Button<'_>, width: f32) -> Response {
    let layout = Layout::left_to_right(Align::Center).with_main_align(Align::Min);
    let size = egui::vec2(width, ROW);
    ui.allocate_ui_with_layout(size, layout, |ui| ui.add(button.min_size(egui::vec2(width, ROW - 4.0)))).inner
}

/// Returns the names of the bones of the open model.
pub(super) fn names(context: &PanelContext<'_>) -> Vec<String> {
    (0..context.bone_count() as BoneIndex).map(|bone| context.bone_name(bone)).collect()
}
