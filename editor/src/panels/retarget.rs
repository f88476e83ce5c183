//! The dialog for retargeting: a file, its takes, and the bones of both models side by side.

use super::bone_choice::{BoneChoice, add_left, names};
use super::context::PanelContext;
use super::dialog_preview::DialogPreview;
use super::file_choice::FileChoice;
use super::icons::Icon;
use super::overlay_title;
use super::request::{FileAction, Request};
use super::shown_skeleton::{ShownSkeleton, SkeletonChange};
use super::source_place::SourcePlace;
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::data::{BoneIndex, ModelData, Skeleton};
use dragonfly_anim::retarget::{BindingGuess, BoneRole, FigureOptions, SkeletonBinding};
use dragonfly_document::bones::Choice;
use dragonfly_document::{BoneMap, ClipOrder, DocumentMessage, LoadedModel, MapFile, RetargetOrder, Source};
use egui::{Button, Checkbox, Key, Popup, Response, RichText, ScrollArea, TextEdit, TextStyle, Ui, vec2};
use std::path::PathBuf;
use std::sync::Arc;

/// Width of the dialog, points.
const WIDTH: f32 = 500.0;

/// State of the dialog: the typed paths, the map and the options.
#[derive(Debug)]
pub(super) struct RetargetDialog {
    path: String,
    map_path: String,
    /// The models between which bones are mapped, and their guess.
    models: Option<(Arc<LoadedModel>, Arc<Skeleton>, BindingGuess)>,
    of: ShownSkeleton,
    /// The map that was applied.
    map: Option<Arc<BoneMap>>,
    /// For each bone of the open model the bone of the source that moves it.
    source_of: Vec<Option<BoneIndex>>,
    take: usize,
    contacts: bool,
    /// Whether the result becomes a layer over the take that is shown.
    as_layer: bool,
    /// The place of the source in the viewport; `None`: it is not shown.
    place: Option<SourcePlace>,
    shows_source: bool,
}

impl Default for RetargetDialog {
    fn default() -> Self {
        Self {
            path: String::new(),
            map_path: String::new(),
            models: None,
            of: ShownSkeleton::default(),
            map: None,
            source_of: Vec::new(),
            take: 0,
            contacts: true,
            as_layer: false,
            place: None,
            shows_source: true,
        }
    }
}

