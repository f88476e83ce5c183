//! The list of the things of a scene: roles, props, cameras, lights, effects, paths, marks.

mod lines;
mod name_field;
mod row;

use super::super::context::PanelContext;
use super::super::menu::item;
use super::super::panel::PanelSubject;
use super::super::request::Request;
use super::super::style::GRID;
use super::super::{Panel, PanelPlace, widgets};
use super::SceneRequest;
use crate::panels::commands::Id;
use crate::panels::icons::Icon;
use crate::panels::search_field;
use crate::panels::theme::Theme;
use dragonfly_document::bones::Choice;
use egui::{RichText, ScrollArea, Ui};
use lines::LineRows;
use name_field::NameField;

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

/// Number of things from which on a search field is shown.
const SEARCHED: usize = 12;

/// The list of things.
#[derive(Debug, Default)]
pub struct Outliner {
    query: String,
    name: NameField,
    lines: LineRows,
    /// The thing from which Shift selects.
    from: Option<Box<str>>,
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
                "Choose \"New scene of two roles\" in the menu File, or open a scene.xml",
            );
        };
        bar(ui, context, requests);
        let Some(script) = &scene.script else {
            return widgets::empty(ui, "The script has errors", "Correct it in the panel Script");
        };
        if script.things().len() == 0 {
            return widgets::empty(ui, "The scene is empty", "Drop a model file here, or add a thing above");
        }
        if script.things().len() > SEARCHED {
            search_field::show(ui, &mut self.query, "Find a thing", context.find);
        } else {
            self.query.clear();
        }
        let query = self.query.trim().to_lowercase();
        let things: Vec<(&'static str, &str)> =
            script.things().map(|thing| (thing.row.name, thing.value("id").unwrap_or_default())).collect();
        let listed: Vec<(&'static str, &str)> = KINDS
            .iter()
            .flat_map(|(kind, _)| things.iter().filter(move |(own, _)| own == kind))
            .filter(|(_, id)| query.is_empty() || id.to_lowercase().contains(&query))
            .copied()
            .collect();
        if listed.is_empty() {
            return widgets::empty(ui, "No thing matches the search", "");
        }
        ui.spacing_mut().item_spacing.y = 0.0;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let mut heading = "";
            for &(kind, id) in &listed {
                if kind != heading {
                    heading = kind;
                    let title = KINDS.iter().find(|(own, _)| *own == kind).map_or("", |(_, title)| title);
                    ui.add_space(GRID);
                    ui.horizontal(|ui| {
                        ui.add_space(3.0 * GRID);
                        ui.label(RichText::new(title).small().color(Theme::of(ui).weak));
                    });
                }
                if context.scene_editing.renaming() == Some(id) {
                    self.name.show(ui, context, id, requests);
                } else if row::show(ui, context, scene, (kind, id), requests) {
                    self.choose(ui, id, &listed, requests);
                }
            }
            self.lines.show(ui, context, requests);
            ui.add_space(2.0 * GRID);
        });
    }
}

impl Outliner {
    /// Selects by a click: with Ctrl it toggles, with Shift it adds all rows up to this one.
    fn choose(&mut self, ui: &Ui, id: &str, listed: &[(&'static str, &str)], requests: &mut Vec<Request>) {
        let modifiers = ui.input(|input| input.modifiers);
        let place = |id: &str| listed.iter().position(|(_, other)| *other == id);
        let range = self.from.as_deref().and_then(place).zip(place(id)).filter(|_| modifiers.shift);
        let (things, choice) = match range {
            Some((from, to)) => {
                let between = listed[from.min(to)..=from.max(to)].iter().map(|(_, id)| *id);
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
        ui.add_space(GRID);
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
}
