//! What is shown and chosen right now. Panels read it and ask for changes; only [`super::execute`] makes them.

use super::digest::Digest;
use super::dragging::Dragging;
use super::hands::{Hold, Trail};
use super::keys::Keys;
pub use super::posed::Posed;
pub use super::request::{Effect, Request};
use super::saving::Question;
use super::settings::Settings;
use super::status::Status;
use crate::control::ViewportTools;
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_document::bones::{BoneSelection, Choice, HiddenBones};
use dragonfly_document::history::Gesture;
use dragonfly_document::posing::IkMode;
use dragonfly_document::{LoadedModel, Progress, View};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::ClickCycle;
use dragonfly_picture::playback::PlaybackClock;
use std::cell::Cell;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A model on its way.
#[derive(Clone, Debug, PartialEq)]
pub struct Loading {
    /// Its title.
    pub title: String,
    /// How far it is.
    pub progress: Progress,
}

/// What is known of the graphics device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Device {
    /// It is being made.
    #[default]
    Starting,
    /// It draws.
    Ready {
        /// Adapter, backend, driver.
        adapter: String,
    },
    /// Lost too often; waits for the person.
    Paused {
        /// What the driver said.
        reason: String,
    },
}

/// What lies over the panels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// Search for a command.
    Palette,
    /// Keys and mouse.
    Shortcuts,
    /// Version and licences.
    About,
    /// A field for a path.
    OpenPath,
    /// Which bone is the other side of which.
    MirrorPairs,
}

/// Everything the panels show.
pub struct State {
    /// The newest document; none before the first model is there.
    pub view: Option<View>,
    /// What follows from it.
    pub digest: Digest,
    /// Poses at the time shown.
    pub posed: Posed,
    /// The selected bones; the active one is [`Self::selected`].
    pub selection: BoneSelection,
    /// Bones that stay where and how they are while others are moved.
    pub pins: Vec<BoneIndex>,
    /// Do the bones above follow one that is moved?
    pub ik: IkMode,
    /// Bones put out of sight.
    pub hidden: HiddenBones,
    /// The bone under the pointer.
    pub hovered: Option<BoneIndex>,
    /// Where the pointer is over the picture, in points.
    pub pointer: Option<egui::Pos2>,
    /// The bone there, as far as the answer is known.
    pub pointed: Option<BoneIndex>,
    /// Which time of which take.
    pub playback: PlaybackClock,
    /// What the timeline and the curves share.
    pub keys: Keys,
    /// From where.
    pub camera: Camera,
    /// Has the camera been placed for the model that is open?
    pub framed: bool,
    /// What is remembered between runs.
    pub settings: Settings,
    /// Quiet lines.
    pub status: Status,
    /// A model on its way.
    pub loading: Option<Loading>,
    /// How many files were given together with the one on its way and are not opened, until the person is told.
    pub passed_over: usize,
    /// The graphics device.
    pub device: Device,
    /// How long the last frame took, milliseconds.
    pub frame_time: Option<f32>,
    /// What lies over the panels.
    pub overlay: Option<Overlay>,
    /// What the person is asked, the first one first.
    pub questions: VecDeque<(u64, Question)>,
    /// How many questions were asked so far.
    pub asked: u64,
    /// Was the document lost by a mistake in the program, and its work not offered yet?
    pub lost: bool,
    /// Is the cursor to be put into the search field?
    pub find: bool,
    /// Where the picture is, in points.
    pub viewport: egui::Rect,
    /// What lies over the picture, in points.
    pub shields: Vec<egui::Rect>,
    /// What a person acts on the picture with.
    pub hands: ViewportTools,
    /// What the hands hold on to.
    pub hold: Hold,
    /// The drag that goes on, whoever holds it.
    pub dragging: Dragging,
    /// Where the selected bone moves along.
    pub trail: Trail,
    /// Repeated clicks go through what lies behind.
    pub cycle: ClickCycle,
    /// When a drag was refused that a key asked for: what is typed for it is no command.
    pub(super) refused_drag: Option<Instant>,
    /// Was the last click on a handle of the gizmo? Then it is no click beside everything.
    pub(super) on_handle: bool,
    /// What is remembered of each file.
    pub marks: super::marks::Marks,
    /// What the list of takes is about to do.
    pub takes: super::takes::TakesState,
    /// Names of gestures given so far.
    gestures: Cell<u64>,
    /// Does the window fill the screen?
    pub full_screen: bool,
    /// The moment this frame shows.
    pub now: Instant,
}