impl RetargetDialog {
    /// Draws the dialog; `fresh` where it was not shown in the frame before.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        fresh: bool,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        ui.set_width(WIDTH);
        overlay_title::show(ui, "Retarget from file", requests);
        let theme = Theme::of(ui);
        let Some(loaded) = context.loaded() else {
            ui.label(RichText::new("Open the model that is to get the take first").color(theme.weak));
            return;
        };
        let has_source = context.retarget.source().is_some();
        self.file_row(ui, fresh && !has_source, context, requests);
        let Some(source) = context.retarget.source() else {
            let text = "The bones of both models appear here. Names of Mixamo, Unreal, VRM, Rigify, CMU, KayKit and Quaternius are known.";
            ui.label(RichText::new(text).small().color(theme.weak));
            return;
        };
        self.adopt(context, source, &loaded.model);
        self.heading(ui, source);
        self.rows(ui, context, source, requests);
        self.map_row(ui, context, source, requests);
        self.show_source(ui, context, requests);
        self.last_row(ui, context, source, requests);
    }

    /// Draws the field for the file with the take, and the button that shows the system's dialog.
    fn file_row(
        &mut self,
        ui: &mut Ui,
        takes_focus: bool,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        ui.horizontal(|ui| {
            let browse = widgets::icon_button(ui, Icon::Open, "Choose file…", false);
            if browse.on_hover_text("Choose file…\nShows the system's dialog for files").clicked() {
                requests.push(Request::Choose(FileChoice::RetargetSource, context.model_folder()));
            }
            let (field, pressed) = path_field(
                ui,
                &mut self.path,
                "Path of the model with the take",
                (WIDTH - 36.0, &["Read"][..]),
            );
            if takes_focus {
                field.request_focus();
            }
            if let Some((_, path)) = pressed {
                send(requests, DocumentMessage::ReadSource(Source::File(path)));
            }
        });
    }

    /// Guesses the map of new models, and applies a map that was read.
    fn adopt(&mut self, context: &PanelContext<'_>, source: &Arc<LoadedModel>, model: &ModelData) {
        let target = &model.animation.skeleton;
        if let SkeletonChange::Shifted(shift) = self.of.follow(context.view)
            && let Some((from, to, guess)) = &mut self.models
        {
            // Bones of the open model have other indices; the map stays as the user has it.
            *guess = BindingGuess::of_models(&from.model, model);
            *to = Arc::clone(target);
            let kept = self.source_of.iter().skip(shift.removed()).copied();
            self.source_of = std::iter::repeat_n(None, shift.added()).chain(kept).collect();
        }
        let known = |(from, to, _): &(Arc<LoadedModel>, Arc<Skeleton>, BindingGuess)| {
            Arc::ptr_eq(from, source) && Arc::ptr_eq(to, target)
        };
        if !self.models.as_ref().is_some_and(known) {
            let guess = BindingGuess::of_models(&source.model, model);
            self.source_of.clone_from(&guess.binding.source_of);
            self.models = Some((Arc::clone(source), Arc::clone(target), guess));
            (self.take, self.map) = (0, None);
            self.place = None;
        }
        let map = context.retarget.map();
        let new = map.filter(|map| !self.map.as_ref().is_some_and(|applied| Arc::ptr_eq(applied, map)));
        if let Some(map) = new {
            if let Ok((binding, _)) = map.binding(&source.model.animation.skeleton, target) {
                self.source_of = binding.source_of;
            }
            self.map = Some(Arc::clone(map));
        }
    }

    fn heading(&self, ui: &mut Ui, source: &LoadedModel) {
        let Some((_, _, guess)) = &self.models else { return };
        let convention = |name: Option<&'static str>| name.unwrap_or("no known convention");
        let bound = self.source_of.iter().flatten().count();
        let facts = [
            format!("{} ({})", source.title, convention(guess.source.convention)),
            format!("this model ({})", convention(guess.target.convention)),
            format!("{bound} of {} move", widgets::count(self.source_of.len(), "bone", "bones")),
        ];
        ui.label(RichText::new(widgets::dot_separated(&facts)).small().color(Theme::of(ui).weak));
        ui.add_space(GRID);
    }

    /// Draws one row for each bone of the open model: its name, and the bone of the source.
    fn rows(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        source: &LoadedModel,
        requests: &mut Vec<Request>,
    ) {
        let theme = Theme::of(ui);
        let target_names = names(context);
        let bones = &source.model.animation.skeleton.bones;
        let source_names: Vec<String> = bones.iter().map(|bone| bone.name.clone()).collect();
        let width = 0.5 * WIDTH - 40.0;
        ui.horizontal(|ui| {
            for title in ["Bone of this model", "Bone of the file that moves it"] {
                ui.add_sized(
                    vec2(width, ROW),
                    egui::Label::new(RichText::new(title).small().color(theme.weak)).halign(egui::Align::Min),
                );
            }
        });
        let area = ScrollArea::vertical().max_height(11.0 * ROW).auto_shrink([false, true]);
        area.show_rows(ui, ROW, target_names.len().min(self.source_of.len()), |ui, shown| {
            for bone in shown {
                ui.horizontal(|ui| {
                    ui.set_height(ROW);
                    let name = &target_names[bone];
                    let selected = context.selection.contains(bone as BoneIndex);
                    let text = widgets::cut_in_middle(ui, name, width - 16.0, &TextStyle::Body);
                    let button = Button::selectable(selected, text);
                    if add_left(ui, button, width).on_hover_text(name).clicked() {
                        requests.push(Request::SelectBones(vec![bone as BoneIndex], Choice::Replace));
                    }
                    let label = format!("The bone that moves {name}");
                    let choice =
                        BoneChoice { names: &source_names, none: Some("rests"), label: &label, width };
                    if let Some(chosen) = choice.show(ui, self.source_of[bone]) {
                        self.source_of[bone] = chosen;
                    }
                });
            }
        });
    }

    /// Draws the switch for the skeleton of the source in the viewport, and keeps that up to date.
    fn show_source(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let Some((source, target, guess)) = &self.models else { return };
        let place = *self.place.get_or_insert_with(|| {
            let is_part =
                |roles: &[Option<BoneRole>], bone: usize| roles.get(bone).is_some_and(Option::is_some);
            let own = |bone: usize| is_part(&guess.target.of, bone);
            let others = |bone: usize| is_part(&guess.source.of, bone);
            let animation = &source.model.animation;
            let take = animation.takes.get(self.take).map(|take| &**take);
            SourcePlace::beside(target, &animation.skeleton, take, [&own, &others])
        });
        let switch = ui.checkbox(&mut self.shows_source, "Show the source beside the model");
        widgets::hint_beside(
            &switch,
            "Draws the skeleton of the file in the viewport, at the size of this model, in the pose of its take at the time of the playhead; the bone that moves the selected one is emphasized",
        );
        let shown = context.shown_take();
        let over = shown.map_or_else(|| "the take".to_owned(), |take| widgets::shortened(&take.name));
        let choice = Checkbox::new(&mut self.as_layer, format!("As a layer over {over}"));
        let choice = ui.add_enabled(shown.is_some(), choice);
        let hint = "Adds a layer of poses with the keys to the take that is shown, instead of a new take; weight and bones of the layer can be changed in Layers";
        widgets::hint_beside(&choice, hint);
        let SourcePlace { scale, offset } = place;
        let marked = context.selected().and_then(|bone| self.source_of.get(bone as usize).copied().flatten());
        let source = DialogPreview::Source { take: self.take, scale, offset, marked };
        let preview = if self.shows_source { source } else { DialogPreview::Nothing };
        if preview != context.preview {
            requests.push(Request::Preview(preview));
        }
    }

    fn map_row(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        source: &LoadedModel,
        requests: &mut Vec<Request>,
    ) {
        let buttons = (WIDTH, &["Load map", "Save map"][..]);
        let (_, pressed) = path_field(ui, &mut self.map_path, "Path of a bone map", buttons);
        if let Some((button, path)) = pressed {
            let map = self.bone_map(context, source).filter(|_| button > 0);
            let file = map.map_or(MapFile::Read(path.clone()), |map| MapFile::Write(path, map));
            send(requests, DocumentMessage::MapFile(file));
        }
    }

    /// Returns the map as the user has it.
    fn bone_map(&self, context: &PanelContext<'_>, source: &LoadedModel) -> Option<BoneMap> {
        let (_, target, guess) = self.models.as_ref()?;
        let binding = SkeletonBinding { source_of: self.source_of.clone(), ..guess.binding.clone() };
        let titles = [source.title.as_str(), context.loaded().map_or("", |loaded| loaded.title.as_str())];
        Some(BoneMap::of(titles, &source.model.animation.skeleton, target, &binding))
    }

    fn last_row(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        source: &LoadedModel,
        requests: &mut Vec<Request>,
    ) {
        let takes = &source.model.animation.takes;
        let name = |take: usize| takes.get(take).map_or("no take", |take| take.name.as_str()).to_owned();
        ui.horizontal(|ui| {
            let text = widgets::shortened(&format!("Take: {}", name(self.take)));
            let button = ui.add_enabled(!takes.is_empty(), Button::new(text));
            Popup::menu(&button).show(|ui| {
                ScrollArea::vertical().max_height(10.0 * ROW).show(ui, |ui| {
                    for take in 0..takes.len() {
                        if ui.add(Button::selectable(take == self.take, name(take))).clicked() {
                            (self.take, self.place) = (take, None);
                        }
                    }
                });
            });
            ui.checkbox(&mut self.contacts, "Keep contacts")
                .on_hover_text("Keep contacts\nFeet stay where they touch the ground");
            let guess = ui.button("Guess again");
            widgets::hint_beside(&guess, "Replaces the map by the guess from names");
            if let Some((_, _, found)) = self.models.as_ref().filter(|_| guess.clicked()) {
                self.source_of.clone_from(&found.binding.source_of);
            }
            let pairs: Vec<(BoneIndex, BoneIndex)> = (0..)
                .zip(&self.source_of)
                .filter_map(|(to, from)| Some((from.as_ref().copied()?, to)))
                .collect();
            let has_pairs = !pairs.is_empty();
            let able = self.take < takes.len() && has_pairs;
            let shown = context.shown_take_ref();
            let layer_of = shown.filter(|_| self.as_layer);
            let title = if layer_of.is_some() { "Add layer" } else { "Add take" };
            if ui.add_enabled(able, Button::new(title)).clicked() {
                let options = FigureOptions { contacts: self.contacts, ..FigureOptions::default() };
                send(
                    requests,
                    DocumentMessage::Retarget(RetargetOrder { take: self.take, layer_of, pairs, options }),
                );
                requests.push(Request::Overlay(None));
            }
            let button = ui.add_enabled(has_pairs, Button::new("Import files…"));
            widgets::hint_beside(&button, "Adds all takes of files that you choose, with this map of bones");
            if let Some(map) = self.bone_map(context, source).filter(|_| button.clicked()) {
                let order =
                    ClipOrder { map: Some(map), contacts: self.contacts, ..ClipOrder::of(Vec::new()) };
                requests.push(Request::ChooseMapped(Box::new(order)));
            }
        });
    }
}

fn send(requests: &mut Vec<Request>, message: DocumentMessage) {
    requests.push(Request::Answer(FileAction::Send(message)));
}

/// Draws a field for a path with buttons, on a width. Returns the field, and the index of the pressed button with the path; Enter
/// presses the first.
fn path_field(
    ui: &mut Ui,
    text: &mut String,
    name: &str,
    (width, buttons): (f32, &[&str]),
) -> (Response, Option<(usize, PathBuf)>) {
    let mut pressed = None;
    let field = ui.horizontal(|ui| {
        let width = width - 90.0 * buttons.len() as f32;
        let field =
            TextEdit::singleline(text).hint_text(name).desired_width(width).font(TextStyle::Monospace);
        let field = ui.add(field).accessible_name(name);
        if field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
            pressed = Some(0);
        }
        let able = !text.trim().is_empty();
        for (index, title) in buttons.iter().enumerate() {
            if ui.add_enabled(able, Button::new(*title)).clicked() {
                pressed = Some(index);
            }
        }
        field
    });
    let path = text.trim().trim_matches('"');
    (field.inner, pressed.filter(|_| !path.is_empty()).map(|button| (button, PathBuf::from(path))))
}
