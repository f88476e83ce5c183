//! As in Godot and Unity: where the two differ, the one whose key is not used otherwise.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const TABLE: Table = &[
    (Id::FrameSelected, &[key(NONE, Key::F)]),
    (Id::PreviousFrame, &[key(NONE, Key::Comma), key(NONE, Key::ArrowLeft)]),
    (Id::NextFrame, &[key(NONE, Key::Period), key(NONE, Key::ArrowRight)]),
    (Id::PreviousKey, &[key(ALT, Key::Comma)]),
    (Id::NextKey, &[key(ALT, Key::Period)]),
    (Id::Palette, &[key(CTRL, Key::K), key(CTRL.plus(SHIFT), Key::P), key(NONE, Key::F3), key(CTRL, Key::P)]),
];
