//! Fixture of the viewport tool tests: the state of the window and a document, which the test runs step by step.

use dragonfly::control::gizmo::Gizmo;
use dragonfly::control::{Button, InputEvent, Key, Modifiers};
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Effect, Request, Settings, State};
use dragonfly_document::{
    Cancel, Change, Document, DocumentHandle, DocumentReply, LoadError, OpenedModel, Progress, Setup, Source,
    View,
};
use dragonfly_kit::document::received::Received;
use dragonfly_kit::eventually;
use dragonfly_picture::gizmo::{GizmoView, Handle};
use dragonfly_runtime::{Captured, Context, Receiver, Thread};
use glam::{Quat, Vec2};
use std::time::{Duration, Instant};

/// Rectangle of the viewport in the window: x, y, width, height, in points.
pub(crate) const PICTURE: [f32; 4] = [200.0, 50.0, 800.0, 600.0];

pub(crate) type Load = fn(&Source, &mut dyn FnMut(Progress), &Cancel) -> Result<OpenedModel, LoadError>;

struct IgnoredViews;

impl Receiver for IgnoredViews {
    type Message = View;

    fn receive(&mut self, _: View, _: &mut Context) {}
}

/// The state, the document, and the simulated mouse and keyboard that drive them.
pub(crate) struct ViewportHarness {
    pub(crate) state: State,
    /// Effects other than changes; changes are sent to the document.
    pub(crate) effects: Vec<Effect>,
    /// Edits that the document refused.
    pub(crate) refused: Vec<String>,
    main: Captured,
    thread: Captured,
    document: DocumentHandle,
    replies_received: Received<DocumentReply>,
}

impl ViewportHarness {
    /// Opens the model that `load` returns, paused at the start of its first take.
    pub(crate) fn new(load: Load) -> Self {
        let replies_received = Received::default();
        let mut main = Thread::capture("main", || {});
        let thread = Thread::capture("document", || {});
        let replies = main.context().register_receiver(replies_received.clone());
        let picture = main.context().register_receiver(IgnoredViews);
        let document =
            Document::start_in(thread.handle(), Setup { load, ..Setup::default() }, replies, picture);
        let state = State::new(Settings::default(), Instant::now());
        let (effects, refused) = (Vec::new(), Vec::new());
        let mut viewport = Self { state, effects, refused, main, thread, document, replies_received };
        let [x, y, width, height] = PICTURE;
        let rect = egui::Rect::from_min_size(egui::pos2(x, y), egui::vec2(width, height));
        viewport.state.execute(Request::Viewport(rect));
        viewport.document.open(Source::BuiltIn);
        eventually(Duration::from_secs(30), || {
            viewport.turn();
            viewport.state.read().view.is_some()
        });
        viewport.state.pause();
        viewport.state.execute(Request::Seek(0.0));
        viewport.state.begin_frame(viewport.state.read().now);
        viewport
    }

    /// Processes the queued messages of both threads.
    pub(crate) fn turn(&mut self) {
        self.thread.iterate();
        self.main.iterate();
        for reply in self.replies_received.0.take() {
            match reply {
                DocumentReply::View(view) => self.state.show(view),
                DocumentReply::Refused(reason) => self.refused.push(reason),
                _ => {}
            }
        }
        self.state.begin_frame(self.state.read().now);
    }

    /// Sends a numbered change and processes the queued messages of both threads.
    pub(crate) fn change_numbered(&mut self, number: u64, change: Change) {
        self.document.change_numbered(number, change);
        self.turn();
    }

    pub(crate) fn send(&mut self, event: InputEvent) -> bool {
        let mut effects = Vec::new();
        let taken = self.state.input(event, &mut effects);
        self.carry(effects);
        taken
    }

    pub(crate) fn carry(&mut self, effects: Vec<Effect>) {
        for effect in effects {
            match effect {
                Effect::Change(change) => self.document.change(change),
                other => self.effects.push(other),
            }
        }
        self.turn();
    }

