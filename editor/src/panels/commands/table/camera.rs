//! From where the picture is seen.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const COMMANDS: &[Command] = &[
    command(Id::FrameSelected, When::Model, "Frame selected", &[key(NONE, Key::F)], "Moves the eye to what is selected"),
    command(Id::FrameAll, When::Model, "Frame all", &[key(SHIFT, Key::F)], "Moves the eye so that everything is seen"),
    command(Id::ViewFront, When::Model, "Front", &[key(NONE, Key::Num1)], "Looks from the front"),
    command(Id::ViewBack, When::Always, "Back", &[key(CTRL, Key::Num1)], "Looks from behind"),
    command(Id::ViewRight, When::Always, "Right", &[key(NONE, Key::Num3)], "Looks from the right"),
    command(Id::ViewLeft, When::Always, "Left", &[key(CTRL, Key::Num3)], "Looks from the left"),
    command(Id::ViewTop, When::Always, "Top", &[key(NONE, Key::Num7)], "Looks from above"),
    command(Id::ViewBottom, When::Always, "Bottom", &[key(CTRL, Key::Num7)], "Looks from below"),
    command(Id::ToggleProjection, When::Always, "Perspective / parallel", &[key(NONE, Key::Num5)], "Far things smaller, or parallel lines parallel"),
];
