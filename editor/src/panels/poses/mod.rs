//! The pose library: poses in a folder of files, each with a picture, a name and tags. A double click applies one to the selected
//! bones, and a drag sideways over its picture blends towards it.

mod blend;
mod card;

use super::actions::pose_library as actions;
use super::context::PanelContext;
use super::file_choice::FileChoice;
use super::icons::Icon;
use super::keys::{KeyDragOp, KeysRequest};
use super::request::{FileAction, Request};
use super::style::GRID;
use super::theme::Theme;
use super::{Panel, PanelPlace, search_field, widgets};
use blend::PoseBlend;
use card::{CARD, Card, CardEvent};
use dragonfly_document::posing::StickLine;
use dragonfly_document::{DocumentMessage, LoadedModel, PoseFile, PoseOrder, StoredPose};
use egui::{Button, Key, RichText, ScrollArea, TextEdit, Ui, vec2};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Height of the row with the name and the tags of the chosen pose, points.
const DETAILS: f32 = 34.0;

/// The pose library.
#[derive(Debug, Default)]
pub struct PosesPanel {
    query: String,
    /// The folder that the document was asked to read.
    asked: Option<PathBuf>,
    /// The path that is being typed.
    path: Option<String>,
    chosen: Option<ChosenPose>,
    /// The pose that is dragged.
    blend: Option<PoseBlend>,
    /// Pictures, by name of the file.
    figures: HashMap<String, Arc<[StickLine]>>,
    /// Number of the reading that the pictures belong to, and the model.
    of: Option<(u64, Arc<LoadedModel>)>,
}

/// The pose whose name and tags can be edited.
#[derive(Clone, Debug, PartialEq)]
struct ChosenPose {
    file: String,
    name: String,
    /// Separated by commas.
    tags: String,
}

impl Panel for PosesPanel {
    fn id(&self) -> &'static str {
        "poses"
    }

    fn title(&self) -> &'static str {
        "Poses"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::BelowRight
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some(view) = context.view else { return widgets::empty(ui, "Poses appear here", "") };
        let now = (context.poses.version(), &view.loaded);
        if self.of.as_ref().is_none_or(|of| of.0 != now.0 || !Arc::ptr_eq(&of.1, now.1)) {
            self.of = Some((now.0, Arc::clone(now.1)));
            self.figures.clear();
        }
        self.blend.take_if(|_| !context.keys.is_dragging());
        let folder = context.pose_folder();
        if let Some(folder) = folder.filter(|folder| self.asked.as_deref() != Some(*folder)) {
            self.asked = Some(folder.to_owned());
            send(requests, PoseOrder::Read(folder.to_owned()));
        }
        ui.columns(2, |columns| {
            self.folder_row(&mut columns[0], context, folder, requests);
            search_field::show(&mut columns[1], &mut self.query, "Find a pose", false);
        });
        let Some(folder) = folder else {
            return widgets::empty(ui, "No folder", "Choose a folder for poses above, or type its path");
        };
        // Below the cards, so that they stay where they are when one is chosen by the first click of a double click.
        let below = if self.chosen.is_some() { DETAILS } else { 0.0 };
        let height = (ui.available_height() - below).max(0.0);
        ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
            ui.set_min_height(height);
            self.cards(ui, context, folder, requests);
        });
        if let Some(chosen) = self.chosen.take() {
            self.chosen = details(ui, context, folder, chosen, requests);
        }
    }
}

fn send(requests: &mut Vec<Request>, order: PoseOrder) {
    requests.push(Request::Answer(FileAction::Send(DocumentMessage::Poses(order))));
}

/// Returns the words between commas.
fn tags(text: &str) -> Vec<String> {
    text.split(',').map(str::trim).filter(|tag| !tag.is_empty()).map(str::to_owned).collect()
}

