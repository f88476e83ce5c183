//! Places for roles that are added to the scene: next to the other roles at the time shown, and not inside of them.

use super::scene_view::box_of;
use crate::panels::dropped_files::DroppedModel;
use crate::panels::scene::{StandingBoxes, role_place};
use crate::panels::workspace::Workspace;
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::stage::StagePlan;
use glam::DVec3;
use std::sync::Arc;

/// The free places of a scene, while roles are added to it.
pub(super) struct FreePlaces {
    plan: Arc<StagePlan>,
    boxes: StandingBoxes,
    /// Place of the next role on the x axis where nothing is there, meters.
    next: f64,
}

impl FreePlaces {
    /// Returns the free places of the scene; `None` without a plan. Props are left out: roles are in houses and on floors.
    pub(super) fn of(workspace: &mut Workspace) -> Option<Self> {
        let scene = workspace.model.view()?.scene.clone()?;
        let plan = Arc::clone(scene.plan.as_ref()?);
        let next = role_place(scene.script.as_ref()?.tree()) as f64;
        let time = workspace.read().scene_time();
        let shown = workspace.stage.things_at(&plan, time);
        let mut boxes = StandingBoxes::default();
        for (planned, state) in plan.things().iter().zip(&shown.things).filter(|(own, _)| own.kind == "role")
        {
            if let Some(around) = box_of(&scene, planned, &state.transform) {
                boxes.add(around);
            }
        }
        Some(Self { plan, boxes, next })
    }

    /// Returns the place of the next role where the user chose none.
    pub(super) fn next(&self) -> DVec3 {
        DVec3::X * self.next
    }

    /// Returns the free place on the ground that is nearest to `wanted`. It is not free any more.
    pub(super) fn take(&mut self, model: &DroppedModel, wanted: DVec3) -> DVec3 {
        let on_ground =
            |place: DVec3| place.with_y(self.plan.ground_at(place).unwrap_or(self.plan.ground_plane()));
        let scale = model.scale as f32;
        let own = AxisBox { min: model.around.min * scale, max: model.around.max * scale };
        let place = on_ground(self.boxes.free_place(own, on_ground(wanted)));
        let there = place.as_vec3();
        if !own.is_empty() {
            self.boxes.add(AxisBox { min: own.min + there, max: own.max + there });
        }
        self.next += 1.0;
        place
    }
}
