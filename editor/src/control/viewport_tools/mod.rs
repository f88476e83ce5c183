//! The controls of the scene and their tree: the picture, what lies over it, the gizmo (thesis §3.2.9).
//!
//! ```text
//! root (window, without function)
//!   └ picture: camera, clicks, boxes       the size of the viewport
//!       ├ shields: tools over the picture   panels take precedence where they are
//!       └ gizmo                             where its handles are; everywhere while it drags
//!           └ path                          the same with its keys, which lie over the gizmo's handles
//! ```
//!
//! Inputs come in as they happen, not once a frame. What follows is taken out by the owner after each.

mod shield;

pub use shield::Shield;

use super::base::{Area, BaseControl, ControlId, Controls};
use super::framework::ControlFramework;
use super::gizmo::GizmoControl;
use super::input::InputEvent;
use super::key::Modifiers;
use super::path::PathControl;
use super::viewport::ViewportControl;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::gizmo::GizmoView;
use glam::Vec2;

/// How much of the picture's edge is not its own, points.
const EDGE: f32 = 3.0;

/// What a person acts on the picture with.
#[derive(Clone, Debug)]
pub struct ViewportTools {
    framework: ControlFramework,
    owner: Owner,
    /// Where the mouse was last, points from the top left of the window.
    pointer: Option<Vec2>,
    modifiers: Modifiers,
    revision: u64,
}

/// Who has the controls, beside the framework that knows their places.
#[derive(Clone, Debug)]
struct Owner {
    picture: (ControlId, ViewportControl),
    path: (ControlId, PathControl),
    gizmo: (ControlId, GizmoControl),
    shields: Vec<(ControlId, Shield)>,
}

impl Controls for Owner {
    fn control(&mut self, id: ControlId) -> Option<&mut dyn BaseControl> {
        if id == self.picture.0 {
            return Some(&mut self.picture.1);
        }
        // What was armed meets everything there is.
        let armed = self.picture.1.armed().is_some();
        if id == self.gizmo.0 {
            return (!armed).then_some(&mut self.gizmo.1 as _);
        }
        if id == self.path.0 {
            return (!armed).then_some(&mut self.path.1 as _);
        }
        self.shields.iter_mut().find(|shield| shield.0 == id).map(|shield| &mut shield.1 as _)
    }
}

impl Default for ViewportTools {
    fn default() -> Self {
        let mut framework = ControlFramework::new(Vec2::ONE);
        let nowhere = Area::default();
        // Of areas that are as large the one registered later lies inside.
        let picture = (framework.register_control(nowhere), ViewportControl::default());
        let gizmo = (framework.register_control(nowhere), GizmoControl::default());
        let path = (framework.register_control(nowhere), PathControl::default());
        Self {
            framework,
            owner: Owner { picture, path, gizmo, shields: Vec::new() },
            pointer: None,
            modifiers: Modifiers::default(),
            revision: 0,
        }
    }
}

impl ViewportTools {
    /// The picture's own control.
    pub fn picture(&self) -> &ViewportControl {
        &self.owner.picture.1
    }

    /// The picture's own control.
    pub fn picture_mut(&mut self) -> &mut ViewportControl {
        &mut self.owner.picture.1
    }

    /// The gizmo.
    pub fn gizmo(&self) -> &GizmoControl {
        &self.owner.gizmo.1
    }

    /// The gizmo.
    pub fn gizmo_mut(&mut self) -> &mut GizmoControl {
        &mut self.owner.gizmo.1
    }

    /// The keys of the motion path.
    pub fn path(&self) -> &PathControl {
        &self.owner.path.1
    }

    /// The keys of the motion path.
    pub fn path_mut(&mut self) -> &mut PathControl {
        &mut self.owner.path.1
    }

    /// Where the picture is, and what lies over it; points from the top left of the window. Allocates only when there is
    /// more over the picture than before.
    pub fn place(&mut self, picture: Area, shields: impl Iterator<Item = Area>) {
        let Self { framework, owner, .. } = self;
        framework.resize(picture.max);
        // The edge belongs to who makes panels larger.
        let inside = Area::new(picture.min + EDGE, picture.max - EDGE);
        if framework.area(owner.picture.0) != Some(inside) {
            for id in [owner.picture.0, owner.gizmo.0, owner.path.0] {
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
        owner.gizmo.1.corner = picture.min;
        owner.path.1.corner = picture.min;
    }

    /// From where the picture is seen.
    pub fn look(&mut self, camera: &Camera) {
        let picture = &mut self.owner.picture.1;
        picture.camera = *camera;
        let view = GizmoView::new(camera, picture.size);
        self.owner.gizmo.1.gizmo.look(view);
        self.owner.path.1.look(view);
    }

    /// Grows with every input: what is drawn of a drag may be another.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Gives an input to the control that it is for. Tells whether one of them took it.
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

    /// Tells the controls who has the mouse now, after they changed without an input.
    pub fn update(&mut self) {
        self.framework.update(&mut self.owner);
    }

    /// Begins a drag of the gizmo by a key, from where the mouse is. `false` where there is nothing to drag.
    pub fn begin_by_key(&mut self) -> bool {
        let (id, gizmo) = &mut self.owner.gizmo;
        let middle = self.owner.picture.1.corner + self.owner.picture.1.size / 2.0;
        gizmo.begin_by_key(*id, self.pointer.unwrap_or(middle), &mut self.framework)
    }

    /// Takes back what is being dragged, as when the model goes away.
    pub fn cancel(&mut self) {
        self.framework.resolve_input(InputEvent::Lost, &mut self.owner);
        self.owner.gizmo.1.cancel(&mut self.framework);
    }

    /// Has a control mouse and keyboard, because a button is held or a key began something?
    pub fn is_busy(&self) -> bool {
        self.framework.captured().is_some()
    }

    /// Has a control mouse and keyboard though no button is held?
    pub fn is_modal(&self) -> bool {
        self.owner.gizmo.1.is_modal() || self.owner.picture.1.armed().is_some()
    }

    /// Is a pose being changed?
    pub fn edits(&self) -> bool {
        self.owner.gizmo.1.gizmo.is_dragging() || self.owner.path.1.is_dragging()
    }

    /// Is the mouse over the picture itself, and over nothing that can be taken hold of?
    pub fn over_ground(&self) -> bool {
        self.framework.hovered() == Some(self.owner.picture.0)
    }

    /// Is the mouse over a handle?
    pub fn over_handle(&self) -> bool {
        let hovered = self.framework.hovered();
        hovered == Some(self.owner.gizmo.0) || hovered == Some(self.owner.path.0)
    }

    /// Where the mouse is, points from the top left of the window; `None` outside of it.
    pub fn pointer(&self) -> Option<Vec2> {
        self.pointer
    }

    /// What is held besides.
    pub fn modifiers(&self) -> Modifiers {
        self.modifiers
    }
}
