//! What the mouse does in the picture.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::ToolSelect, When::Always, "Select", &[key(NONE, Key::Q)], "No gizmo: the mouse only selects"),
    command(Id::ToolMove, When::Always, "Move", &[key(NONE, Key::W)], "A gizmo that moves the selected bones"),
    command(Id::ToolRotate, When::Always, "Rotate", &[key(NONE, Key::E)], "A gizmo that turns the selected bones"),
    command(Id::ToolScale, When::Always, "Scale", &[key(NONE, Key::R)], "A gizmo that scales the selected bones"),
    command(Id::MoveNow, When::BoneInTake, "Move now", &[], "Moves with the mouse at once: X, Y, Z bind, digits type, Enter ends"),
    command(Id::RotateNow, When::BoneInTake, "Rotate now", &[], "Turns with the mouse at once: X, Y, Z bind, digits type, Enter ends"),
    command(Id::ScaleNow, When::BoneInTake, "Scale now", &[], "Scales with the mouse at once: X, Y, Z bind, digits type, Enter ends"),
    command(Id::NextSpace, When::Always, "Next axes", &[key(NONE, Key::T)], "Own axes, the parent's, the world's, the picture's"),
    command(Id::SpaceLocal, When::Always, "Own axes", &[], "The gizmo has the axes of the bone"),
    command(Id::SpaceParent, When::Always, "Parent's axes", &[], "The gizmo has the axes of the bone's parent"),
    command(Id::SpaceWorld, When::Always, "World's axes", &[], "The gizmo has the axes of the scene"),
    command(Id::SpaceView, When::Always, "Picture's axes", &[], "The gizmo has right, up and towards the viewer"),
    command(Id::PivotIndividual, When::Always, "Each about its own joint", &[], "Several bones turn and grow where they are"),
    command(Id::PivotMedian, When::Always, "All about their middle", &[], "Several bones turn and grow about the mean of their joints"),
    command(Id::PivotActive, When::Always, "All about the active bone", &[], "Several bones turn and grow about the joint of the one selected last"),
    command(Id::ToggleCurl, When::Always, "Curl chains", &[], "Every bone of a selected chain turns by the whole amount, as a finger does"),
    command(Id::BoxSelect, When::Model, "Select in a box", &[key(SHIFT, Key::B)], "The next drag draws a box, wherever it begins"),
    command(Id::LassoSelect, When::Model, "Select in a lasso", &[key(SHIFT, Key::L)], "The next drag draws a line around what is meant"),
    command(Id::ToggleGhosts, When::Always, "Ghosts", &[key(SHIFT, Key::G)], "Shows the skeleton some frames before and after"),
    command(Id::TogglePath, When::Always, "Motion path", &[key(SHIFT, Key::P)], "Shows where the selected bone moves along; its keys can be dragged"),
];
