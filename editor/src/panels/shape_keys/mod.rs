//! The shape keys (morph targets) of the model: a slider for the weight of each at the playhead, grouped by the names that ARKit and
//! VRM use.
//!
//! A glTF key has the weights of all shape keys of a mesh, so each mesh has one button for its keys.

mod group;
mod row;
mod shown;

pub use group::ShapeGroup;

use super::context::PanelContext;
use super::icons::Icon;
use super::keys::{KeyDragOp, KeysRequest};
use super::number_field::FieldEvent;
use super::request::Request;
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::{Panel, PanelPlace, properties, search_field, widgets};
use dragonfly_document::edit::Edit;
use dragonfly_document::{Change, LoadedModel, ShapeMesh};
use egui::{Align, Button, Layout, Popup, RichText, ScrollArea, Ui, vec2};
use row::ShapeRow;
use shown::{ShapeList, ShownMesh};
use std::collections::HashMap;
use std::sync::Arc;

/// The list of shape keys.
#[derive(Debug, Default)]
pub struct ShapeKeys {
    query: String,
    lists: HashMap<u32, Arc<ShapeList>>,
    /// Weight when the drag of a slider or number began, by mesh and shape key.
    held: Option<(u32, usize, f64)>,
    /// The model that this state belongs to.
    of: Option<Arc<LoadedModel>>,
}

impl Panel for ShapeKeys {
    fn id(&self) -> &'static str {
        "shapes"
    }

    fn title(&self) -> &'static str {
        "Shape keys"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::BelowRight
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some(view) = context.view else { return widgets::empty(ui, "Shape keys appear here", "") };
        if self.of.as_ref().map(Arc::as_ptr) != Some(Arc::as_ptr(&view.loaded)) {
            let (of, query) = (Some(Arc::clone(&view.loaded)), std::mem::take(&mut self.query));
            *self = Self { of, query, ..Self::default() };
        }
        let meshes = shown_meshes(context);
        if meshes.is_empty() {
            return widgets::empty(ui, "No shape keys", "No mesh of this model has morph targets");
        }
        self.held.take_if(|_| !context.keys.is_dragging());
        if context.layer().is_some() {
            let text = RichText::new("Keys of shape keys are in the take, not in layers").small();
            ui.horizontal(|ui| {
                ui.add_space(2.0 * GRID);
                let label = ui.colored_label(Theme::of(ui).weak, text);
                label.on_hover_text("A slider changes the weights of the take below all layers");
            });
        }
        search_field::show(ui, &mut self.query, "Find a shape key", false);
        let query = self.query.trim().to_lowercase();
        let mut found = false;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            for mesh in meshes {
                let list = self.lists.entry(mesh.instance());
                let list = Arc::clone(list.or_insert_with(|| Arc::new(ShapeList::of(mesh))));
                let rows = list.rows(mesh, &query);
                if !rows.is_empty() {
                    found = true;
                    self.mesh(ui, context, &ShownMesh::of(context, mesh), (&list, &rows), requests);
                }
            }
            if !found {
                widgets::empty(ui, "No shape key matches the search", "");
            }
        });
    }
}

/// Returns the meshes that are listed: those that the active bone carries, or all if it carries none.
fn shown_meshes<'a>(context: &PanelContext<'a>) -> Vec<&'a ShapeMesh> {
    let Some(view) = context.view else { return Vec::new() };
    let all: Vec<&ShapeMesh> = view.shapes.meshes().iter().collect();
    let carried = |mesh: &&&ShapeMesh| {
        let instance = view.loaded.model.instances.get(mesh.instance() as usize);
        instance.is_some_and(|instance| {
            instance.skin.is_none() && instance.bone.is_some() && instance.bone == context.selected()
        })
    };
    let of_bone: Vec<&ShapeMesh> = all.iter().filter(carried).copied().collect();
    if of_bone.is_empty() { all } else { of_bone }
}

/// Returns the reason why weights cannot be changed at the time shown.
fn locked(context: &PanelContext<'_>) -> Option<&'static str> {
    if context.take().is_none() {
        return Some("The rest pose cannot be edited: show a take first");
    }
    context.shape_scope_refusal()
}

/// Smallest width of two columns, points.
const TWO_COLUMNS: f32 = 440.0;

/// An item of the list.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ShapeItem {
    /// The title of a group.
    Caption(ShapeGroup),
    /// A shape key.
    Row(usize),
}

