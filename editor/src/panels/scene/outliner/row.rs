//! A row of the list: the icon, the name, and switches that hide and lock.

use crate::panels::commands::{Id, tooltip};
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::menu::{item, submenu};
use crate::panels::request::Request;
use crate::panels::scene::SceneRequest;
use crate::panels::scene::thing_icon::icon;
use crate::panels::style::ROW;
use crate::panels::submenu::entry;
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::stage::script::ScriptElement;
use dragonfly_document::bones::Choice;
use dragonfly_document::{OutdatedEdits, OutdatedEditsChoice, SceneModel, SceneView};
use dragonfly_picture::ThroughCamera;
use egui::accesskit::Role;
use egui::{Rect, Response, Sense, TextStyle, Ui, WidgetInfo, pos2, vec2};

/// Width of the button that finds a missing model, points.
const FIND: f32 = 44.0;

/// The entries for edits of a model that were made for another file.
const SETTLED: [(&str, OutdatedEditsChoice); 2] = [
    ("Apply the edits again", OutdatedEditsChoice::Apply),
    ("Remove the edits", OutdatedEditsChoice::Remove),
];

/// Draws a row. Returns whether it was clicked.
pub(super) fn show(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    scene: &SceneView,
    thing: &ScriptElement,
    requests: &mut Vec<Request>,
) -> bool {
    let (theme, editing) = (Theme::of(ui), context.scene_editing);
    let (kind, id) = (thing.row.name, thing.value("id").unwrap_or_default());
    let is_selected = editing.is_selected(id);
    let (rect, response) = widgets::row(ui, &format!("{id}, {kind}"), is_selected, false);
    let mark = Rect::from_center_size(pos2(rect.left() + 22.0, rect.center().y), vec2(16.0, 16.0));
    let color = match () {
        () if is_selected => theme.accent,
        () if editing.is_hidden(id) => theme.faint,
        () => theme.text,
    };
    icon(kind).paint(ui.painter(), mark, if is_selected { theme.accent } else { theme.weak });
    let has_model = matches!(kind, "role" | "prop");
    let switches = if has_model { 74.0 } else { 54.0 };
    let text = Rect::from_min_max(
        pos2(rect.left() + 36.0, rect.top()),
        pos2(rect.right() - switches, rect.bottom()),
    );
    let shown = widgets::cut_in_middle(ui, id, text.width(), &TextStyle::Body);
    let end = widgets::text_in(ui, text, &shown, &TextStyle::Body, color);
    let model = thing.value("model").and_then(|model| scene.models.get(model));
    let state = model_state(model);
    if let Some((note, is_bad)) = &state
        && text.right() - end > 30.0
    {
        let place = Rect::from_min_max(pos2(end + 8.0, rect.top()), text.max);
        let color = if *is_bad { theme.warning } else { theme.faint };
        let end = widgets::text_in(ui, place, note, &TextStyle::Small, color);
        let place = Rect::from_min_max(pos2(end + 4.0, rect.top()), text.max);
        if *is_bad
            && place.width() > FIND
            && let Some(find) = find_request(thing, scene)
        {
            let place = place.with_max_x(place.left() + FIND);
            let button = ui.interact(place, response.id.with("find"), Sense::click());
            button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Find the model of {id}")));
            let color = if button.hovered() { theme.text } else { theme.accent };
            widgets::text_in(ui, place.shrink2(vec2(4.0, 0.0)), "Find…", &TextStyle::Small, color);
            widgets::focus_ring(ui, &button, place);
            if button.clicked() {
                requests.push(find);
            }
            button
                .on_hover_text("Choose the file in its place; others that are missing are found next to it");
        }
    }
    let switches = [
        (36.0, editing.is_locked(id), [Icon::Unlocked, Icon::Locked], ["Lock", "Unlock"]),
        (16.0, editing.is_hidden(id), [Icon::Shown, Icon::Hidden], ["Hide", "Show"]),
    ];
    for (at, (right, is_on, icons, verbs)) in switches.into_iter().enumerate() {
        // A number alone would be the id of the row's own hint.
        let place = Rect::from_center_size(pos2(rect.right() - right, rect.center().y), vec2(20.0, ROW));
        let over = ui.rect_contains_pointer(rect);
        let button = ui.interact(place, response.id.with(("switch", at)), Sense::click());
        let verb = verbs[usize::from(is_on)];
        button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("{verb} {id}")));
        if is_on || over || button.has_focus() {
            let tone = if button.hovered() { theme.text } else { theme.faint };
            icons[usize::from(is_on)].paint(ui.painter(), place, tone);
            widgets::focus_ring(ui, &button, place);
        }
        if button.clicked() {
            let things = affected(context, id);
            requests.push(Request::Scene(match at {
                0 => SceneRequest::Lock(things, !is_on),
                _ => SceneRequest::Hide(things, !is_on),
            }));
        }
        button.on_hover_text(format!("{verb} {id}"));
    }
    if has_model {
        let place = Rect::from_center_size(pos2(rect.right() - 56.0, rect.center().y), vec2(20.0, ROW));
        model_button(ui, (rect, place), (&response, id), requests);
    }
    response.context_menu(|ui| menu(ui, context, scene, thing, requests));
    if response.double_clicked() {
        requests.push(Request::Scene(SceneRequest::Rename(Some(id.into()))));
    }
    let clicked = response.clicked();
    if response.secondary_clicked() && !is_selected {
        requests.push(Request::Scene(SceneRequest::SelectThings(vec![id.into()], Choice::Replace)));
    }
    response.on_hover_ui(|ui| {
        let file = scene.script.as_ref().and_then(|script| script.tree().file_of(thing));
        ui.label(hint(thing, model, file));
    });
    clicked
}

