//! The scene as it is edited: what is selected, hidden and locked, its lanes, and the newest text.

use super::action_selection::ActionSelection;
use super::follow::new_actions;
use super::hide_and_lock::{HideAndLock, SceneMarks};
use super::last_split::{LastSplit, SplitActions};
use super::line_editing::{LineEditing, MarkedThings};
use super::newest_text::NewestText;
use super::renamed_things::RenamedThings;
use super::request::ScriptChange;
use super::sounds::SceneSounds;
use super::thing_selection::ThingSelection;
use super::thumbnails::SceneThumbnails;
use crate::panels::keys::TimeWindow;
use crate::panels::selection_trail::WalkDirection;
use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::{RigidPlace, StagePlan};
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{Edit, TextRef};
use dragonfly_document::history::Gesture;
use dragonfly_document::{Change, MissingFile, SceneView};
use std::sync::Arc;

/// The state of the editor of scenes; it contains nothing of the document.
#[derive(Clone, Debug)]
pub struct SceneEditing {
    things: ThingSelection,
    /// The selected actions of the script that is shown.
    actions: ActionSelection,
    hiding: HideAndLock,
    renaming: Option<Box<str>>,
    /// The things that are selected as soon as the script has them.
    awaited: Vec<Box<str>>,
    /// The text whose new actions are selected as soon as it is shown, or these actions of it.
    awaited_actions: Option<(Arc<str>, Option<Vec<usize>>)>,
    /// The last split: what was selected in the text before it, and the text after it.
    last_split: Option<LastSplit>,
    ripple: bool,
    /// The part of time that the timeline shows; `None` for all.
    window: Option<TimeWindow>,
    shown: Option<(Arc<StageScript>, Arc<StagePlan>)>,
    lanes: Arc<SceneLanes>,
    lines: LineEditing,
    sounds: SceneSounds,
    thumbnails: SceneThumbnails,
    script: NewestText,
    /// The text of the project that the script belongs to.
    project: NewestText,
    /// The gesture that is a word that someone types.
    typing: Option<Gesture>,
    /// The missing file that the user looks for.
    finding: Option<MissingFile>,
}

impl Default for SceneEditing {
    fn default() -> Self {
        Self {
            things: ThingSelection::default(),
            actions: ActionSelection::default(),
            hiding: HideAndLock::default(),
            renaming: None,
            awaited: Vec::new(),
            awaited_actions: None,
            last_split: None,
            ripple: true,
            window: None,
            shown: None,
            lanes: Arc::default(),
            lines: LineEditing::default(),
            sounds: SceneSounds::default(),
            thumbnails: SceneThumbnails::default(),
            script: NewestText::default(),
            project: NewestText::default(),
            typing: None,
            finding: None,
        }
    }
}

impl SceneEditing {
    /// Returns the newest text: the one that was asked for or sent last, or that of the view.
    pub fn text<'a>(&'a self, scene: &'a SceneView) -> &'a Arc<str> {
        self.script.text(&scene.text)
    }

    /// Returns the newest text of the project; `None` for a script that is open alone.
    pub fn project_text<'a>(&'a self, scene: &'a SceneView) -> Option<&'a Arc<str>> {
        scene.texts.main().filter(|_| scene.is_of_project()).map(|text| self.project.text(text))
    }

    /// Returns the ids of the selected things, the active one last.
    pub fn things(&self) -> &[Box<str>] {
        self.things.list()
    }

    /// Returns whether a thing is selected.
    pub fn is_selected(&self, thing: &str) -> bool {
        self.things.contains(thing)
    }

    /// Returns the active action: the one that was selected last.
    pub fn action(&self) -> Option<usize> {
        self.actions.list().last().copied()
    }

    /// Returns the selected actions, the active one last.
    pub fn actions(&self) -> &[usize] {
        self.actions.list()
    }

    /// Returns whether an action is selected.
    pub fn is_action_selected(&self, action: usize) -> bool {
        self.actions.contains(action)
    }

    /// Returns whether a thing is hidden.
    pub fn is_hidden(&self, thing: &str) -> bool {
        self.hiding.hidden().contains(thing)
    }

    /// Returns the ids of the hidden things.
    pub fn hidden(&self) -> impl Iterator<Item = &str> {
        self.hiding.hidden().iter().map(|id| &**id)
    }

    /// Returns whether a thing is locked: gestures do not change it.
    pub fn is_locked(&self, thing: &str) -> bool {
        self.hiding.locked().contains(thing)
    }