/// Returns the items of the list. A single group has no caption.
fn items(rows: &[(ShapeGroup, usize)]) -> Vec<ShapeItem> {
    let has_groups = rows.iter().any(|(group, _)| *group != rows[0].0);
    let mut items = Vec::new();
    let mut last = None;
    for &(group, shape) in rows {
        if has_groups && last != Some(group) {
            last = Some(group);
            items.push(ShapeItem::Caption(group));
        }
        items.push(ShapeItem::Row(shape));
    }
    items
}

fn caption(ui: &mut Ui, group: ShapeGroup) {
    ui.horizontal(|ui| {
        ui.add_space(2.0 * GRID);
        widgets::caption(ui, group.title());
    });
}

impl ShapeKeys {
    fn mesh(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        shown: &ShownMesh<'_>,
        (list, rows): (&ShapeList, &[(ShapeGroup, usize)]),
        requests: &mut Vec<Request>,
    ) {
        let locked = locked(context);
        heading(ui, context, shown, list, requests);
        let items = items(rows);
        let width = ui.available_width();
        let columns = if width >= TWO_COLUMNS && items.len() > 1 { 2 } else { 1 };
        let mut first = items.len().div_ceil(columns);
        // A caption is above its first row.
        if matches!(items.get(first.wrapping_sub(1)), Some(ShapeItem::Caption(_))) {
            first -= 1;
        }
        let (left, right) = items.split_at(first);
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            for column in [left, right].into_iter().filter(|column| !column.is_empty()) {
                ui.vertical(|ui| {
                    ui.set_width(width / columns as f32);
                    for item in column {
                        match *item {
                            ShapeItem::Caption(group) => caption(ui, group),
                            ShapeItem::Row(shape) => {
                                self.row(ui, context, shown, (list, shape), locked, requests);
                            }
                        }
                    }
                });
            }
        });
        ui.add_space(2.0 * GRID);
    }

    fn row(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        shown: &ShownMesh<'_>,
        (list, shape): (&ShapeList, usize),
        locked: Option<&'static str>,
        requests: &mut Vec<Request>,
    ) {
        let row = ShapeRow {
            instance: shown.mesh.instance(),
            shape,
            mesh: shown.mesh.name(),
            name: &shown.mesh.shapes()[shape],
            weight: f64::from(shown.weights[shape]),
            rest: f64::from(shown.mesh.rest()[shape]),
            pending: shown.is_pending(shape),
            locked,
        };
        let (event, name) = row.show(ui);
        self.apply(event, &row, context, shown, requests);
        Popup::context_menu(&name).show(|ui| row_menu(ui, context, shown, (list, shape), requests));
    }

    /// Requests what the user did with a slider or a number.
    fn apply(
        &mut self,
        event: FieldEvent,
        row: &ShapeRow<'_>,
        context: &PanelContext<'_>,
        shown: &ShownMesh<'_>,
        requests: &mut Vec<Request>,
    ) {
        let mut push = |request| requests.push(Request::Timeline(request));
        let edit = |weight: f64| shown.set(context, &[(row.shape, weight as f32)]);
        match event {
            FieldEvent::Nothing | FieldEvent::Changed(_) => {}
            FieldEvent::Touched => properties::pause(context, requests),
            FieldEvent::Dragged(by) => {
                let key = (row.instance, row.shape);
                let start = match self.held {
                    Some((instance, shape, start)) if (instance, shape) == key => start,
                    Some(_) | None => row.weight,
                };
                self.held = Some((key.0, key.1, start));
                if let Some(edit) = edit(start + by) {
                    push(KeysRequest::Drag(KeyDragOp::Edit(edit)));
                }
            }
            FieldEvent::Released => {
                self.held = None;
                push(KeysRequest::Release);
            }
            FieldEvent::Cancelled => {
                self.held = None;
                push(KeysRequest::Cancel);
            }
            FieldEvent::Typed(weight) => request(edit(weight), requests),
        }
    }
}