/// Draws the button that opens the model of a thing, while the pointer is over its row.
fn model_button(
    ui: &Ui,
    (row, place): (Rect, Rect),
    (response, id): (&Response, &str),
    requests: &mut Vec<Request>,
) {
    let button = ui.interact(place, response.id.with("model"), Sense::click());
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Open the model of {id}")));
    if ui.rect_contains_pointer(row) || button.has_focus() {
        let theme = Theme::of(ui);
        Icon::Bone.paint(ui.painter(), place, if button.hovered() { theme.text } else { theme.faint });
        widgets::focus_ring(ui, &button, place);
    }
    if button.clicked() {
        requests.push(Request::Scene(SceneRequest::EditModel(id.into())));
    }
    button.on_hover_text(tooltip(ui.ctx(), Id::EditSceneModel));
}

/// Returns the things that a switch in the row of `id` changes: all selected ones if it is one of them.
fn affected(context: &PanelContext<'_>, id: &str) -> Vec<Box<str>> {
    match context.scene_editing.is_selected(id) {
        true => context.scene_editing.things().to_vec(),
        false => vec![id.into()],
    }
}

/// Returns a word about a model that is not there yet, and whether it will not come.
fn model_state(model: Option<&SceneModel>) -> Option<(&'static str, bool)> {
    match model? {
        SceneModel::Loading => Some(("reading…", false)),
        SceneModel::Loaded(_) => None,
        SceneModel::Missing(_) => Some(("missing", true)),
    }
}

fn hint(thing: &ScriptElement, model: Option<&SceneModel>, file: Option<&str>) -> String {
    let (kind, id) = (thing.row.name, thing.value("id").unwrap_or_default());
    let source = thing.value("model").map(|source| format!("\n{source}")).unwrap_or_default();
    let reason = match model {
        Some(SceneModel::Missing(reason)) => format!("\n{}", widgets::shortened(reason)),
        Some(SceneModel::Loading | SceneModel::Loaded(_)) | None => String::new(),
    };
    let action = "\nDouble-click: rename";
    let file = file.map(|file| format!("\nIn {file}: open it to change it")).unwrap_or_default();
    format!("{kind} {id}{source}{file}{reason}{action}")
}

