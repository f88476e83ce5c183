//! Tools of the viewport.

use super::*;
use crate::control::Catch;
use crate::control::line::{LineSurface, LineUse};
use crate::panels::actions::{motion_stroke, pose_line, scene_lines, tools};
use dragonfly_picture::gizmo::GizmoSpace;
use dragonfly_picture::gizmo::Pivot;
use dragonfly_picture::gizmo::Tool;

commands! {
    ToolSelect => When::Always, "Select", [key(NONE, Key::Q)], "Selects bones, without a gizmo", |w| { tools::choose(w, None); None };
    ToolMove => When::Always, "Move", [key(NONE, Key::W)], "Shows the gizmo that moves the selected bones", |w| { tools::choose(w, Some(Tool::Move)); None };
    ToolRotate => When::Always, "Rotate", [key(NONE, Key::E)], "Shows the gizmo that rotates the selected bones", |w| { tools::choose(w, Some(Tool::Rotate)); None };
    ToolScale => When::Always, "Scale", [key(NONE, Key::R)], "Shows the gizmo that scales the selected bones", |w| { tools::choose(w, Some(Tool::Scale)); None };
    ToolLine => When::Scene, "Draw lines", [key(NONE, Key::D)], "Draws lines of the project: drag freehand, with Shift straight; click corners and end with Enter; Ctrl erases", |w| { scene_lines::choose(w, LineUse::Note); None };
    ToolPath => When::Scene, "Draw a path", [key(SHIFT, Key::N)], "Draws a path on the ground that roles can follow: drag freehand, with Shift straight; click corners and end with Enter", |w| { scene_lines::choose(w, LineUse::Path); None };
    MotionStroke => When::BoneInTake, "Draw a motion path", [], "Lets the selected bone, or the end of the selected chain, follow a stroke in the view at the selected keys, or over the play range; its timing stays", |w| { motion_stroke::choose(w); None };
    PoseLine => When::BoneInTake, "Draw a pose line", [], "Lays the selected chain of bones along a stroke in the view, its line of action; with Alt the stroke is the path of its end over time. While a model is open, the keys of \"Draw lines\" begin it, too", |w| { pose_line::choose(w); None };
    LinesOnGround => When::Scene, "Draw on the ground", [], "Draws lines on the ground", |w| { w.tools.controls_mut().line_mut().set_surface(LineSurface::Ground); None };
    LinesInView => When::Scene, "Draw in the view", [], "Draws lines in a plane that faces you, at the depth of what is under the pointer at the start, or of the point that the camera looks at", |w| { w.tools.controls_mut().line_mut().set_surface(LineSurface::View); None };
    LinesOnSurface => When::Scene, "Draw on surfaces", [], "Draws lines on what is under the pointer, in its pose at the playhead; beside it they go on at the same depth", |w| { w.tools.controls_mut().line_mut().set_surface(LineSurface::Surface); None };
    LinesOnBone => When::Scene, "Draw on bones", [], "Draws lines on what is under the pointer, which move with the bone or thing at their start", |w| { w.tools.controls_mut().line_mut().set_surface(LineSurface::Bone); None };
    ToggleLinesFrom => When::Always, "New lines from the playhead on", [], "Shows lines that are drawn from the playhead on, up to the next one that is drawn later; otherwise always", |w| { w.settings.tools.lines_from_playhead ^= true; None };
    MoveNow => When::Movable, "Move with the mouse", [], "Moves the selection with the mouse: X, Y, Z constrain, digits enter the amount, Enter confirms", |w| { tools::drag_now(w, Tool::Move); None };
    RotateNow => When::Movable, "Rotate with the mouse", [], "Rotates the selection with the mouse: X, Y, Z constrain, digits enter the amount, Enter confirms", |w| { tools::drag_now(w, Tool::Rotate); None };
    ScaleNow => When::Movable, "Scale with the mouse", [], "Scales the selection with the mouse: X, Y, Z constrain, digits enter the amount, Enter confirms", |w| { tools::drag_now(w, Tool::Scale); None };
    NextSpace => When::Always, "Next gizmo axes", [key(NONE, Key::T)], "Switches the gizmo between local, parent, world and view axes", |w| { tools::next_space(w); None };
    SpaceLocal => When::Always, "Local axes", [], "Aligns the gizmo with the bone", |w| { w.settings.tools.space = GizmoSpace::Local; None };
    SpaceParent => When::Always, "Parent axes", [], "Aligns the gizmo with the bone's parent", |w| { w.settings.tools.space = GizmoSpace::Parent; None };
    SpaceWorld => When::Always, "World axes", [], "Aligns the gizmo with the scene", |w| { w.settings.tools.space = GizmoSpace::World; None };
    SpaceView => When::Always, "View axes", [], "Aligns the gizmo with the view", |w| { w.settings.tools.space = GizmoSpace::View; None };
    PivotIndividual => When::Always, "Pivot at individual joints", [], "Rotates and scales each bone about its own joint", |w| { w.settings.tools.pivot = Pivot::Individual; None };
    PivotMedian => When::Always, "Pivot at median point", [], "Rotates and scales the selection about the mean of its joints", |w| { w.settings.tools.pivot = Pivot::Median; None };
    PivotActive => When::Always, "Pivot at active bone", [], "Rotates and scales the selection about the joint of the active bone", |w| { w.settings.tools.pivot = Pivot::Active; None };
    ToggleCurl => When::Always, "Curl chains", [], "Rotates every bone of a selected chain by the full angle, as when a finger curls", |w| { w.settings.tools.curl ^= true; None };
    BoxSelect => When::Model, "Box select", [key(SHIFT, Key::B)], "Selects by dragging a box", |w| { tools::arm(w, Catch::Box); None };
    LassoSelect => When::Model, "Lasso select", [key(SHIFT, Key::L)], "Selects by drawing a lasso", |w| { tools::arm(w, Catch::Lasso); None };
    ToggleGhosts => When::Always, "Ghosts", [key(SHIFT, Key::G)], "Shows ghosts (onion skin) of the frames before and after", |w| { w.settings.tools.ghosts.shown ^= true; None };
    TogglePath => When::Always, "Motion path", [key(SHIFT, Key::P)], "Shows the path of the selected bone, with keys that can be dragged", |w| { w.settings.tools.path ^= true; None };
}
