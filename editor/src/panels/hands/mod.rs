//! What the hands do to the state: inputs of the scene come in as they happen, and what follows goes out at once.

mod feed;
mod follow;
mod grasp;
mod path;
mod tools;

pub use feed::feed;
pub use grasp::Hold;
pub use path::Trail;

use super::state::{Effect, State};
use super::status::Level;
use crate::control::gizmo::GizmoAnswer;
use crate::control::path::PathAnswer;
use crate::control::{Area, Button, InputEvent, Outcome};
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BonePose, Edit};
use dragonfly_document::history::Gesture;
use egui::{Pos2, Rect, pos2};
use glam::Vec2;
use std::time::Instant;

impl State {
    /// Takes an input of the scene; what reaches further is added to `effects`. Tells whether a control took it.
    ///
    /// Allocates nothing that grows with the model.
    pub fn input(&mut self, event: InputEvent, effects: &mut Vec<Effect>) -> bool {
        if event == InputEvent::MouseDown(Button::Left) && self.playback.playing && self.hands.over_handle() {
            // Who takes hold of something wants it to stand still.
            self.now = Instant::now();
            self.stop_at(self.time());
            self.grasp();
        }
        self.hands.look(&self.camera);
        let stopped = self.hands.input(event);
        if stopped && matches!(event, InputEvent::MouseDown(_)) {
            // The picture has the hand now: what is copied is the pose.
            self.keys.has_hand = false;
        }
        self.follow(effects);
        stopped
    }

    /// The wheel was turned over the picture, or two fingers spread: points, positive is nearer.
    pub fn wheel(&mut self, by: f32) {
        self.hands.look(&self.camera);
        self.hands.input(InputEvent::Wheel(Vec2::new(0.0, by)));
        self.camera = self.hands.picture().camera;
    }

    /// Where the picture is, and what lies over it.
    pub(super) fn place_hands(&mut self) {
        let area = |rect: Rect| Area::new(place(rect.min), place(rect.max));
        let shields = self.shields.iter().map(|rect| area(rect.intersect(self.viewport)));
        self.hands.place(area(self.viewport), shields);
        self.hands.look(&self.camera);
    }

    /// Carries out what the controls ask for.
    fn follow(&mut self, effects: &mut Vec<Effect>) {
        self.camera = self.hands.picture().camera;
        let corner = self.viewport.min;
        let there = |at: Vec2| pos2(corner.x + at.x, corner.y + at.y);
        match self.hands.picture_mut().take_outcome() {
            Some(Outcome::Pick(at, choice)) => {
                self.on_handle = false;
                effects.push(Effect::Pick(there(at), choice));
            }
            Some(Outcome::Catch(region, choice)) => effects.push(Effect::Catch(region, choice)),
            None => {}
        }
        if let Some(mouse) = self.hands.gizmo_mut().take_click() {
            self.on_handle = true;
            effects.push(Effect::Pick(pos2(mouse.at.x, mouse.at.y), Choice::from(mouse.modifiers)));
        }
        if self.hands.gizmo_mut().take_refused() {
            self.refuse();
        }
        if let Some(answer) = self.hands.gizmo_mut().take_answer() {
            self.gizmo_answered(answer, effects);
        }
        if let Some(answer) = self.hands.path_mut().take_answer() {
            self.path_answered(answer, effects);
        }
    }

    /// Says why a pose cannot be changed.
    pub(super) fn refuse(&mut self) {
        if let Some(bone) = self.selection.active().filter(|_| self.playback.take.is_some()) {
            return self.say_locked(bone);
        }
        let text = "The rest pose stays as it is: show a take to change a pose in it";
        self.status.say(Level::Info, text);
    }

    fn gizmo_answered(&mut self, answer: GizmoAnswer, effects: &mut Vec<Effect>) {
        match answer {
            GizmoAnswer::Ignored => {}
            GizmoAnswer::Changed => {
                self.begin_following();
                let idle = self.hands.gizmo().gizmo.is_identity();
                // A press that changes nothing yet is no edit.
                if !idle || self.hold.gesture().is_some() {
                    let poses = self.dragged();
                    self.edit_held(poses, effects);
                }
            }
            GizmoAnswer::Confirmed if self.hands.gizmo().gizmo.is_identity() => self.let_go(true, effects),
            GizmoAnswer::Confirmed => self.let_go(false, effects),
            GizmoAnswer::Cancelled => self.let_go(true, effects),
        }
    }

    fn path_answered(&mut self, answer: PathAnswer, effects: &mut Vec<Effect>) {
        match answer {
            PathAnswer::Moved(key) => {
                let Some(edit) = self.path_edit(key) else { return };
                self.send_held(edit, effects);
            }
            PathAnswer::Done => self.let_go(false, effects),
            PathAnswer::Cancelled => self.let_go(true, effects),
        }
    }

    /// The newest form of what is being dragged.
    fn edit_held(&mut self, poses: Vec<BonePose>, effects: &mut Vec<Effect>) {
        if let Some(edit) = self.pose_edit(poses) {
            self.send_held(edit, effects);
        }
    }

    /// Of locked bones nothing is sent, as from anywhere else.
    fn send_held(&mut self, edit: Edit, effects: &mut Vec<Effect>) {
        let gesture = self.held_gesture();
        let effect = self.unlocked(Effect::Change(Change::Edit(edit, Some(gesture))));
        effects.extend(effect);
    }

    /// The drag that goes on, under one name from its first edit to its last.
    fn held_gesture(&mut self) -> Gesture {
        let name = self.hold.gesture().unwrap_or_else(|| self.new_gesture());
        self.hold.begin(name);
        name
    }

    fn let_go(&mut self, cancel: bool, effects: &mut Vec<Effect>) {
        if let Some(gesture) = self.hold.end() {
            let end = if cancel { Change::Cancel } else { Change::Release };
            effects.push(Effect::Change(end(gesture)));
        }
    }
}

pub(super) fn place(at: Pos2) -> Vec2 {
    Vec2::new(at.x, at.y)
}
