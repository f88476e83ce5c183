//! The keys of a motion path as a control of the scene: each can be dragged.

use super::key::Modifiers;
use super::path_point::PathKey;
use super::point_drag::{PointControl, PointSet};
use super::viewport_tools::tool::ToolOutcome;
use dragonfly_picture::gizmo::{AXIS_FROM, GizmoView};
use glam::{DVec2, DVec3};

/// Distance within which a key is under the pointer, points.
const REACH: f64 = 7.0;

/// The keys on the path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathKeys {
    keys: Vec<PathKey>,
    /// Whether keys can be changed.
    editable: bool,
    /// Pivot of the gizmo, scene space. Handles are long and keys are small, so a key wins over a handle everywhere
    /// except at the center of the gizmo: if the joint does not move, all of its keys are there.
    gizmo: Option<DVec3>,
}

/// The control of the keys on the path.
pub type PathControl = PointControl<PathKeys>;

impl PathControl {
    /// Sets the keys. A drag in progress keeps the key that it drags.
    pub fn show_keys(&mut self, keys: &[PathKey]) {
        self.replace(|set| {
            set.keys.clear();
            set.keys.extend_from_slice(keys);
        });
    }

    /// Sets whether keys can be changed, and the pivot of the gizmo, scene space.
    pub fn set_editable(&mut self, editable: bool, gizmo: Option<DVec3>) {
        let set = self.set_mut();
        (set.editable, set.gizmo) = (editable, gizmo);
    }

    /// Returns whether keys can be changed.
    pub fn is_editable(&self) -> bool {
        self.set().editable
    }

    /// Returns the time of the key that is dragged or under the pointer.
    pub fn hovered(&self) -> Option<f32> {
        let under = || self.under_pointer().and_then(|key| self.set().point(key));
        self.dragged().or_else(under).map(|key| key.time)
    }
}

impl PointSet for PathKeys {
    type Point = PathKey;

    fn point_at(&self, view: &GizmoView, at: DVec2) -> Option<usize> {
        if !self.editable {
            return None;
        }
        let middle = self.gizmo.and_then(|pivot| view.to_screen(pivot));
        let distance = |key: &PathKey| {
            let place = view.to_screen(key.place.as_dvec3())?;
            let is_free = middle.is_none_or(|middle| middle.distance(place) > AXIS_FROM);
            is_free.then(|| place.distance(at))
        };
        let near = self.keys.iter().enumerate().filter_map(|(index, key)| Some((distance(key)?, index)));
        let nearest = near.filter(|near| near.0 <= REACH).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, index)| index)
    }

    fn point(&self, index: usize) -> Option<&PathKey> {
        self.keys.get(index)
    }

    /// Puts the key under the pointer, at its distance from the camera.
    fn put(
        &self,
        view: &GizmoView,
        key: &PathKey,
        [from, to]: [DVec2; 2],
        _modifiers: Modifiers,
    ) -> Option<PathKey> {
        let place = key.place.as_dvec3();
        let put = (place + view.move_by(place, to - from)?).as_vec3();
        put.is_finite().then_some(PathKey { place: put, ..*key })
    }

    fn request(key: PathKey) -> ToolOutcome {
        ToolOutcome::MoveKey(key)
    }
}
