//! The state of the panels, as the program around them uses it: requests go in, effects come out, and [`State::read`] gives
//! what is shown.

use super::actions::{
    bones, compare, drags, execute, feed, files, input, playback, scene_files, scene_view, show,
};
use super::context::PanelContext;
use super::dropped_files::WantedFiles;
use super::export::AnsweredExport;
use super::looked_folder::LookedFolder;
use super::open_model::Loading;
use super::prompts::{Overlay, Question};
use super::reference::ReferenceTrack;
use super::request::{Effect, Request};
use super::scene::{SceneSounds, SceneThumbnails};
use super::settings::Settings;
use super::side_files::SideFiles;
use super::sound::SoundTrack;
use super::status::MessageSeverity;
use super::take_findings;
use super::window_status::WindowStatus;
use super::workspace::Workspace;
use crate::control::InputEvent;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::Choice;
use dragonfly_document::{
    BoneMap, CheckedTake, ExportOrder, ExportReport, LoadedModel, NotSaved, Offer, PoseFolder, SaveOrder,
    SavedFile, View,
};
use egui::{Context, Pos2, RawInput};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Everything that the panels show.
pub struct State {
    workspace: Workspace,
}

impl State {
    /// Returns the state before a model is open.
    pub fn new(settings: Settings, now: Instant) -> Self {
        Self { workspace: Workspace::new(settings, now) }
    }

