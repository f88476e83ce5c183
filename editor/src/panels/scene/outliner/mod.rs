//! The list of the things of a scene: roles, props, cameras, lights, effects, paths, marks.

mod lines;
mod rename;
mod row;
mod takes;

use super::super::context::PanelContext;
use super::super::menu::{item, submenu};
use super::super::panel::PanelSubject;
use super::super::request::Request;
use super::super::style::{GRID, ROW};
use super::super::{Panel, PanelPlace, widgets};
use super::SceneRequest;
use super::script::find;
use crate::panels::commands::Id;
use crate::panels::icons::Icon;
use crate::panels::search_field;
use crate::panels::theme::Theme;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::SceneView;
use dragonfly_document::bones::Choice;
use egui::style::ScrollAnimation;
use egui::{Align, Rect, RichText, ScrollArea, Ui, pos2, vec2};
use lines::LineRows;
use rename::ThingName;
use std::sync::Arc;
use takes::TakeRows;

/// The kinds of things with their headings, in the order in which they are listed.
const KINDS: [(&str, &str); 7] = [
    ("role", "Roles"),
    ("prop", "Props"),
    ("camera", "Cameras"),
    ("light", "Lights"),
    ("effect", "Effects"),
    ("path", "Paths"),
    ("mark", "Marks"),
];

/// The list of things.
#[derive(Debug, Default)]
pub struct Outliner {
    query: String,
    name: ThingName,
    lines: LineRows,
    takes: TakeRows,
    /// The thing from which Shift selects.
    from: Option<Box<str>>,
    /// The thing that was selected last when the list was drawn before.
    active: Option<Box<str>>,
    /// The thing to bring into sight.
    sought: Option<Box<str>>,
    listed: ListedThings,
}

impl Panel for Outliner {
    fn id(&self) -> &'static str {
        "outliner"
    }

    fn title(&self) -> &'static str {
        "Scene"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Left
    }

    fn subject(&self) -> PanelSubject {
        PanelSubject::Scene
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some(scene) = context.scene() else {
            return widgets::empty(
                ui,
                "The things of a scene appear here",
                "Choose \"New scene of two roles\" in the menu File > New, or open a scene.xml",
            );
        };
        bar(ui, context, requests);
        let Some(script) = &scene.script else {
            return widgets::empty(ui, "The script has errors", "Correct it in the panel Script");
        };
        let has_lines = scene.lines.as_ref().is_some_and(|lines| !lines.list().is_empty());
        if script.things().len() == 0 && !has_lines {
            return widgets::empty(ui, "The scene is empty", "Drop a model file here, or add a thing above");
        }
        // Also over a short list, so that the rows stay in their places while things are added.
        let focus = context.find && !find::has_focus(ui);
        search_field::show(ui, &mut self.query, "Find a thing", focus);
        self.listed.update(script, self.query.trim());
        let active = context.scene_editing.things().last();
        if self.active.as_ref() != active {
            self.active = active.cloned();
            self.sought = active.cloned();
        }
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let listed = std::mem::take(&mut self.listed);
            if listed.things.is_empty() && !listed.query.is_empty() {
                ui.add_space(GRID);
                ui.label(RichText::new("No thing matches the search").color(Theme::of(ui).weak));
            }
            for group in listed.things.chunk_by(|one, other| one.0 == other.0) {
                let kind = KINDS.get(group[0].0).map_or("", |(_, title)| title);
                ui.add_space(GRID);
                ui.horizontal(|ui| {
                    ui.add_space(3.0 * GRID);
                    ui.label(RichText::new(kind).small().color(Theme::of(ui).weak));
                });
                self.group(ui, context, scene, (script, &listed, group), requests);
            }
            self.listed = listed;
            // One that the search hides is not sought later.
            self.sought = None;
            self.lines.show(ui, context, requests);
            self.takes.show(ui, context, scene, requests);
            ui.add_space(2.0 * GRID);
        });
    }
}

/// The things that are listed, in the order of the list.
#[derive(Debug, Default)]
struct ListedThings {
    script: Option<Arc<StageScript>>,
    query: String,
    /// The position of the kind in [`KINDS`], and of the element in the script.
    things: Vec<(usize, usize)>,
}

impl ListedThings {
    /// Lists the things whose names contain `query`. Does nothing if nothing changed.
    fn update(&mut self, script: &Arc<StageScript>, query: &str) {
        if self.script.as_ref().is_some_and(|own| Arc::ptr_eq(own, script)) && self.query == query {
            return;
        }
        let wanted = query.to_lowercase();
        self.things.clear();
        for element in script.thing_elements() {
            let own = &script.tree().elements()[element];
            let id = own.value("id").unwrap_or_default();
            let kind = KINDS.iter().position(|(kind, _)| *kind == own.row.name);
            if let Some(kind) = kind.filter(|_| wanted.is_empty() || id.to_lowercase().contains(&wanted)) {
                self.things.push((kind, element));
            }
        }
        self.things.sort_by_key(|(kind, _)| *kind);
        (self.script, self.query) = (Some(Arc::clone(script)), query.to_owned());
    }
}

/// Returns the id of a listed thing.
fn id_of(script: &StageScript, (_, element): (usize, usize)) -> &str {
    script.tree().elements()[element].value("id").unwrap_or_default()
}