fn request(edit: Option<Edit>, requests: &mut Vec<Request>) {
    requests.extend(edit.map(|edit| Request::Change(Change::Edit(edit, None))));
}

/// Draws the name of a mesh with the buttons for its keys.
fn heading(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    shown: &ShownMesh<'_>,
    list: &ShapeList,
    requests: &mut Vec<Request>,
) {
    let mesh = shown.mesh.name();
    ui.allocate_ui_with_layout(vec2(ui.available_width(), ROW), Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(2.0 * GRID);
        ui.spacing_mut().item_spacing.x = 0.0;
        let more = widgets::icon_button(ui, Icon::Down, &format!("More for the shape keys of {mesh}"), false);
        Popup::menu(&more.on_hover_text("Reset, mirror")).show(|ui| {
            let mut entry = |ui: &mut Ui, title: &str, help: &str, edit: Option<Edit>| {
                let able = edit.is_some() && locked(context).is_none();
                let button = ui.add_enabled(able, Button::new(title).frame_when_inactive(false));
                if button.on_hover_text(help).clicked() {
                    request(edit, requests);
                    ui.close();
                }
            };
            let (mut reset, mut mirror) = (None, None);
            if context.take().is_some() {
                (reset, mirror) = (shown.reset(context), shown.mirror(context, list));
            }
            ui.set_min_width(160.0);
            entry(ui, "Reset all", "Gives all shape keys of the mesh their weights in the file", reset);
            entry(ui, "Mirror", "Exchanges the weights of left and right shape keys", mirror);
        });
        key_button(ui, context, shown, requests);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            ui.add_space(2.0 * GRID);
            ui.add(egui::Label::new(RichText::new(mesh).color(Theme::of(ui).text)).truncate());
        });
    });
}

/// Draws the button that shows whether there is a key, and adds or deletes it.
fn key_button(ui: &mut Ui, context: &PanelContext<'_>, shown: &ShownMesh<'_>, requests: &mut Vec<Request>) {
    let mesh = shown.mesh.name();
    let (icon, label, now) = if shown.has_pending() {
        (Icon::KeyElsewhere, format!("Key the pending weights of {mesh}"), "weights that are not keyed")
    } else if shown.is_keyed() {
        (Icon::KeyHere, format!("Delete the key of the shape keys of {mesh}"), "a key at this time")
    } else if shown.is_animated() {
        (Icon::KeyElsewhere, format!("Add a key of the shape keys of {mesh}"), "no key at this time")
    } else {
        (Icon::KeyNever, format!("Add a key of the shape keys of {mesh}"), "no keys")
    };
    let button = ui.add_enabled_ui(context.take().is_some(), |ui| {
        widgets::icon_button(ui, icon, &label, shown.is_keyed() && !shown.has_pending())
    });
    let response = button.inner.on_hover_ui(|ui| {
        ui.label(format!("The shape keys have {now}"));
        let action = match () {
            () if shown.has_pending() => "Key them",
            () if shown.is_keyed() => "Delete it",
            () => "Add one",
        };
        ui.colored_label(Theme::of(ui).weak, action);
    });
    if response.clicked() {
        let edit = if shown.is_keyed() && !shown.has_pending() {
            shown.delete_key(context)
        } else {
            shown.key(context)
        };
        request(edit, requests);
    }
}

/// Draws the context menu of a row.
fn row_menu(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    shown: &ShownMesh<'_>,
    (list, shape): (&ShapeList, usize),
    requests: &mut Vec<Request>,
) {
    let able = locked(context).is_none();
    let mut entry = |ui: &mut Ui, title: &str, to: usize, weight: f32| {
        if ui.add_enabled(able, Button::new(title).frame_when_inactive(false)).clicked() {
            request(shown.set(context, &[(to, weight)]), requests);
            ui.close();
        }
    };
    entry(ui, "Reset", shape, shown.mesh.rest()[shape]);
    if let Some(other) = list.partner(shape) {
        let title = format!("Copy to {}", widgets::shortened(&shown.mesh.shapes()[other]));
        entry(ui, &title, other, shown.weights[shape]);
    }
}