/// Returns the poses whose names or tags contain every word of `query`.
fn found<'a>(context: &PanelContext<'a>, query: &str) -> Vec<&'a PoseFile> {
    let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    let has = |pose: &StoredPose, word: &String| {
        pose.name.to_lowercase().contains(word)
            || pose.tags.iter().any(|tag| tag.to_lowercase().contains(word))
    };
    let poses = context.poses.folder().poses.iter();
    poses.filter(|file| words.iter().all(|word| has(&file.pose, word))).collect()
}

impl PosesPanel {
    /// Draws the path of the folder, and the button that saves the pose.
    fn folder_row(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        folder: Option<&Path>,
        requests: &mut Vec<Request>,
    ) {
        ui.add_space(GRID);
        ui.horizontal(|ui| {
            ui.add_space(2.0 * GRID);
            let able = folder.is_some() && context.bone_count() > 0;
            let bones = if context.selection.bones().is_empty() { "all bones" } else { "the selected bones" };
            let save = ui.add_enabled_ui(able, |ui| widgets::icon_button(ui, Icon::Add, "Save pose", false));
            let save = save.inner.on_hover_text(format!("Saves the pose of {bones} in the folder"));
            if save.clicked()
                && let Some(folder) = folder
                && let Some(poses) = actions::shown_pose(context)
            {
                let names: Vec<&str> =
                    context.poses.folder().poses.iter().map(|file| file.pose.name.as_str()).collect();
                let numbered = (1..).map(|number| format!("Pose {number}"));
                let name = numbered.into_iter().find(|name| !names.contains(&name.as_str()));
                let pose = StoredPose::new(name.unwrap_or_default(), Vec::new(), poses);
                send(requests, PoseOrder::Save { folder: folder.to_owned(), file: None, pose });
            }
            let choose = widgets::icon_button(ui, Icon::Open, "Choose folder…", false);
            if choose.on_hover_text("Choose folder…\nShows the system's dialog for folders").clicked() {
                requests.push(Request::Choose(FileChoice::PoseFolder, folder.map(Path::to_owned)));
            }
            let shown = folder.map_or(String::new(), |folder| folder.display().to_string());
            let text = self.path.get_or_insert(shown.clone());
            let width = (ui.available_width() - 2.0 * GRID).max(40.0);
            let field = TextEdit::singleline(text).hint_text("Folder of poses").desired_width(width);
            let field = ui.add(field).accessible_name("Folder of poses");
            if field.lost_focus() {
                let path = text.trim().trim_matches('"').to_owned();
                if path != shown && !path.is_empty() && ui.input(|input| input.key_pressed(Key::Enter)) {
                    requests.push(Request::PoseFolder(PathBuf::from(path)));
                }
                self.path = None;
            } else if !field.has_focus() {
                self.path = None;
            }
            field.on_hover_text("The folder of the pose library; its files can be shared");
        });
    }

