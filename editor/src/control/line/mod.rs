//! Lines drawn with the mouse in the viewport: freehand, straight, from corner to corner, and erased.
//!
//! ```text
//! drag            freehand, with Shift straight
//! click, click…   corners; Enter or a second click on the last one ends the line, Backspace takes a corner back
//! Ctrl + drag     erases what is under the pointer
//! Alt + drag      draws the path of a bone over time, where the pose of bones is drawn
//! Esc, right      gives up the line that is drawn, or the tool
//! ```

mod stroke;

pub use stroke::{DrawnStroke, LineSurface, StrokeMeasure};

use super::base::{BaseControl, InputFlow, Mouse};
use super::framework::ControlFramework;
use super::input::Button;
use super::key::{Key, Modifiers};
use super::viewport_tools::tool::{ToolOutcome, ViewportTool};
use dragonfly_picture::gizmo::GizmoView;
use glam::{DVec3, Vec2};
use stroke::DrawingPlane;

/// Distance from the press from which on a drag draws, points.
const THRESHOLD: f32 = 3.0;

/// Largest number of points of a stroke; a longer one ends there.
const MOST_POINTS: usize = 20_000;

/// The purpose of the tool: the kind of thing that a drawn line becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineUse {
    /// A line of the project.
    Note,
    /// A path of the script.
    Path,
    /// The pose of a chain of bones: its line of action.
    Pose,
    /// The path of a bone over time.
    Motion,
}

/// The outcome of an input.
#[derive(Clone, Debug, PartialEq)]
pub enum LineAnswer {
    /// A line was drawn.
    Drawn(LineUse, DrawnStroke),
    /// The eraser was put down here, points from the top left of the viewport.
    EraserDown(Vec2),
    /// The eraser was moved to here.
    EraserMoved(Vec2),
    /// The eraser was lifted: what it touched is erased.
    EraserUp,
    /// Nothing is under the press on which the line could be drawn, such as the ground above the horizon.
    NoPlace(LineSurface),
}

/// The state of the mouse.
#[derive(Clone, Debug, Default, PartialEq)]
enum LinePhase {
    #[default]
    Idle,
    /// The button is held; nothing is drawn yet.
    Pressed {
        at: Vec2,
        place: DVec3,
    },
    Freehand(Vec<DVec3>),
    Straight([DVec3; 2]),
    /// Corners, and the place under the pointer.
    Corners {
        corners: Vec<DVec3>,
        next: DVec3,
        press: Option<Vec2>,
    },
    Erase,
}

/// The control that draws lines. It covers the viewport while it has a use.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineControl {
    /// Top left of the viewport, points from that of the window.
    corner: Vec2,
    view: Option<GizmoView>,
    use_of: Option<LineUse>,
    surface: LineSurface,
    /// A place on the plane of lines that are drawn in the view, scene space.
    pivot: DVec3,
    /// The place on a surface under the pointer, scene space.
    hit: Option<DVec3>,
    /// Height of the ground, meters.
    ground: f64,
    phase: LinePhase,
    /// Whether what is drawn is the path of a bone, although the tool is for poses.
    is_motion: bool,
    answer: Option<LineAnswer>,
}

impl LineControl {
    /// Returns what a drawn line becomes; `None` while other tools are used.
    pub fn use_of(&self) -> Option<LineUse> {
        self.use_of
    }

    /// Chooses what a drawn line becomes, or puts the tool away. A line that is being drawn is given up.
    pub fn choose(&mut self, use_of: Option<LineUse>) {
        (self.use_of, self.phase) = (use_of, LinePhase::Idle);
    }

    /// Returns where lines are drawn. Paths are always on the ground, and lines of action in the view.
    pub fn surface(&self) -> LineSurface {
        match self.use_of {
            Some(LineUse::Path) => LineSurface::Ground,
            Some(LineUse::Pose | LineUse::Motion) => LineSurface::View,
            Some(LineUse::Note) | None => self.surface,
        }
    }

    /// Returns where lines of a project are drawn.
    pub fn note_surface(&self) -> LineSurface {
        self.surface
    }

    /// Chooses where lines are drawn.
    pub fn set_surface(&mut self, surface: LineSurface) {
        self.surface = surface;
    }

    /// Sets the place through which the plane of lines in the view goes, scene space.
    pub fn set_pivot(&mut self, pivot: DVec3) {
        self.pivot = pivot;
    }

    /// Sets the height of the ground, meters.
    pub fn set_ground(&mut self, ground: f64) {
        self.ground = ground;
    }

    /// Sets the place on a surface under the pointer, scene space. Lines in the view, and lines that leave a surface, continue at its depth.
    pub fn set_hit(&mut self, hit: Option<DVec3>) {
        self.hit = hit;
        self.pivot = hit.unwrap_or(self.pivot);
    }

