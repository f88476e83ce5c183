//! The keys of a motion path as a control of the scene: each can be taken hold of and put elsewhere.

use super::base::{BaseControl, Mouse, Pass};
use super::framework::ControlFramework;
use super::key::{Key, Modifiers};
use super::viewport::Button;
use dragonfly_picture::gizmo::{AXIS_FROM, GizmoView};
use glam::{DVec3, Vec2, Vec3};

/// The pointer may miss a key by so much, points.
const REACH: f32 = 7.0;

/// A key on the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathKey {
    /// Seconds.
    pub time: f32,
    /// Where the joint is then, scene space.
    pub place: Vec3,
}

/// What became of a drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathAnswer {
    /// The joint is to be there at this key.
    Moved(PathKey),
    /// It is over.
    Done,
    /// As if it had not been.
    Cancelled,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Going {
    key: PathKey,
    start: Vec2,
}

/// See the module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathControl {
    /// Top left of the picture, points from that of the window.
    pub corner: Vec2,
    /// May keys be changed?
    pub editable: bool,
    /// Where the gizmo stands, scene space. Its handles are long and keys are small, so that these win everywhere but
    /// in the middle of it: a joint that rests has all of its keys there.
    pub gizmo: Option<DVec3>,
    keys: Vec<PathKey>,
    view: Option<GizmoView>,
    hovered: Option<usize>,
    going: Option<Going>,
    answer: Option<PathAnswer>,
}

impl PathControl {
    /// The keys there are. A drag that goes on keeps its own.
    pub fn show(&mut self, keys: &[PathKey]) {
        self.keys.clear();
        self.keys.extend_from_slice(keys);
        self.hovered = None;
    }

    /// From where it is seen.
    pub fn look(&mut self, view: GizmoView) {
        self.view = Some(view);
    }

    /// Is a key being dragged?
    pub fn is_dragging(&self) -> bool {
        self.going.is_some()
    }

    /// The time of the key under the pointer, or being dragged.
    pub fn hovered(&self) -> Option<f32> {
        let under = self.hovered.and_then(|key| self.keys.get(key));
        self.going.map(|going| going.key.time).or(under.map(|key| key.time))
    }

    /// What became of the drag since this was asked last.
    pub fn take_answer(&mut self) -> Option<PathAnswer> {
        self.answer.take()
    }

    fn key_at(&self, at: Vec2) -> Option<usize> {
        let view = self.view.filter(|_| at.is_finite() && self.editable)?;
        let middle = self.gizmo.and_then(|pivot| view.to_screen(pivot));
        let mut nearest: Option<(f64, usize)> = None;
        for (index, key) in self.keys.iter().enumerate() {
            let Some(place) = view.to_screen(key.place.as_dvec3()) else { continue };
            if middle.is_some_and(|middle| middle.distance(place) <= AXIS_FROM) {
                continue;
            }
            let distance = place.distance(at.as_dvec2());
            if distance <= f64::from(REACH) && nearest.is_none_or(|(best, _)| distance < best) {
                nearest = Some((distance, index));
            }
        }
        nearest.map(|(_, index)| index)
    }

    /// Where the pointer puts what it took hold of: as far from the eye as it was.
    fn put(&self, going: &Going, at: Vec2) -> Option<Vec3> {
        let view = self.view?;
        let place: DVec3 = going.key.place.as_dvec3();
        let by = view.move_by(place, (at - going.start).as_dvec2())?;
        let put = (place + by).as_vec3();
        put.is_finite().then_some(put)
    }

    fn end(&mut self, answer: PathAnswer) -> Pass {
        if self.going.take().is_none() {
            return Pass::ToParent;
        }
        self.answer = Some(answer);
        Pass::Stop
    }
}

impl BaseControl for PathControl {
    fn is_pos_on(&self, point: Vec2) -> bool {
        self.going.is_some() || self.key_at(point - self.corner).is_some()
    }

    fn mouse_move(&mut self, mouse: Mouse, _framework: &mut ControlFramework) -> Pass {
        let at = mouse.at - self.corner;
        match self.going {
            Some(going) => {
                if let Some(place) = self.put(&going, at) {
                    self.answer = Some(PathAnswer::Moved(PathKey { place, ..going.key }));
                }
                Pass::Stop
            }
            None => {
                self.hovered = self.key_at(at);
                // What lies behind a key has no handle under the pointer.
                if self.hovered.is_some() { Pass::Stop } else { Pass::ToParent }
            }
        }
    }

    fn mouse_leave(&mut self, _framework: &mut ControlFramework) {
        self.hovered = None;
    }

    fn mouse_down(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> Pass {
        if button == Button::Right {
            return self.end(PathAnswer::Cancelled);
        }
        let at = mouse.at - self.corner;
        let key = self.key_at(at).and_then(|key| self.keys.get(key)).copied();
        let begins = button == Button::Left && !mouse.modifiers.alt && self.going.is_none();
        match key.filter(|_| begins) {
            Some(key) => {
                self.going = Some(Going { key, start: at });
                Pass::Stop
            }
            None => Pass::ToParent,
        }
    }

    fn mouse_up(&mut self, button: Button, _mouse: Mouse, _framework: &mut ControlFramework) -> Pass {
        if button == Button::Left { self.end(PathAnswer::Done) } else { Pass::ToParent }
    }

    fn key_down(&mut self, key: Key, _: Modifiers, _: bool, _framework: &mut ControlFramework) -> Pass {
        if key == Key::Escape { self.end(PathAnswer::Cancelled) } else { Pass::ToParent }
    }

    fn input_lost(&mut self, _framework: &mut ControlFramework) {
        self.end(PathAnswer::Cancelled);
    }
}