impl State {
    /// Nothing open.
    pub fn new(settings: Settings, now: Instant) -> Self {
        let playback = PlaybackClock::rest(now).with(false, settings.speed, settings.repeat, now);
        Self {
            view: None,
            digest: Digest::default(),
            posed: Posed::default(),
            selection: BoneSelection::default(),
            pins: Vec::new(),
            ik: IkMode { on: settings.hand.ik.on, length: settings.hand.ik.length, pole: None },
            hidden: HiddenBones::default(),
            hovered: None,
            pointer: None,
            pointed: None,
            playback,
            keys: Keys::of(settings.timeline),
            camera: Camera::default(),
            framed: false,
            settings,
            status: Status::default(),
            loading: None,
            passed_over: 0,
            device: Device::default(),
            frame_time: None,
            overlay: None,
            questions: VecDeque::new(),
            asked: 0,
            lost: false,
            find: false,
            viewport: egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(800.0, 600.0)),
            shields: Vec::new(),
            hands: ViewportTools::default(),
            hold: Hold::default(),
            dragging: Dragging::default(),
            trail: Trail::default(),
            cycle: ClickCycle::default(),
            refused_drag: None,
            on_handle: false,
            marks: super::marks::Marks::default(),
            takes: super::takes::TakesState::default(),
            gestures: Cell::new(0),
            full_screen: false,
            now,
        }
    }

    /// Begins a frame: computes what the panels read.
    pub fn begin(&mut self, now: Instant) {
        self.now = now;
        // A take that plays once has arrived: the button shows it, and nothing needs to wake up any more.
        if self.playback.playing
            && self.playback.take.is_some()
            && !self.playback.moves(now)
            && self.playback.speed != 0.0
        {
            let time = self.playback.time_at(now);
            self.playback.playing = false;
            self.playback = self.playback.seek(time, now);
        }
        self.settle_keys();
        self.keep_room();
        self.forget_unlisted_keys();
        self.posed.running = self.playback.moves(now);
        self.digest.update(self.view.as_ref(), self.playback.take, self.selection.active());
        if let Some(view) = &self.view {
            self.posed.hold_still(&self.keys.flags, view);
            self.trail.hold_still(&self.keys.flags, view);
        }
        if let Some(view) = &self.view
            && self.selection.active().is_some()
        {
            self.posed.update(view, self.playback.take, self.playback.time_at(now));
        }
        self.grasp();
        self.follow_path();
    }

    /// Shows another document: its first take that moves, playing from the start.
    pub fn show(&mut self, view: View) {
        let view = self.dragging.echo.receive(view, &mut self.view);
        let fresh = self.view.as_ref().is_none_or(|old| !Arc::ptr_eq(&old.loaded, &view.loaded));
        if fresh {
            self.note_marks();
        }
        let before = self.view.replace(view);
        if !fresh {
            self.follow_take(before.as_ref().map_or(&[], |view| &view.slots));
            self.keep_markers(before.as_ref());
            self.tell(before.as_ref());
            return self.keep_take();
        }
        let bones = self.loaded().map_or(0, |loaded| loaded.model.animation.skeleton.len());
        self.drop_hold();
        self.cycle.forget();
        self.selection = BoneSelection::new(bones);
        self.hidden = HiddenBones::default();
        self.forget_pins();
        self.hovered = None;
        self.pointed = None;
        self.framed = false;
        self.open_keys();
        self.recall_marks();
        self.guess_frame_rate();
        let takes = self.view.as_ref().map_or(&[][..], |view| &view.takes);
        // Some programs write a single pose before all that moves.
        let moving = takes.iter().position(|take| take.length > 0.0);
        let first = moving.or((!takes.is_empty()).then_some(0));
        self.show_take(first);
        // Who has work brought back wants to go on where it stood.
        let restored = self.view.as_ref().is_some_and(|view| !view.history.steps.is_empty());
        let plays = moving.is_some() && !restored && self.question().is_none();
        self.playback = self.playback.with(plays, self.settings.speed, self.settings.repeat, self.now);
        self.frame_model();
        self.framed = true;
    }

    /// Says what was done since `before`.
    fn tell(&mut self, before: Option<&View>) {
        if let Some(done) = before
            .zip(self.view.as_ref())
            .and_then(|(old, new)| super::change_summary::describe_change(old, new))
        {
            self.status.remark(done);
        }
    }

    /// Shows a take from its start; keeps playing or standing.
    pub fn show_take(&mut self, index: Option<usize>) {
        self.leave_take();
        let bounds = self.take_of(index).map(|take| (take.start, take.length));
        self.playback.take = bounds.and(index);
        (self.playback.start, self.playback.length) = bounds.unwrap_or((0.0, 0.0));
        // A single pose does not play, and in it time can be moved to where the next one shall be.
        self.playback.playing &= bounds.is_none_or(|(_, length)| length > 0.0);
        self.playback = self.playback.seek(self.playback.start, self.now);
    }

    /// Goes on with the take that is shown, at the same time of it, where it begins or ends elsewhere now or is gone.
    fn keep_take(&mut self) {
        self.settle_keys();
        let time = self.playback.time_at(self.now);
        let bounds =
            self.take().map(|_| if self.playback.playing { self.play_bounds() } else { self.take_bounds() });
        if bounds == Some((self.playback.start, self.playback.length)) {
            return;
        }
        self.playback.take = bounds.and(self.playback.take);
        let (start, length) = bounds.unwrap_or((0.0, 0.0));
        (self.playback.start, self.playback.length) = (start, length);
        self.playback.playing &= length > 0.0;
        self.playback = self.playback.seek(time, self.now);
    }

    /// The model that is open.
    pub fn loaded(&self) -> Option<&LoadedModel> {
        self.view.as_ref().map(|view| &*view.loaded)
    }

    /// The take that is shown.
    pub fn take(&self) -> Option<&Take> {
        self.take_of(self.playback.take)
    }

    fn take_of(&self, index: Option<usize>) -> Option<&Take> {
        self.view.as_ref()?.takes.get(index?).map(|take| &**take)
    }

    /// Seconds in the take, now.
    pub fn time(&self) -> f32 {
        self.playback.time_at(self.now)
    }

    /// The name of a bone, or a stand-in.
    pub fn bone_name(&self, bone: BoneIndex) -> String {
        let name = self
            .loaded()
            .and_then(|loaded| loaded.model.animation.skeleton.bones.get(bone as usize))
            .map_or("", |bone| bone.name.as_str());
        if name.is_empty() { format!("Bone {bone}") } else { name.to_owned() }
    }

    /// Are bones drawn? Also when one is selected, when some are hidden, which is for seeing the others, and where there
    /// is nothing else to see.
    pub fn shows_skeleton(&self) -> bool {
        let bare = self.loaded().is_some_and(|loaded| loaded.model.instances.is_empty());
        self.settings.look.skeleton || self.selected().is_some() || !self.hidden.is_empty() || bare
    }

    /// The active bone: of those that are selected, the one that was selected last.
    pub fn selected(&self) -> Option<BoneIndex> {
        self.selection.active()
    }

    /// Selects this bone alone, or none.
    pub fn select(&mut self, bone: Option<BoneIndex>) {
        self.selection.click(bone, Choice::Replace);
    }

    /// Names a new gesture: a drag, a slider held, whose many edits are one step.
    pub fn new_gesture(&self) -> Gesture {
        self.gestures.set(self.gestures.get() + 1);
        Gesture(self.gestures.get())
    }

    /// The bone that is drawn brighter: under the pointer, in the tree or in the picture.
    pub fn bright(&self) -> Option<BoneIndex> {
        self.hovered.or(self.pointed)
    }

    /// Width over height of the picture.
    pub fn aspect(&self) -> f32 {
        (self.viewport.width() / self.viewport.height().max(1.0)).max(0.01)
    }

    /// When the panels have to be drawn again for the time display, if they have to.
    pub fn next_display(&self) -> Option<Duration> {
        self.playback.moves(self.now).then_some(Duration::from_millis(33))
    }
}
