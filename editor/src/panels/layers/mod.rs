//! The list of the layers of the take: a click makes one active, whose keys are then shown and edited.

mod row;

use super::actions::layers::unchanged;
use super::commands::Id;
use super::context::PanelContext;
use super::icons::Icon;
use super::name_field::NameField;
use super::request::Request;
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::{Panel, PanelPlace, command_button, commands, menu, widgets};
use dragonfly_document::Change;
use dragonfly_document::adapter::TakeId;
use dragonfly_document::edit::{Edit, LAYER_COLORS, MoveLayer, SetLayer, TakeRef};
use egui::{Button, Color32, Frame, Margin, Popup, Rect, RichText, ScrollArea, TextStyle, Ui, pos2, vec2};
use row::LayerRow;

/// The list of layers.
#[derive(Debug, Default)]
pub struct Layers {
    /// The layer whose name is being typed.
    renaming: Option<(TakeId, NameField)>,
}

/// Commands for the active layer, in the order of the context menu.
const MENU: &[&[Id]] = &[
    &[Id::DuplicateLayer, Id::DeleteLayer],
    &[Id::MoveLayerUp, Id::MoveLayerDown],
    &[Id::MaskLayer, Id::UnmaskLayer, Id::KeyLayerWeight],
    &[Id::MergeLayerDown, Id::MergeLayers],
];

impl Panel for Layers {
    fn id(&self) -> &'static str {
        "layers"
    }

    fn title(&self) -> &'static str {
        "Layers"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::LeftBelow
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some(slot) = context.slot() else {
            return widgets::empty(ui, "Layers of a take appear here", "");
        };
        ui.add_space(GRID);
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
            ui.add_space(2.0 * GRID);
            for (icon, id) in [
                (Icon::Add, Id::AddLayer),
                (Icon::Duplicate, Id::DuplicateLayer),
                (Icon::Trash, Id::DeleteLayer),
            ] {
                let holds = commands::get(id).when.holds(context);
                ui.add_enabled_ui(holds, |ui| command_button::command_button(ui, icon, id, false, requests));
            }
            let more = widgets::icon_button(ui, Icon::Down, "More commands for layers", false);
            Popup::menu(&more.on_hover_text("More commands for layers")).show(|ui| {
                menu::item(ui, context, Id::AddOverrideLayer, false, requests);
                menu::submenu(ui, "Add layer from take", |ui| from_take(ui, context, requests));
                ui.separator();
                entries(ui, context, requests);
            });
        });
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for index in (0..context.layers().len()).rev() {
                let response = LayerRow::of(context, index).show(ui, self, context, requests);
                response.context_menu(|ui| entries(ui, context, requests));
            }
            let name = format!("{} (base)", widgets::shortened(&slot.result.name));
            let is_active = context.layer().is_none();
            let (rect, response) = widgets::row(ui, &name, is_active, false);
            let color = if is_active { Theme::of(ui).accent } else { Theme::of(ui).text };
            let text = Rect::from_min_max(pos2(rect.left() + 18.0, rect.top()), rect.max - vec2(12.0, 0.0));
            widgets::text_in(ui, text, &name, &TextStyle::Body, color);
            if response.on_hover_text("Keys of the take itself, below all layers").clicked() {
                requests.push(Request::ChooseLayer(None));
            }
            if context.layers().is_empty() {
                ui.add_space(2.0 * GRID);
                let text = "A layer changes the take without changing its keys";
                Frame::NONE.inner_margin(Margin::symmetric(18, 0)).show(ui, |ui| {
                    ui.label(RichText::new(text).small().color(Theme::of(ui).weak));
                });
            }
        });
    }
}

fn entries(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    for (at, group) in MENU.iter().enumerate() {
        if at > 0 {
            ui.separator();
        }
        for &id in *group {
            menu::item(ui, context, id, false, requests);
        }
    }
    if let Some(layer) = context.layer() {
        ui.separator();
        menu::submenu(ui, "Move to take", |ui| move_to_take(ui, context, layer, requests));
        menu::submenu(ui, "Color", |ui| colors(ui, context, layer, requests));
    }
}

/// Draws the takes whose keys a new layer of poses can have, such as one that was retargeted.
fn from_take(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
        for (index, other) in context.digest.takes.iter().enumerate() {
            let is_other = context.playback.take != Some(index);
            let button = Button::new(widgets::shortened(&other.name)).frame_when_inactive(false);
            if ui.add_enabled(is_other, button).clicked() {
                requests.push(Request::AddLayerFrom(index));
                ui.close();
            }
        }
    });
}

/// Draws the takes to which the layer can be moved.
fn move_to_take(ui: &mut Ui, context: &PanelContext<'_>, layer: usize, requests: &mut Vec<Request>) {
    ScrollArea::vertical().max_height(300.0).show(ui, |ui| {
        for (index, take) in context.digest.takes.iter().enumerate() {
            let is_other = context.playback.take != Some(index);
            let button = Button::new(widgets::shortened(&take.name)).frame_when_inactive(false);
            if ui.add_enabled(is_other, button).clicked()
                && let Some(from) = context.layer_ref(layer)
            {
                let to_take = Some(TakeRef::Index(index));
                let edit = Edit::MoveLayer(MoveLayer { take: from, to: usize::MAX, to_take });
                requests.push(Request::Change(Change::Edit(edit, None)));
                ui.close();
            }
        }
    });
}

/// Draws the colors that the layer can have.
fn colors(ui: &mut Ui, context: &PanelContext<'_>, layer: usize, requests: &mut Vec<Request>) {
    ui.horizontal(|ui| {
        for color in LAYER_COLORS {
            let [red, green, blue] = color;
            let button = Button::new("").fill(Color32::from_rgb(red, green, blue)).min_size(vec2(20.0, 20.0));
            let name = format!("Color {red}, {green}, {blue}");
            if ui.add(button).accessible_name(&name).clicked()
                && let Some(take) = context.layer_ref(layer)
            {
                let edit = Edit::SetLayer(SetLayer { color: Some(color), ..unchanged(take) });
                requests.push(Request::Change(Change::Edit(edit, None)));
                ui.close();
            }
        }
    });
}

/// Height of a row with its weight below the name, points.
const HEIGHT: f32 = ROW + 20.0;
