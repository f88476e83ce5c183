//! The controls of the viewport and their tree (thesis §3.2.9).
//!
//! ```text
//! root (window, without function)
//!   └ viewport: camera, clicks, boxes       the size of the viewport
//!       ├ shields: toolbars on top           panels take precedence where they are
//!       └ gizmo                             where its handles are; everywhere during its drag
//!           └ path                          the same with its keys, which cover the handles of the gizmo
//!               └ points                    the points of paths of a scene, in the same way
//!                   └ line                  everywhere while lines are drawn
//! ```
//!
//! Inputs arrive as they happen, not once a frame. The owner takes the outcome after each.
//!
//! A new tool that is used with the mouse in the viewport is a file in this folder, with a type that implements
//! [`BaseControl`], [`ViewportTool`], `Clone`, `Debug` and `Default`, and a line in the list `tools!` below. Area, view, focus,
//! cursor, cancelling and edits follow from the list: the tool is shown a [`ToolScene`], and asks for edits with
//! [`ToolOutcome`]. If it is drawn, it also needs an overlay (`editor/picture/src/control`), and if a command starts it, a row
//! in `panels/commands/table/tools.rs`.

mod shield;
pub(super) mod tool;

pub use shield::Shield;
pub use tool::{ToolOutcome, ToolScene, ViewportTool};

use super::area::{Area, ControlId};
use super::base::{BaseControl, ControlLookup};
use super::framework::ControlFramework;
use super::gizmo::GizmoControl;
use super::input::InputEvent;
use super::key::Modifiers;
use super::line::LineControl;
use super::path::PathControl;
use super::path_points::PathPointControl;
use super::viewport::ViewportControl;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::gizmo::GizmoView;
use glam::Vec2;

/// Width of the edge of the viewport that belongs to the panels, points.
const EDGE: f32 = 3.0;

/// The tools in the viewport.
#[derive(Clone, Debug)]
pub struct ViewportTools {
    framework: ControlFramework,
    owner: ToolSet,
    /// Last position of the mouse, points from the top left of the window.
    pointer: Option<Vec2>,
    modifiers: Modifiers,
    revision: u64,
}

/// Declares the controls, [`ToolSet`], from a list of `name: Type` lines.
macro_rules! tools {
    ($($name:ident: $Control:ty,)*) => {
        /// The controls; the framework knows only their areas.
        #[derive(Clone, Debug)]
        struct ToolSet {
            picture: (ControlId, ViewportControl),
            shields: Vec<(ControlId, Shield)>,
            $($name: (ControlId, $Control),)*
        }

        impl ToolSet {
            const COUNT: usize = [$(stringify!($name)),*].len();

            /// Registers the controls. Of equal areas the one registered later is inside.
            fn new(framework: &mut ControlFramework) -> Self {
                let mut register = || framework.register_control(Area::default());
                Self {
                    picture: (register(), ViewportControl::default()),
                    shields: Vec::new(),
                    $($name: (register(), <$Control>::default()),)*
                }
            }

            /// Returns all tools in the order of the list.
            fn tools(&self) -> [(ControlId, &dyn ViewportTool); Self::COUNT] {
                [$((self.$name.0, &self.$name.1),)*]
            }

            /// Returns all tools in the order of the list, to be changed.
            fn tools_mut(&mut self) -> [(ControlId, &mut dyn ViewportTool); Self::COUNT] {
                [$((self.$name.0, &mut self.$name.1),)*]
            }
        }
    };
}

// A tool is inside those before it: where both are under the pointer, the later one gets the press.
tools! {
    gizmo: GizmoControl,
    path: PathControl,
    points: PathPointControl,
    line: LineControl,
}

impl ControlLookup for ToolSet {
    fn control(&mut self, id: ControlId) -> Option<&mut dyn BaseControl> {
        if id == self.picture.0 {
            return Some(&mut self.picture.1);
        }
        // An armed selection begins on anything.
        let armed = self.picture.1.armed().is_some();
        if self.tools().iter().any(|tool| tool.0 == id) {
            let tool = self.tools_mut().into_iter().find(|tool| tool.0 == id).filter(|_| !armed);
            return tool.map(|(_, tool)| tool as &mut dyn BaseControl);
        }
        self.shields.iter_mut().find(|shield| shield.0 == id).map(|shield| &mut shield.1 as _)
    }
}

impl Default for ViewportTools {
    fn default() -> Self {
        let mut framework = ControlFramework::new(Vec2::ONE);
        let owner = ToolSet::new(&mut framework);
        Self { framework, owner, pointer: None, modifiers: Modifiers::default(), revision: 0 }
    }
}

impl ViewportTools {
    /// Returns the control of the viewport itself.
    pub fn picture(&self) -> &ViewportControl {
        &self.owner.picture.1
    }

    /// Returns the control of the viewport itself, to be changed.
    pub fn picture_mut(&mut self) -> &mut ViewportControl {
        &mut self.owner.picture.1
    }

    /// Returns the gizmo.
    pub fn gizmo(&self) -> &GizmoControl {
        &self.owner.gizmo.1
    }

    /// Returns the gizmo, to be changed.
    pub fn gizmo_mut(&mut self) -> &mut GizmoControl {
        &mut self.owner.gizmo.1
    }

    /// Returns the keys of the motion path.
    pub fn path(&self) -> &PathControl {
        &self.owner.path.1
    }

    /// Returns the keys of the motion path, to be changed.
    pub fn path_mut(&mut self) -> &mut PathControl {
        &mut self.owner.path.1
    }