    /// Does the same as [`Self::carry`] and empties the list, so that the caller can reuse it.
    pub(crate) fn carry_some(&mut self, effects: &mut Vec<Effect>) {
        if !effects.is_empty() {
            let effects = std::mem::take(effects);
            self.carry(effects);
            self.effects.clear();
        }
    }

    /// Returns the position of the active bone's joint in the viewport, or the viewport's center if the joint is not visible.
    pub(crate) fn joint_or_middle(&self) -> Vec2 {
        let middle = Vec2::new(PICTURE[2], PICTURE[3]) / 2.0;
        let bone = self.state.read().selected().unwrap_or_default();
        let Some(animation) = self.state.read().posed.animation() else { return middle };
        let joint = animation.to_root()[bone as usize].w_axis;
        let view = GizmoView::new(&self.state.read().camera, middle * 2.0);
        view.to_screen(joint.truncate().as_dvec3()).map_or(middle, |at| at.as_vec2())
    }

    pub(crate) fn command(&mut self, id: Id) {
        let effect = self.state.execute(Request::Command(id));
        self.carry(effect.into_iter().collect());
    }

    pub(crate) fn to(&mut self, at: Vec2) {
        self.send(InputEvent::MouseMove(at));
    }

    pub(crate) fn press(&mut self, at: Vec2) {
        self.to(at);
        self.send(InputEvent::MouseDown(Button::Left));
    }

    pub(crate) fn release(&mut self) {
        self.send(InputEvent::MouseUp(Button::Left));
    }

    pub(crate) fn hold(&mut self, modifiers: Modifiers) {
        self.send(InputEvent::Modifiers(modifiers));
    }

    pub(crate) fn keys(&mut self, text: &str) {
        for letter in text.chars() {
            self.key(Key::letter(letter));
        }
    }

    pub(crate) fn key(&mut self, key: Key) {
        self.send(InputEvent::KeyDown(key));
        self.send(InputEvent::KeyUp(key));
    }

    /// Returns a window position on this handle.
    pub(crate) fn handle(&self, wanted: Handle) -> Vec2 {
        let corner = Vec2::new(PICTURE[0], PICTURE[1]);
        let at = find(&self.state.read().tools.controls().gizmo().gizmo, self.joint(), wanted);
        at.unwrap_or_else(|| panic!("{wanted:?} is nowhere")) + corner
    }

    /// Returns the position of the active bone's joint, in points from the corner of the viewport.
    pub(crate) fn joint(&self) -> Vec2 {
        let bone = self.state.read().selected().expect("a bone is selected");
        let joint = self.state.read().posed.animation().expect("posed").to_root()[bone as usize].w_axis;
        let view = GizmoView::new(&self.state.read().camera, Vec2::new(PICTURE[2], PICTURE[3]));
        view.to_screen(joint.truncate().as_dvec3()).expect("in front of the camera").as_vec2()
    }

    /// Returns the local rotation of the active bone in the pose shown.
    pub(crate) fn rotation(&self) -> Quat {
        let bone = self.state.read().selected().expect("a bone is selected");
        self.state.read().posed.animation().expect("posed").poses()[bone as usize].rotation
    }

    /// Returns the names of the undo steps that are applied.
    pub(crate) fn steps(&self) -> Vec<&'static str> {
        let history = &self.state.read().view.expect("open").history;
        history.steps[..history.done].to_vec()
    }
}

/// Returns a position around `middle` on the wanted handle, with no other handle near.
pub(crate) fn find(gizmo: &Gizmo, middle: Vec2, wanted: Handle) -> Option<Vec2> {
    let offsets = (-50..=50).flat_map(|y| (-50..=50).map(move |x| Vec2::new(x as f32, y as f32) * 2.0));
    let is_there = |at: &Vec2| {
        let near = [Vec2::ZERO, Vec2::X, -Vec2::X, Vec2::Y, -Vec2::Y];
        near.iter().all(|by| gizmo.handle_at(*at + *by * 2.0) == Some(wanted))
    };
    offsets.map(|offset| middle + offset).find(is_there)
}