    /// Returns whether lines follow surfaces.
    pub fn follows_surfaces(&self) -> bool {
        matches!(self.surface(), LineSurface::Surface | LineSurface::Bone)
    }

    /// Returns whether a line is being drawn.
    pub fn is_drawing(&self) -> bool {
        !matches!(self.phase, LinePhase::Idle | LinePhase::Erase)
    }

    /// Returns the next outcome since the last call.
    pub fn take_answer(&mut self) -> Option<LineAnswer> {
        self.answer.take()
    }

    /// Returns whether what is under the pointer is erased.
    pub fn is_erasing(&self) -> bool {
        self.phase == LinePhase::Erase
    }

    /// Adds the line as it is drawn so far to `out`, scene space.
    pub fn add_draft(&self, out: &mut Vec<DVec3>) {
        match &self.phase {
            LinePhase::Idle | LinePhase::Pressed { .. } | LinePhase::Erase => {}
            LinePhase::Freehand(points) => out.extend(points),
            LinePhase::Straight(ends) => out.extend(ends),
            LinePhase::Corners { corners, next, .. } => {
                out.extend(corners);
                out.push(*next);
            }
        }
    }

    /// Returns length and direction of what is drawn; `None` while nothing is.
    pub fn measure(&self) -> Option<StrokeMeasure> {
        match &self.phase {
            LinePhase::Idle | LinePhase::Pressed { .. } | LinePhase::Erase => None,
            LinePhase::Freehand(points) => Some(StrokeMeasure::of_length(points)),
            LinePhase::Straight([from, to]) => Some(StrokeMeasure::straight(*from, *to, &self.plane()?)),
            LinePhase::Corners { corners, next, .. } => {
                let whole = StrokeMeasure::of_length(corners);
                let last = StrokeMeasure::straight(*corners.last()?, *next, &self.plane()?);
                Some(StrokeMeasure { length: whole.length + last.length, ..last })
            }
        }
    }

    /// Returns on what a press at this position would draw, points from the top left of the window, if it is not there; `None` where a line can be
    /// drawn, and where a press does something else.
    pub fn missing_at(&self, at: Vec2, modifiers: Modifiers) -> Option<LineSurface> {
        let erases = self.is_erasing() || (modifiers.ctrl && self.use_of == Some(LineUse::Note));
        let draws = self.is_drawing() || (self.draws_with(modifiers) && !erases);
        let is_missing = draws && self.view.is_some() && self.place_at(at - self.corner).is_none();
        is_missing.then(|| self.surface())
    }

    fn plane(&self) -> Option<DrawingPlane> {
        Some(DrawingPlane {
            view: self.view?,
            surface: self.surface(),
            pivot: self.pivot,
            ground: self.ground,
        })
    }

    fn place_at(&self, at: Vec2) -> Option<DVec3> {
        let on_surface = self.hit.filter(|_| self.follows_surfaces());
        on_surface.or_else(|| self.plane()?.place_at(at.as_dvec2()))
    }

    /// Ends a line. One without length is none.
    fn finish(&mut self, points: Vec<DVec3>, has_corners: bool) {
        let (Some(plane), Some(use_of)) = (self.plane(), self.use_of) else { return };
        let use_of = if self.is_motion { LineUse::Motion } else { use_of };
        if let Some(stroke) = plane.stroke(points, has_corners) {
            self.answer = Some(LineAnswer::Drawn(use_of, stroke));
        }
    }

    fn press(&mut self, at: Vec2, modifiers: Modifiers) {
        if let LinePhase::Corners { press, .. } = &mut self.phase {
            *press = Some(at);
            return;
        }
        if modifiers.ctrl && self.use_of == Some(LineUse::Note) {
            (self.phase, self.answer) = (LinePhase::Erase, Some(LineAnswer::EraserDown(at)));
            return;
        }
        self.is_motion = modifiers.alt;
        match self.place_at(at) {
            Some(place) => self.phase = LinePhase::Pressed { at, place },
            None => self.answer = Some(LineAnswer::NoPlace(self.surface())),
        }
    }

    fn moved(&mut self, at: Vec2, modifiers: Modifiers) {
        let place = self.place_at(at);
        match &mut self.phase {
            LinePhase::Idle => {}
            LinePhase::Erase => self.answer = Some(LineAnswer::EraserMoved(at)),
            LinePhase::Pressed { at: from, place: start } => {
                let Some(place) = place.filter(|_| from.distance(at) > THRESHOLD) else { return };
                self.phase = match modifiers.shift {
                    true => LinePhase::Straight([*start, place]),
                    false => LinePhase::Freehand(vec![*start, place]),
                };
            }
            LinePhase::Freehand(points) => {
                if let Some(place) = place.filter(|_| points.len() < MOST_POINTS) {
                    points.push(place);
                }
            }
            LinePhase::Straight(ends) => ends[1] = place.unwrap_or(ends[1]),
            LinePhase::Corners { next, .. } => *next = place.unwrap_or(*next),
        }
    }