    /// Returns the points of paths and lines of a scene.
    pub fn points(&self) -> &PathPointControl {
        &self.owner.points.1
    }

    /// Returns the points of paths and lines of a scene, to be changed.
    pub fn points_mut(&mut self) -> &mut PathPointControl {
        &mut self.owner.points.1
    }

    /// Returns the tool that draws lines.
    pub fn line(&self) -> &LineControl {
        &self.owner.line.1
    }

    /// Returns the tool that draws lines, to be changed.
    pub fn line_mut(&mut self) -> &mut LineControl {
        &mut self.owner.line.1
    }

    /// Sets the area of the viewport and of what covers it, points from the top left of the window. Where one of the shields covers all of
    /// it, its tools have no area. Allocates only when more covers it than before.
    pub fn place(&mut self, picture: Area, shields: impl Iterator<Item = Area> + Clone) {
        let Self { framework, owner, .. } = self;
        framework.resize(picture.max);
        let is_covered = shields.clone().any(|shield| shield.contains(&picture));
        // The edge is for resizing the panels.
        let inside = match is_covered {
            true => Area::default(),
            false => Area::new(picture.min + EDGE, picture.max - EDGE),
        };
        if framework.area(owner.picture.0) != Some(inside) {
            framework.move_control(owner.picture.0, inside);
            for (id, _) in owner.tools() {
                framework.move_control(id, inside);
            }
        }
        let mut count = 0;
        for area in shields {
            match owner.shields.get(count) {
                Some((id, _)) => {
                    if framework.area(*id) != Some(area) {
                        framework.move_control(*id, area);
                    }
                }
                None => owner.shields.push((framework.register_control(area), Shield)),
            }
            count += 1;
        }
        for (id, _) in owner.shields.drain(count..) {
            framework.unregister_control(id);
        }
        let size = picture.max - picture.min;
        (owner.picture.1.corner, owner.picture.1.size) = (picture.min, size);
        for (_, tool) in owner.tools_mut() {
            tool.place(picture.min);
        }
    }

    /// Sets the camera.
    pub fn look(&mut self, camera: &Camera) {
        let picture = &mut self.owner.picture.1;
        picture.camera = *camera;
        let view = GizmoView::new(camera, picture.size);
        for (_, tool) in self.owner.tools_mut() {
            tool.look(view);
        }
    }

    /// Shows all tools what they work on.
    pub fn show(&mut self, scene: &ToolScene<'_>) {
        for (_, tool) in self.owner.tools_mut() {
            tool.show(scene);
        }
    }

    /// Returns the next request of a tool since the last call.
    pub fn take_outcome(&mut self) -> Option<ToolOutcome> {
        self.owner.tools_mut().into_iter().find_map(|(_, tool)| tool.take_outcome())
    }

    /// Returns a number that grows with every input, after which a drag may look different.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Routes an input to its control. Returns whether one of them stopped it.
    pub fn input(&mut self, event: InputEvent) -> bool {
        self.revision += 1;
        match event {
            InputEvent::MouseMove(at) if at.is_finite() => self.pointer = Some(at),
            InputEvent::MouseGone => self.pointer = None,
            InputEvent::Modifiers(modifiers) => self.modifiers = modifiers,
            InputEvent::Lost => (self.pointer, self.modifiers) = (None, Modifiers::default()),
            _ => {}
        }
        self.framework.resolve_input(event, &mut self.owner).is_some()
    }

    /// Notifies the controls of mouse and focus after they were moved without an input.
    pub fn update(&mut self) {
        self.framework.update(&mut self.owner);
    }

    /// Begins a drag of the gizmo by a key, at the position of the mouse. Returns false if there is nothing to drag.
    pub fn begin_by_key(&mut self) -> bool {
        let (id, gizmo) = &mut self.owner.gizmo;
        let middle = self.owner.picture.1.corner + self.owner.picture.1.size / 2.0;
        gizmo.begin_by_key(*id, self.pointer.unwrap_or(middle), &mut self.framework)
    }

    /// Cancels what is being dragged, for example because the model is closed.
    pub fn cancel(&mut self) {
        self.framework.resolve_input(InputEvent::Lost, &mut self.owner);
        self.owner.gizmo.1.cancel(&mut self.framework);
    }

    /// Whether a control has mouse and keyboard, because a button is held or a key began a drag.
    pub fn is_busy(&self) -> bool {
        self.framework.captured().is_some()
    }

    /// Whether a control has mouse and keyboard although no button is held.
    pub fn is_modal(&self) -> bool {
        self.owner.tools().iter().any(|(_, tool)| tool.is_modal()) || self.owner.picture.1.armed().is_some()
    }

    /// Whether a pose is being changed.
    pub fn edits(&self) -> bool {
        self.owner.tools().iter().any(|(_, tool)| tool.is_dragging())
    }

    /// Whether the mouse is over the viewport itself, and over nothing that can be dragged.
    pub fn over_ground(&self) -> bool {
        self.framework.hovered() == Some(self.owner.picture.0)
    }

    /// Whether the mouse is over a handle.
    pub fn over_handle(&self) -> bool {
        let hovered = self.framework.hovered();
        self.owner.tools().iter().any(|(id, _)| hovered == Some(*id))
    }

    /// Returns the position of the mouse, points from the top left of the window; `None` outside it.
    pub fn pointer(&self) -> Option<Vec2> {
        self.pointer
    }

    /// Returns the modifier keys.
    pub fn modifiers(&self) -> Modifiers {
        self.modifiers
    }
}