    /// Returns what panels read.
    pub fn read(&self) -> PanelContext<'_> {
        self.workspace.read()
    }

    /// Executes a request of a panel. Returns an effect for the program around the panels, if there is one.
    pub fn execute(&mut self, request: Request) -> Option<Effect> {
        execute::execute(&mut self.workspace, request)
    }

    /// Starts a frame: computes what the panels read.
    pub fn begin_frame(&mut self, now: Instant) {
        show::begin_frame(&mut self.workspace, now);
    }

    /// Ends a frame: forgets the row under the pointer and the request to focus the search field, because both apply to
    /// one frame.
    pub fn end_frame(&mut self) {
        self.workspace.bones.hover(None);
        self.workspace.prompts.set_find(false);
    }

    /// Returns the request to check the take that is shown for problems, once for each of its states while problems are shown.
    pub fn wanted_check(&mut self) -> Option<Effect> {
        let (take, effect) = take_findings::check(&self.workspace.read())?;
        let unit = self.workspace.unit.meters();
        self.workspace.findings.request(&take, unit).then_some(effect)
    }

    /// Shows the problems of a take that was checked.
    pub fn checked(&mut self, checked: CheckedTake) {
        self.workspace.findings.set_checked(checked);
    }

    /// Sets the moment that the panels show.
    pub fn set_now(&mut self, now: Instant) {
        self.workspace.player.set_now(now);
    }

    /// Shows a newer view of the document. If it is of another model, plays the first take that moves from its start.
    pub fn show(&mut self, view: View) {
        show::show(&mut self.workspace, view);
    }

    /// Passes the events of `input` from index `from` on to the tools of the viewport, and removes those that are for
    /// the tools alone. Returns whether the viewport may look different now.
    pub fn feed(
        &mut self,
        context: &Context,
        input: &mut RawInput,
        from: usize,
        effects: &mut Vec<Effect>,
    ) -> bool {
        feed::feed(context, &mut self.workspace, input, from, effects)
    }

    /// Gives an event to the tools of the viewport. Returns whether a tool took it.
    pub fn input(&mut self, event: InputEvent, effects: &mut Vec<Effect>) -> bool {
        input::input(&mut self.workspace, event, effects)
    }

    /// Inserts the events that end a cancelled drag before those of `input`. Returns whether more follow in the next frame.
    pub fn prepend_events(&mut self, context: &Context, input: &mut RawInput) -> bool {
        self.workspace.dragging.prepend_events(context, input)
    }

    /// Passes an effect on. If it would interrupt a drag, the change that cancels the drag is passed on first.
    pub fn let_through(&mut self, effect: Effect, pass: &mut impl FnMut(Effect)) {
        drags::let_through(&mut self.workspace, effect, pass);
    }

    /// Handles an edit that the document refused.
    pub fn edit_refused(&mut self) {
        drags::refused(&mut self.workspace);
    }

    /// Pauses playback at the time shown, if it is running.
    pub fn pause(&mut self) {
        playback::pause(&mut self.workspace);
    }

    /// Selects one of the bones under a click, the nearest first.
    pub fn picked(&mut self, at: Pos2, bones: &[BoneIndex], choice: Choice) {
        bones::picked(&mut self.workspace, at, bones, choice);
    }

    /// Selects the bones inside a box or lasso.
    pub fn caught(&mut self, bones: &[BoneIndex], choice: Choice) {
        self.workspace.bones.caught(bones, choice);
    }

    /// Sets the bone under the pointer in the viewport. Returns whether it changed.
    pub fn set_pointed(&mut self, bone: Option<BoneIndex>) -> bool {
        self.workspace.bones.set_pointed(bone)
    }

    /// Selects one of the things of a scene under a click, the nearest first.
    pub fn thing_picked(&mut self, at: Pos2, things: &[Arc<str>], choice: Choice) {
        scene_view::picked(&mut self.workspace, at, things, choice);
    }

    /// Selects the things of a scene inside a box or lasso.
    pub fn things_caught(&mut self, things: &[Arc<str>], choice: Choice) {
        scene_view::caught(&mut self.workspace, things, choice);
    }

    /// Sets the thing of a scene under the pointer in the viewport. Returns whether it changed.
    pub fn set_pointed_thing(&mut self, thing: Option<Arc<str>>) -> bool {
        scene_view::point(&mut self.workspace, thing)
    }

    /// Shows the model whose takes are wanted, in the dialog for retargeting.
    pub fn source_read(&mut self, source: Arc<LoadedModel>) {
        self.workspace.retarget.set_source(source);
    }

    /// Compares the take that is shown with a take of a file that was read.
    pub fn compared_read(&mut self, file: Arc<LoadedModel>) -> Option<Effect> {
        compare::file_read(&mut self.workspace, file)
    }

    /// Shows what an export would lose, or reports that it was written and closes its dialog.
    pub fn exported(&mut self, order: ExportOrder, done: Result<ExportReport, String>) {
        if !order.is_written {
            self.workspace.export = Some(AnsweredExport { order, done });
            return;
        }
        match done {
            Ok(report) => {
                let path = report.files.first().map(|file| file.path.display().to_string());
                let files = match (report.files.len(), path) {
                    (1, Some(path)) => format!("Exported {path}"),
                    (count, _) => format!("Exported {count} files"),
                };
                self.say(MessageSeverity::Info, files);
                self.workspace.export = None;
                if self.workspace.prompts.overlay() == Some(Overlay::Export) {
                    self.workspace.prompts.show(None);
                }
            }
            Err(reason) => self.say(MessageSeverity::Error, reason),
        }
    }

    /// Shows a bone map that was read, in the dialog for retargeting.
    pub fn map_read(&mut self, map: BoneMap) {
        self.workspace.retarget.set_map(map);
    }

    /// Returns the reference picture, to which the program around the panels adds what it read.
    pub fn reference(&mut self) -> &mut ReferenceTrack {
        &mut self.workspace.reference
    }

    /// Returns the sound, to which the program around the panels adds what it read.
    pub fn sound(&mut self) -> &mut SoundTrack {
        &mut self.workspace.sound
    }

    /// Returns the sounds of the scene, to which the program around the panels adds what it read.
    pub fn scene_sounds(&mut self) -> &mut SceneSounds {
        self.workspace.scene.sounds_mut()
    }

    /// Returns the pictures of the shots, to which the program around the panels adds what was drawn.
    pub fn thumbnails(&mut self) -> &mut SceneThumbnails {
        self.workspace.scene.thumbnails_mut()
    }

    /// Uses files that the scene is to get, of which a job has found out where they are and copied this number; or asks about those outside of
    /// its folder.
    pub fn files_answered(&mut self, wanted: Box<WantedFiles>, copied: usize) -> Option<Effect> {
        scene_files::answered(&mut self.workspace, wanted, copied)
    }

    /// Shows the poses of the library.
    pub fn poses_read(&mut self, folder: PoseFolder) {
        self.workspace.poses.set_folder(folder);
    }

    /// Sets the folder of the pose library that is used if none was chosen.
    pub fn set_usual_pose_folder(&mut self, folder: Option<PathBuf>) {
        self.workspace.poses.set_usual(folder);
    }

    /// Asks a question after those that are already waiting.
    pub fn ask(&mut self, question: Question) {
        files::ask(&mut self.workspace, question);
    }

    /// Asks where the file of unsaved work is, or reports that `other` is another file.
    pub fn ask_where_it_is(&mut self, offer: Box<Offer>, other: Option<PathBuf>) {
        files::ask_where_it_is(&mut self.workspace, offer, other);
    }

    /// Asks about unsaved work of an earlier run.
    pub fn ask_to_recover(&mut self, offers: Vec<Offer>) {
        files::ask_to_recover(&mut self.workspace, offers);
    }

    /// Notes which folders a save into a folder creates, as a path in the one that exists; `None` where it creates none.
    pub fn set_new_folders(&mut self, folder: PathBuf, created: Option<PathBuf>) {
        self.workspace.prompts.set_looked_folder(LookedFolder::new(folder, created));
    }

    /// Removes the questions about unsaved work whose file was found.
    pub fn offer_is_answered(&mut self, offer: &Offer) {
        self.workspace.prompts.offer_is_answered(offer);
    }

    /// Notes that the document was lost by an internal error.
    pub fn document_lost(&mut self) {
        self.workspace.prompts.document_lost();
        self.workspace.dragging.echo.forget();
    }

    /// Reports a save that was completed, and the pending poses that it left out.
    pub fn saved(&mut self, saved: &SavedFile) {
        files::saved(&mut self.workspace, saved);
    }

    /// Handles a save that failed: asks the user what to do, or reports the reason.
    pub fn not_saved(&mut self, order: SaveOrder, reason: NotSaved) -> Option<Effect> {
        files::not_saved(&mut self.workspace, order, reason)
    }

    /// Shows an overlay, or none.
    pub fn show_overlay(&mut self, overlay: Option<Overlay>) {
        self.workspace.prompts.show(overlay);
    }

    /// Adds a message to the status line.
    pub fn say(&mut self, level: MessageSeverity, text: impl Into<String>) {
        self.workspace.say(level, text);
    }

    /// Sets the load in progress; `None` when it ended.
    pub fn set_loading(&mut self, loading: Option<Loading>) {
        self.workspace.model.set_loading(loading);
    }

    /// Notes the number of files that stay closed because one model is open at a time.
    pub fn pass_over(&mut self, files: usize) {
        self.workspace.model.pass_over(files);
    }

    /// Returns the number of files that stay closed, and forgets it.
    pub fn take_passed_over(&mut self) -> usize {
        self.workspace.model.take_passed_over()
    }

    /// Returns the state of the window and of the graphics device, to change it.
    pub fn window_mut(&mut self) -> &mut WindowStatus {
        &mut self.workspace.window
    }

    /// Returns the settings, to change them.
    pub fn settings_mut(&mut self) -> &mut Settings {
        &mut self.workspace.settings
    }

    /// Returns whether a file that was opened is the model of a thing, in place of its scene. Its view may come before or after this is asked.
    pub fn is_opened_in_place(&self, path: &Path) -> bool {
        let view = self.workspace.model.view();
        let is_shown = |view: &View| view.waiting_scene.is_some() && view.file.path.as_deref() == Some(path);
        let entered = self.workspace.entered.as_ref();
        view.is_some_and(is_shown) || entered.is_some_and(|entered| entered.is_model(path))
    }

    /// Returns when the time display or the status line must be drawn again, if they must.
    pub fn next_display(&self) -> Option<Duration> {
        let message = self.workspace.status.next_change();
        let measuring = self.workspace.contacts.is_measuring().then_some(Duration::ZERO);
        let turning = self.workspace.stage.turn_left(self.workspace.player.now());
        [self.workspace.player.next_display(), message, measuring, turning].into_iter().flatten().min()
    }

    /// Returns the markers and marks as the text of their files.
    pub fn side_files(&mut self) -> SideFiles<'_> {
        SideFiles::of(&mut self.workspace)
    }
}