    fn release(&mut self, at: Vec2) -> InputFlow {
        let place = self.place_at(at);
        match std::mem::take(&mut self.phase) {
            LinePhase::Idle => return InputFlow::ToParent,
            LinePhase::Pressed { place, .. } => {
                self.phase = LinePhase::Corners { corners: vec![place], next: place, press: None };
            }
            LinePhase::Freehand(points) => self.finish(points, false),
            LinePhase::Straight(ends) => self.finish(ends.to_vec(), true),
            LinePhase::Corners { corners, .. } if self.is_on_last(&corners, at) => {
                if corners.len() > 1 {
                    self.finish(corners, true);
                } else {
                    self.phase = LinePhase::Corners { next: corners[0], corners, press: None };
                }
            }
            LinePhase::Corners { mut corners, next, press } => {
                if press.is_some() {
                    corners.extend(place);
                }
                self.phase = LinePhase::Corners { corners, next, press: None };
            }
            LinePhase::Erase => self.answer = Some(LineAnswer::EraserUp),
        }
        InputFlow::Stop
    }

    /// Returns whether a click is on the last corner, as the second one of a double click is.
    fn is_on_last(&self, corners: &[DVec3], at: Vec2) -> bool {
        let last = self.view.zip(corners.last()).and_then(|(view, last)| view.to_screen(*last));
        last.is_some_and(|last| last.as_vec2().distance(at) <= THRESHOLD)
    }

    /// Returns whether a press draws. With Alt the camera orbits, unless bones are posed.
    fn draws_with(&self, modifiers: Modifiers) -> bool {
        match self.use_of {
            Some(LineUse::Pose | LineUse::Motion) => true,
            Some(LineUse::Note | LineUse::Path) => !modifiers.alt,
            None => false,
        }
    }

    /// Gives up what is drawn; where nothing is, the tool.
    fn give_up(&mut self) -> InputFlow {
        if self.use_of.is_none() {
            return InputFlow::ToParent;
        }
        if std::mem::take(&mut self.phase) == LinePhase::Idle {
            self.use_of = None;
        }
        InputFlow::Stop
    }

    /// Ends a line of corners; `None` where there is none.
    fn end_corners(&mut self) -> Option<()> {
        let LinePhase::Corners { corners, .. } = &mut self.phase else { return None };
        let corners = std::mem::take(corners);
        self.phase = LinePhase::Idle;
        self.finish(corners, true);
        Some(())
    }

    fn take_corner_back(&mut self) -> Option<()> {
        let LinePhase::Corners { corners, .. } = &mut self.phase else { return None };
        corners.pop();
        if corners.is_empty() {
            self.phase = LinePhase::Idle;
        }
        Some(())
    }
}

impl ViewportTool for LineControl {
    fn place(&mut self, corner: Vec2) {
        self.corner = corner;
    }

    fn look(&mut self, view: GizmoView) {
        self.view = Some(view);
    }

    fn take_outcome(&mut self) -> Option<ToolOutcome> {
        self.take_answer().map(ToolOutcome::Line)
    }

    /// Nothing is changed before a line is complete.
    fn is_dragging(&self) -> bool {
        false
    }

    fn is_modal(&self) -> bool {
        matches!(self.phase, LinePhase::Corners { .. })
    }
}

impl BaseControl for LineControl {
    fn is_pos_on(&self, _: Vec2) -> bool {
        self.use_of.is_some()
    }

    fn mouse_move(&mut self, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        self.moved(mouse.at - self.corner, mouse.modifiers);
        if self.phase == LinePhase::Idle { InputFlow::ToParent } else { InputFlow::Stop }
    }

    fn mouse_down(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        match button {
            Button::Left if self.draws_with(mouse.modifiers) => {
                self.press(mouse.at - self.corner, mouse.modifiers);
                InputFlow::Stop
            }
            Button::Right if self.phase != LinePhase::Idle => self.give_up(),
            Button::Left | Button::Middle | Button::Right => InputFlow::ToParent,
        }
    }

    fn mouse_up(&mut self, button: Button, mouse: Mouse, _framework: &mut ControlFramework) -> InputFlow {
        if button == Button::Left { self.release(mouse.at - self.corner) } else { InputFlow::ToParent }
    }

    fn key_down(&mut self, key: Key, _: Modifiers, _: bool, _framework: &mut ControlFramework) -> InputFlow {
        if key == Key::Escape {
            return self.give_up();
        }
        let is_used = (key == Key::Enter && self.end_corners().is_some())
            || (key == Key::Backspace && self.take_corner_back().is_some());
        if is_used { InputFlow::Stop } else { InputFlow::ToParent }
    }

    fn input_lost(&mut self, _framework: &mut ControlFramework) {
        self.phase = LinePhase::Idle;
    }
}