    fn cards(&mut self, ui: &mut Ui, context: &PanelContext<'_>, folder: &Path, requests: &mut Vec<Request>) {
        let poses = found(context, &self.query);
        if poses.is_empty() {
            return if context.poses.folder().poses.is_empty() {
                widgets::empty(ui, "No poses", "Save the pose of the selected bones with the button above")
            } else {
                widgets::empty(ui, "No pose matches the search", "")
            };
        }
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let columns = (((ui.available_width() - 2.0 * GRID) / (CARD[0] + GRID)).floor() as usize).max(1);
            let rows = poses.len().div_ceil(columns);
            for row in 0..rows {
                ui.horizontal(|ui| {
                    ui.spacing_mut().item_spacing = vec2(GRID, GRID);
                    ui.add_space(GRID);
                    for file in poses.iter().skip(row * columns).take(columns) {
                        self.card(ui, context, folder, file, requests);
                    }
                });
            }
            for problem in &context.poses.folder().problems {
                ui.horizontal(|ui| {
                    ui.add_space(2.0 * GRID);
                    let text = widgets::shortened(problem);
                    ui.label(RichText::new(text).small().color(Theme::of(ui).warning));
                });
            }
        });
    }

    fn card(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        folder: &Path,
        file: &PoseFile,
        requests: &mut Vec<Request>,
    ) {
        let figure = match self.figures.get(&file.file) {
            Some(figure) => Arc::clone(figure),
            None => {
                let figure = actions::figure(context, &file.pose.poses);
                self.figures.insert(file.file.clone(), Arc::clone(&figure));
                figure
            }
        };
        let blend = self.blend.as_ref().filter(|blend| blend.file() == file.file);
        let chosen = self.chosen.as_ref().is_some_and(|chosen| chosen.file == file.file);
        let card = Card { file, figure: &figure, is_chosen: chosen, amount: blend.map(PoseBlend::amount) };
        let (event, response) = card.show(ui);
        let mut push = |request| requests.push(Request::Timeline(request));
        match event {
            CardEvent::Nothing => {}
            CardEvent::Clicked => {
                let (name, tags) = (file.pose.name.clone(), file.pose.tags.join(", "));
                self.chosen = Some(ChosenPose { file: file.file.clone(), name, tags });
            }
            CardEvent::Applied => requests.extend(actions::apply(context, &file.pose.poses, false)),
            CardEvent::Blended(amount) => {
                if self.blend.as_ref().is_none_or(|blend| blend.file() != file.file) {
                    self.blend = PoseBlend::begin(context, file);
                }
                if let Some(edit) = self.blend.as_mut().and_then(|blend| blend.edit(context, amount)) {
                    push(KeysRequest::Drag(KeyDragOp::Edit(edit)));
                }
            }
            CardEvent::Released => push(KeysRequest::Release),
            CardEvent::Cancelled => push(KeysRequest::Cancel),
        }
        response.context_menu(|ui| {
            let entry = |ui: &mut Ui, title: &str, able: bool| {
                let clicked = ui.add_enabled(able, Button::new(title).frame_when_inactive(false)).clicked();
                if clicked {
                    ui.close();
                }
                clicked
            };
            let able = context.take().is_some();
            if entry(ui, "Apply", able) {
                requests.extend(actions::apply(context, &file.pose.poses, false));
            }
            if entry(ui, "Apply mirrored", able) {
                requests.extend(actions::apply(context, &file.pose.poses, true));
            }
            if entry(ui, "Delete pose", true) {
                let order = PoseOrder::Delete { folder: folder.to_owned(), file: file.file.clone() };
                send(requests, order);
            }
        });
    }
}

/// Draws name, tags and commands of the chosen pose. Returns it as long as it is chosen.
fn details(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    folder: &Path,
    mut chosen: ChosenPose,
    requests: &mut Vec<Request>,
) -> Option<ChosenPose> {
    let poses = &context.poses.folder().poses;
    let file = poses.iter().find(|file| file.file == chosen.file)?;
    let mut closes = false;
    ui.horizontal(|ui| {
        ui.add_space(2.0 * GRID);
        let width = ((ui.available_width() - 260.0) / 2.0).max(60.0);
        let mut entered = false;
        for (text, hint) in [(&mut chosen.name, "Name of the pose"), (&mut chosen.tags, "Tags, with commas")]
        {
            let field = ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(width));
            let field = field.accessible_name(hint);
            entered |= field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        }
        let changed = chosen.name != file.pose.name || tags(&chosen.tags) != file.pose.tags;
        if entered && changed && !chosen.name.trim().is_empty() {
            let name = chosen.name.trim().to_owned();
            let pose = StoredPose::new(name, tags(&chosen.tags), file.pose.poses.clone());
            let order = PoseOrder::Save { folder: folder.to_owned(), file: Some(chosen.file.clone()), pose };
            send(requests, order);
        }
        let able = context.take().is_some();
        if ui.add_enabled(able, Button::new("Apply")).clicked() {
            requests.extend(actions::apply(context, &file.pose.poses, false));
        }
        if ui.add_enabled(able, Button::new("Mirrored")).on_hover_text("Apply mirrored").clicked() {
            requests.extend(actions::apply(context, &file.pose.poses, true));
        }
        closes = widgets::icon_button(ui, Icon::Close, "Close the pose", false).clicked();
    });
    (!closes).then_some(chosen)
}