/// Returns the request that asks where the missing model of a thing is; `None` where it is not missing, or only an included file names it.
fn find_request(thing: &ScriptElement, scene: &SceneView) -> Option<Request> {
    let name = thing.value("model")?;
    match scene.models.get(name)? {
        SceneModel::Missing(_) => {
            let missing = scene.missing_model(name);
            let is_named_here = scene.included_place_of(&missing).is_none();
            is_named_here.then_some(Request::Scene(SceneRequest::Find(missing)))
        }
        SceneModel::Loading | SceneModel::Loaded(_) => None,
    }
}

/// Returns the sentence that only an included file names the missing model of a thing; `None` for others.
fn included_place(thing: &ScriptElement, scene: &SceneView) -> Option<String> {
    let name = thing.value("model")?;
    let SceneModel::Missing(_) = scene.models.get(name)? else { return None };
    let missing = scene.missing_model(name);
    Some(missing.named_in(scene.included_place_of(&missing)?))
}

/// Returns the edits of the model of a thing that were made for another file; `None` where there are none.
fn outdated<'a>(thing: &ScriptElement, scene: &'a SceneView) -> Option<&'a OutdatedEdits> {
    let project = scene.project.as_ref()?;
    let id = project.model_id(thing.value("model")?)?;
    scene.outdated.iter().find(|edits| project.model_id(&edits.model) == Some(id))
}

/// Draws the entries for a thing.
pub(super) fn menu(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    scene: &SceneView,
    thing: &ScriptElement,
    requests: &mut Vec<Request>,
) {
    let (kind, id) = (thing.row.name, thing.value("id").unwrap_or_default());
    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
    if let Some(place) = included_place(thing, scene) {
        ui.add_enabled(false, egui::Button::new(place).frame_when_inactive(false));
    } else if let Some(find) = find_request(thing, scene)
        && entry(ui, "Find the model…").clicked()
    {
        requests.push(find);
        ui.close();
    }
    if let Some(edits) = outdated(thing, scene) {
        for (title, choice) in SETTLED {
            if entry(ui, title).clicked() {
                requests.push(Request::Scene(SceneRequest::Settle(edits.clone(), choice)));
                ui.close();
            }
        }
        ui.separator();
    }
    if matches!(kind, "role" | "prop") {
        let open = entry(ui, "Edit takes and bones");
        if open.clicked() {
            requests.push(Request::Scene(SceneRequest::EditModel(id.into())));
            ui.close();
        }
        open.on_hover_text(tooltip(ui.ctx(), Id::EditSceneModel));
    }
    if kind == "camera" {
        if entry(ui, "Look through it").clicked() {
            requests.push(Request::Scene(SceneRequest::Through(ThroughCamera::Of(id.into()))));
            ui.close();
        }
        item(ui, context, Id::CutToCamera, false, requests);
        item(ui, context, Id::PickFocus, false, requests);
    }
    if matches!(kind, "role" | "prop" | "camera" | "light" | "effect") {
        item(ui, context, Id::DetachHere, false, requests);
    }
    if matches!(kind, "role" | "prop" | "camera" | "light" | "effect" | "path") {
        item(ui, context, Id::WalkAlong, false, requests);
    }
    if matches!(kind, "role" | "prop" | "mark") {
        item(ui, context, Id::DropToGround, false, requests);
    }
    ui.separator();
    for id in [Id::FrameSelected, Id::HideThings, Id::HideOtherThings, Id::LockThings] {
        item(ui, context, id, false, requests);
    }
    ui.separator();
    for id in [Id::SceneRename, Id::SceneDuplicate, Id::SceneDelete] {
        item(ui, context, id, false, requests);
    }
    ui.separator();
    submenu(ui, "Add", |ui| super::entries(ui, context, requests));
}
