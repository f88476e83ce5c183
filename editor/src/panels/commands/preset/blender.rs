//! As in Blender's pose mode and dope sheet.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const TABLE: Table = &[
    (Id::Start, &[key(SHIFT, Key::ArrowLeft)]),
    (Id::End, &[key(SHIFT, Key::ArrowRight)]),
    (Id::PreviousKey, &[key(NONE, Key::ArrowDown)]),
    (Id::NextKey, &[key(NONE, Key::ArrowUp)]),
    (Id::PlayBackwards, &[key(SHIFT.plus(CTRL), Key::Space)]),
    (Id::FrameAll, &[key(NONE, Key::Home)]),
    (Id::FrameSelected, &[key(NONE, Key::Period)]),
    (Id::ToggleXRay, &[key(ALT, Key::Z)]),
    (Id::Palette, &[key(NONE, Key::F3), key(CTRL, Key::P)]),
];
