//! Commands about what the mouse does in the picture.

use crate::control::Catch;
use crate::panels::commands::Id;
use crate::panels::state::{Effect, State};
use dragonfly_picture::gizmo::{GizmoSpace, Pivot, Tool};
use std::time::Instant;

impl State {
    /// A command of the tools; nothing for another.
    pub(in crate::panels) fn tool_command(&mut self, id: Id) -> Option<Effect> {
        let hand = &mut self.settings.hand;
        match id {
            Id::ToolSelect => hand.tool = None,
            Id::ToolMove => hand.tool = Some(Tool::Move),
            Id::ToolRotate => hand.tool = Some(Tool::Rotate),
            Id::ToolScale => hand.tool = Some(Tool::Scale),
            Id::MoveNow => self.drag_now(Tool::Move),
            Id::RotateNow => self.drag_now(Tool::Rotate),
            Id::ScaleNow => self.drag_now(Tool::Scale),
            Id::NextSpace => {
                hand.space = match hand.space {
                    GizmoSpace::Local => GizmoSpace::Parent,
                    GizmoSpace::Parent => GizmoSpace::World,
                    GizmoSpace::World => GizmoSpace::View,
                    GizmoSpace::View => GizmoSpace::Local,
                }
            }
            Id::SpaceLocal => hand.space = GizmoSpace::Local,
            Id::SpaceParent => hand.space = GizmoSpace::Parent,
            Id::SpaceWorld => hand.space = GizmoSpace::World,
            Id::SpaceView => hand.space = GizmoSpace::View,
            Id::PivotIndividual => hand.pivot = Pivot::Individual,
            Id::PivotMedian => hand.pivot = Pivot::Median,
            Id::PivotActive => hand.pivot = Pivot::Active,
            Id::ToggleCurl => hand.curl = !hand.curl,
            Id::ToggleGhosts => hand.ghosts.shown = !hand.ghosts.shown,
            Id::TogglePath => hand.path = !hand.path,
            Id::BoxSelect => self.hands.picture_mut().arm(Catch::Box),
            Id::LassoSelect => self.hands.picture_mut().arm(Catch::Lasso),
            _ => {}
        }
        None
    }

    /// Begins to drag from where the mouse is, without a button.
    fn drag_now(&mut self, tool: Tool) {
        if self.hands.is_busy() {
            return;
        }
        self.settings.hand.tool = Some(tool);
        self.stop_at(self.time());
        self.grasp();
        self.hands.look(&self.camera);
        if !self.hands.gizmo().editable {
            self.refused_drag = Some(Instant::now());
            return self.refuse();
        }
        if !self.hands.begin_by_key() {
            let text = "The selected bone lies behind the eye";
            self.status.say(crate::panels::status::Level::Info, text);
        }
        // Nothing is changed before the mouse moves.
        self.hands.gizmo_mut().take_answer();
        if self.hands.edits() {
            self.begin_following();
        }
    }
}