    /// Returns why a change of these things is refused: one of them is locked.
    pub fn lock_refusal(&self, things: &[Box<str>]) -> Option<String> {
        let locked = things.iter().find(|thing| self.is_locked(thing))?;
        Some(format!("{locked} is locked"))
    }

    /// Returns the thing whose name is being typed.
    pub fn renaming(&self) -> Option<&str> {
        self.renaming.as_deref()
    }

    /// Returns whether what follows in a sequence moves along.
    pub fn ripple(&self) -> bool {
        self.ripple
    }

    /// Returns the part of time that the timeline shows: the whole scene, unless another part was chosen.
    pub fn window(&self) -> TimeWindow {
        let end = self.lanes.end.seconds().max(1.0);
        let whole = TimeWindow { start: 0.0, length: end * 1.04 }.sanitized();
        self.window.map_or(whole, |window| window.within(end))
    }

    /// Returns whether the timeline shows the whole scene, however long it becomes.
    pub(in crate::panels) fn shows_all(&self) -> bool {
        self.window.is_none()
    }

    pub(in crate::panels) fn set_window(&mut self, window: Option<TimeWindow>) {
        self.window = window.map(TimeWindow::sanitized);
    }

    /// Returns the lanes of the script that is shown.
    pub fn lanes(&self) -> &Arc<SceneLanes> {
        &self.lanes
    }

    /// Returns the sounds, as far as they were read.
    pub fn sounds(&self) -> &SceneSounds {
        &self.sounds
    }

    pub(in crate::panels) fn sounds_mut(&mut self) -> &mut SceneSounds {
        &mut self.sounds
    }

    /// Returns the pictures of the shots, as far as they were drawn.
    pub fn thumbnails(&self) -> &SceneThumbnails {
        &self.thumbnails
    }

    pub(in crate::panels) fn thumbnails_mut(&mut self) -> &mut SceneThumbnails {
        &mut self.thumbnails
    }

    /// Returns the lines as they are edited.
    pub fn lines(&self) -> &LineEditing {
        &self.lines
    }

    pub(in crate::panels) fn lines_mut(&mut self) -> &mut LineEditing {
        &mut self.lines
    }

    /// Adapts what is drawn of lines and paths to the scene and the selection. While something is dragged (`is_dragging`), more changes are likely to come.
    /// `of` is the place of what the selected line moves with.
    pub(in crate::panels) fn update_lines(
        &mut self,
        scene: Option<&SceneView>,
        is_dragging: bool,
        of: Option<RigidPlace>,
    ) {
        let (selected, hidden, locked) = (self.things.list(), self.hiding.hidden(), self.hiding.locked());
        self.lines.update(scene, MarkedThings { selected, hidden, locked }, is_dragging, of);
    }

    /// Returns whether a gesture is a word that someone types.
    pub fn is_typing(&self, gesture: Option<Gesture>) -> bool {
        gesture.is_some() && self.typing == gesture
    }

    pub(in crate::panels) fn select_things(&mut self, things: &[Box<str>], choice: Choice) {
        self.lines.select(None);
        self.things.choose(things, choice);
    }

    /// Selects a drawn line, or none. With a line nothing else is selected.
    pub(in crate::panels) fn select_line(&mut self, line: Option<Box<str>>) {
        if line.is_some() {
            self.things.replace(Vec::new());
            self.actions = ActionSelection::default();
        }
        self.lines.select(line);
    }

    /// Replaces, adds or toggles drawn lines. With a line nothing else is selected.
    pub(in crate::panels) fn select_lines(&mut self, lines: &[Box<str>], choice: Choice) {
        self.things.replace(Vec::new());
        self.actions = ActionSelection::default();
        self.lines.choose(lines, choice);
    }

    /// Selects an action and the thing that acts.
    pub(in crate::panels) fn select_action(&mut self, action: Option<usize>) {
        self.select_actions(action.as_slice(), Choice::Replace);
    }

    /// Replaces, adds or toggles actions, and selects the thing that does the last one.
    pub(in crate::panels) fn select_actions(&mut self, actions: &[usize], choice: Choice) {
        self.lines.select(None);
        self.actions.choose(actions, choice);
        let Some((script, _)) = &self.shown else { return };
        let active = self.action().filter(|&action| action < script.actions().len());
        let element = active.map(|action| script.element(action));
        if let Some(who) = element.and_then(|element| element.value("who")) {
            self.things.replace(vec![who.into()]);
        }
    }

