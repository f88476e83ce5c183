//! Tools of the viewport.

use super::*;
use crate::control::Catch;
use crate::panels::actions::tools;
use dragonfly_picture::gizmo::GizmoSpace;
use dragonfly_picture::gizmo::Pivot;
use dragonfly_picture::gizmo::Tool;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ToolSelect, When::Always, "Select", &[key(NONE, Key::Q)], "No gizmo: the mouse only selects", |w| { w.settings.tools.tool = None; None }),
    command(Id::ToolMove, When::Always, "Move", &[key(NONE, Key::W)], "A gizmo that moves the selected bones", |w| { w.settings.tools.tool = Some(Tool::Move); None }),
    command(Id::ToolRotate, When::Always, "Rotate", &[key(NONE, Key::E)], "A gizmo that rotates the selected bones", |w| { w.settings.tools.tool = Some(Tool::Rotate); None }),
    command(Id::ToolScale, When::Always, "Scale", &[key(NONE, Key::R)], "A gizmo that scales the selected bones", |w| { w.settings.tools.tool = Some(Tool::Scale); None }),
    command(Id::MoveNow, When::BoneInTake, "Move now", &[], "Moves with the mouse at once: X, Y, Z bind, digits type, Enter ends", |w| { tools::drag_now(w, Tool::Move); None }),
    command(Id::RotateNow, When::BoneInTake, "Rotate now", &[], "Turns with the mouse at once: X, Y, Z bind, digits type, Enter ends", |w| { tools::drag_now(w, Tool::Rotate); None }),
    command(Id::ScaleNow, When::BoneInTake, "Scale now", &[], "Scales with the mouse at once: X, Y, Z bind, digits type, Enter ends", |w| { tools::drag_now(w, Tool::Scale); None }),
    command(Id::NextSpace, When::Always, "Next axes", &[key(NONE, Key::T)], "Own axes, the parent's, the world's, the picture's", |w| { tools::next_space(w); None }),
    command(Id::SpaceLocal, When::Always, "Own axes", &[], "The gizmo has the axes of the bone", |w| { w.settings.tools.space = GizmoSpace::Local; None }),
    command(Id::SpaceParent, When::Always, "Parent's axes", &[], "The gizmo has the axes of the bone's parent", |w| { w.settings.tools.space = GizmoSpace::Parent; None }),
    command(Id::SpaceWorld, When::Always, "World's axes", &[], "The gizmo has the axes of the scene", |w| { w.settings.tools.space = GizmoSpace::World; None }),
    command(Id::SpaceView, When::Always, "Picture's axes", &[], "The gizmo has right, up and towards the viewer", |w| { w.settings.tools.space = GizmoSpace::View; None }),
    command(Id::PivotIndividual, When::Always, "Each about its own joint", &[], "Several bones turn and grow where they are", |w| { w.settings.tools.pivot = Pivot::Individual; None }),
    command(Id::PivotMedian, When::Always, "All about their middle", &[], "Several bones turn and grow about the mean of their joints", |w| { w.settings.tools.pivot = Pivot::Median; None }),
    command(Id::PivotActive, When::Always, "All about the active bone", &[], "Several bones turn and grow about the joint of the one selected last", |w| { w.settings.tools.pivot = Pivot::Active; None }),
    command(Id::ToggleCurl, When::Always, "Curl chains", &[], "Every bone of a selected chain turns by the whole amount, as a finger does", |w| { w.settings.tools.curl ^= true; None }),
    command(Id::BoxSelect, When::Model, "Select in a box", &[key(SHIFT, Key::B)], "The next drag draws a box, wherever it begins", |w| { tools::arm(w, Catch::Box); None }),
    command(Id::LassoSelect, When::Model, "Select in a lasso", &[key(SHIFT, Key::L)], "The next drag draws a line around what is meant", |w| { tools::arm(w, Catch::Lasso); None }),
    command(Id::ToggleGhosts, When::Always, "Ghosts", &[key(SHIFT, Key::G)], "Shows the skeleton some frames before and after", |w| { w.settings.tools.ghosts.shown ^= true; None }),
    command(Id::TogglePath, When::Always, "Motion path", &[key(SHIFT, Key::P)], "Shows where the selected bone moves along; its keys can be dragged", |w| { w.settings.tools.path ^= true; None }),
];