impl Outliner {
    /// Draws the rows of one kind that are in sight, and leaves room for the others.
    fn group(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        scene: &SceneView,
        (script, listed, group): (&StageScript, &ListedThings, &[(usize, usize)]),
        requests: &mut Vec<Request>,
    ) {
        let (top, clip) = (ui.cursor().top(), ui.clip_rect());
        let row_at = |y: f32| (((y - top) / ROW).max(0.0) as usize).min(group.len());
        let (first, last) = (row_at(clip.top()), (row_at(clip.bottom()) + 1).min(group.len()));
        let renaming = context.scene_editing.renaming();
        let renamed = renaming.and_then(|id| group.iter().position(|own| id_of(script, *own) == id));
        if let Some(row) = renamed.filter(|row| !(first..last).contains(row)) {
            let corner = pos2(ui.cursor().left(), top + row as f32 * ROW);
            // At once: a field that moves out of sight again would lose the focus.
            let rect = Rect::from_min_size(corner, vec2(1.0, ROW));
            ui.scroll_to_rect_animation(rect, Some(Align::Center), ScrollAnimation::none());
        }
        // Brings a thing into sight that was selected or added elsewhere.
        let sought = self.sought.as_deref();
        if let Some(row) = sought.and_then(|id| group.iter().position(|own| id_of(script, *own) == id)) {
            self.sought = None;
            let corner = pos2(ui.cursor().left(), top + row as f32 * ROW);
            let rect = Rect::from_min_size(corner, vec2(1.0, ROW));
            if !clip.y_range().contains(rect.top()) || !clip.y_range().contains(rect.bottom()) {
                ui.scroll_to_rect_animation(rect, Some(Align::Center), ScrollAnimation::none());
            }
        }
        ui.add_space(first as f32 * ROW);
        for own in &group[first.min(last)..last] {
            let id = id_of(script, *own);
            if renaming == Some(id) {
                rename::show(&mut self.name, ui, context, id, requests);
            } else if row::show(ui, context, scene, &script.tree().elements()[own.1], requests) {
                self.choose(ui, script, id, listed, requests);
            }
        }
        ui.add_space((group.len() - last) as f32 * ROW);
    }

    /// Selects by a click: with Ctrl it toggles, with Shift it adds all rows up to this one.
    fn choose(
        &mut self,
        ui: &Ui,
        script: &StageScript,
        id: &str,
        listed: &ListedThings,
        requests: &mut Vec<Request>,
    ) {
        let modifiers = ui.input(|input| input.modifiers);
        let listed = &listed.things;
        let place = |id: &str| listed.iter().position(|own| id_of(script, *own) == id);
        let range = self.from.as_deref().and_then(place).zip(place(id)).filter(|_| modifiers.shift);
        let (things, choice) = match range {
            Some((from, to)) => {
                let between = listed[from.min(to)..=from.max(to)].iter().map(|own| id_of(script, *own));
                // The one that was clicked becomes the active one.
                let mut things: Vec<Box<str>> =
                    between.filter(|other| *other != id).map(Into::into).collect();
                things.push(id.into());
                (things, Choice::Add)
            }
            None if modifiers.command => (vec![id.into()], Choice::Toggle),
            None => (vec![id.into()], Choice::Replace),
        };
        self.from = Some(id.into());
        requests.push(Request::Scene(SceneRequest::SelectThings(things, choice)));
    }
}

/// Draws the button with the menu of new things.
fn bar(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.add_space(GRID);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.add_space(2.0 * GRID);
        let button = widgets::quiet_button(ui, Icon::Add, true, "Add", "Add a thing to the scene");
        egui::Popup::menu(&button).show(|ui| entries(ui, context, requests));
    });
}

/// Draws the entries of new things.
pub(super) fn entries(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    for id in [Id::AddRole, Id::AddProp] {
        item(ui, context, id, false, requests);
    }
    ui.separator();
    for id in [Id::AddSceneCamera, Id::AddLight, Id::AddEffect, Id::AddPath, Id::AddMark] {
        item(ui, context, id, false, requests);
    }
    ui.separator();
    for id in [Id::AddSceneSound, Id::AddTitle] {
        item(ui, context, id, false, requests);
    }
}

/// Draws the menu of the thing that was selected last, or of new things where none is.
pub(in crate::panels) fn thing_menu(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let Some(scene) = context.scene() else { return };
    let script = scene.script.as_ref();
    let selected = context.scene_editing.things().last().and_then(|id| {
        let script = script?;
        Some(&script.tree().elements()[script.thing_element(id)?])
    });
    match selected {
        Some(thing) => row::menu(ui, context, scene, thing, requests),
        None => submenu(ui, "Add", |ui| entries(ui, context, requests)),
    }
}

/// Returns the request that makes a thing the one of the menu: the last of the selected ones, or the only one.
pub(in crate::panels) fn active_request(context: &PanelContext<'_>, thing: &str) -> SceneRequest {
    let choice = if context.scene_editing.is_selected(thing) { Choice::Add } else { Choice::Replace };
    SceneRequest::SelectThings(vec![thing.into()], choice)
}