    /// Selects what is at a byte of the script: a thing, or an action.
    pub(in crate::panels) fn select_at(&mut self, at: usize) {
        let Some((script, _)) = &self.shown else { return };
        let tree = script.tree();
        let Some(mut element) = tree.element_at(at) else { return };
        loop {
            if let Some(action) = script.actions().iter().position(|action| action.element == element) {
                return self.select_action((action > 0).then_some(action));
            }
            let own = &tree.elements()[element];
            if let Some(id) = own.value("id").filter(|id| script.thing_called(id).is_some()) {
                self.actions = ActionSelection::default();
                self.select_things(&[id.into()], Choice::Replace);
                return;
            }
            let Some(parent) = own.parent else { return };
            element = parent;
        }
    }

    /// Returns what is hidden and locked, as it is remembered for a file.
    pub(in crate::panels) fn marks(&self) -> SceneMarks<'_> {
        self.hiding.marks()
    }

    /// Hides and locks the things that a file was left with.
    pub(in crate::panels) fn recall_marks(&mut self, hidden: Vec<Box<str>>, locked: Vec<Box<str>>) {
        self.hiding.hide(hidden, true);
        self.hiding.lock(locked, true);
    }

    /// Hides things or shows them, as a step of undo after the first `done` ones of the history.
    pub(in crate::panels) fn hide(&mut self, things: Vec<Box<str>>, hide: bool, done: usize) {
        let label = if hide { "Hide" } else { "Show" };
        self.hiding.step(done, label, |hiding| hiding.hide(things, hide));
    }

    /// Locks things or unlocks them, as a step of undo after the first `done` ones of the history.
    pub(in crate::panels) fn lock(&mut self, things: Vec<Box<str>>, lock: bool, done: usize) {
        let label = if lock { "Lock" } else { "Unlock" };
        self.hiding.step(done, label, |hiding| hiding.lock(things, lock));
    }

    /// Returns the label of the change of what is hidden or locked that undo or redo is about; `None` where it is about a step of the history.
    pub(in crate::panels) fn next_hiding(
        &self,
        done: usize,
        direction: WalkDirection,
    ) -> Option<&'static str> {
        self.hiding.next(done, direction)
    }

    /// Undoes or redoes a change of what is hidden or locked. Returns whether there was one after the first `done` steps of the history.
    pub(in crate::panels) fn walk_hiding(&mut self, done: usize, direction: WalkDirection) -> bool {
        self.hiding.walk(done, direction)
    }

    /// Forgets the changes of what is hidden and locked after the first `done` steps of the history: other steps follow those now.
    pub(in crate::panels) fn forget_hiding_after(&mut self, done: usize) {
        self.hiding.forget_after(done);
    }

    pub(in crate::panels) fn rename(&mut self, thing: Option<Box<str>>) {
        self.renaming = thing;
    }

    /// Selects things as soon as the script has them.
    pub(in crate::panels) fn await_things(&mut self, things: Vec<Box<str>>) {
        self.awaited = things;
    }

    /// Returns the things that are selected as soon as the script has them.
    pub(in crate::panels) fn awaited(&self) -> &[Box<str>] {
        &self.awaited
    }

    /// Selects the actions that this text has more than the one that is shown, as soon as it is shown.
    pub(in crate::panels) fn await_actions(&mut self, text: Arc<str>) {
        self.awaited_actions = Some((text, None));
    }

    /// Selects these actions of this text, the second halves of others, as soon as it is shown. What was split is selected again after an undo.
    pub(in crate::panels) fn await_halves(
        &mut self,
        text: Arc<str>,
        halves: Vec<usize>,
        split: SplitActions,
    ) {
        self.last_split = Some(LastSplit::new(split, Arc::clone(&text)));
        self.awaited_actions = Some((text, Some(halves)));
    }

    pub(in crate::panels) fn set_ripple(&mut self, ripple: bool) {
        self.ripple = ripple;
    }

    /// Returns the state without what has not ended: edits that were not answered, gestures, names that are typed.
    pub(in crate::panels) fn left(&self) -> Self {
        Self {
            renaming: None,
            awaited: Vec::new(),
            awaited_actions: None,
            script: NewestText::default(),
            project: NewestText::default(),
            typing: None,
            finding: None,
            ..self.clone()
        }
    }

    /// Continues with a state that was left. Sounds are read again: their files may have changed.
    pub(in crate::panels) fn resume(&mut self, left: Self) {
        *self = Self { sounds: std::mem::take(&mut self.sounds), ..left };
    }

    /// Forgets everything: another document is open.
    pub(in crate::panels) fn reset(&mut self) {
        *self = Self { ripple: self.ripple, sounds: self.sounds.cleared(), ..Self::default() };
    }

    /// Adapts to a newer view. Returns the things that have other names in it.
    pub(in crate::panels) fn update(&mut self, scene: Option<&SceneView>, answered: u64) -> RenamedThings {
        self.script.update(answered);
        self.project.update(answered);
        let shown = scene
            .and_then(|scene| Some((Arc::clone(scene.script.as_ref()?), Arc::clone(scene.plan.as_ref()?))));
        let mut renamed = RenamedThings::default();
        let Some((script, plan)) = shown else { return renamed };
        let is_same = |(old, planned): &(Arc<StageScript>, Arc<StagePlan>)| {
            Arc::ptr_eq(old, &script) && Arc::ptr_eq(planned, &plan)
        };
        if self.shown.as_ref().is_some_and(is_same) {
            return renamed;
        }
        let mut added = Vec::new();
        if let Some((old, _)) = self.shown.as_ref().filter(|(old, _)| !Arc::ptr_eq(old, &script)) {
            let awaited = self.awaited_actions.take_if(|(text, _)| **text == **script.tree().text());
            if let Some((_, actions)) = awaited {
                added = actions.unwrap_or_else(|| new_actions(old, &script));
            } else if let Some(split) = self.last_split.as_ref().and_then(|last| last.undone(old, &script)) {
                added = split.to_vec();
            }
            self.actions.follow(old, &script);
            renamed = RenamedThings::between(old, &script);
            self.things.rename(&renamed);
            self.hiding.rename(&renamed);
            self.things.retain(|id| script.thing_called(id).is_some());
        }
        if !self.awaited.is_empty() && self.awaited.iter().all(|id| script.thing_called(id).is_some()) {
            let awaited = std::mem::take(&mut self.awaited);
            self.select_things(&awaited, Choice::Replace);
            self.actions = ActionSelection::default();
        }
        self.lanes = Arc::new(SceneLanes::new(&script, &plan));
        self.shown = Some((script, plan));
        if !added.is_empty() {
            self.select_actions(&added, Choice::Replace);
        }
        renamed
    }

    /// Returns the change of the document that makes a text the newest one; `None` where it is that already.
    ///
    /// # Errors
    ///
    /// The text was made from another one than the newest, or a thing that it changes is locked.
    pub(in crate::panels) fn change(
        &mut self,
        scene: &SceneView,
        change: &ScriptChange,
    ) -> Result<Option<Change>, String> {
        if let Some(reason) = self.lock_refusal(&change.things) {
            return Err(reason);
        }
        if !change.also.is_empty() && !self.script.has_gesture(change.gesture) {
            let text = |project: &Arc<StageProject>| Some(project.tree().text()) == scene.texts.main();
            let is_new = scene.project.as_ref().is_some_and(text);
            if !is_new || self.project.is_awaited() || self.script.is_awaited() {
                return Err("The project has just changed: try again".to_owned());
            }
        }
        let file = (scene.texts.list().len() > 1).then(|| TextRef::Name(scene.name.to_string()));
        self.script.change(&scene.text, file, change).map_err(str::to_owned)
    }

    /// Returns the change of the document that makes a text the newest one of the project; `None` where it is that already.
    ///
    /// # Errors
    ///
    /// The text was made from another one than the newest, or there is no project.
    pub(in crate::panels) fn change_project(
        &mut self,
        scene: &SceneView,
        change: &ScriptChange,
    ) -> Result<Option<Change>, &'static str> {
        let text = scene.texts.main().filter(|_| scene.is_of_project()).ok_or("The scene has no project")?;
        self.project.change(text, Some(TextRef::Index(0)), change)
    }

    /// Notes the gesture of a word that someone types.
    pub(in crate::panels) fn set_typing(&mut self, gesture: Option<Gesture>) {
        self.typing = gesture;
    }

    /// Returns the missing file that the user looks for.
    pub fn finding(&self) -> Option<&MissingFile> {
        self.finding.as_ref()
    }

    pub(in crate::panels) fn set_finding(&mut self, missing: Option<MissingFile>) {
        self.finding = missing;
    }

    /// Notes the number of a change that was passed on.
    pub(in crate::panels) fn passed_on(&mut self, number: u64, change: &Change) {
        self.script.passed_on(number, change);
        self.project.passed_on(number, change);
    }

    /// Forgets a text whose change was dropped: its gesture is over.
    pub(in crate::panels) fn dropped(&mut self, change: &Change) {
        if matches!(change, Change::Edit(Edit::EditScript(_), _)) {
            self.script.dropped();
            self.project.dropped();
        }
    }

    /// Forgets a text that the document refused.
    pub(in crate::panels) fn refused(&mut self) {
        self.awaited_actions = None;
        self.script.refused();
        self.project.refused();
    }
}
