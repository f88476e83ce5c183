//! As in Maya.

use super::*;

#[rustfmt::skip] // A table is read in columns.
pub(super) const TABLE: Table = &[
    (Id::PlayPause, &[key(ALT, Key::V), key(NONE, Key::Space)]),
    (Id::Start, &[key(ALT.plus(SHIFT), Key::V), key(NONE, Key::Home)]),
    (Id::PreviousFrame, &[key(ALT, Key::Comma), key(NONE, Key::ArrowLeft)]),
    (Id::NextFrame, &[key(ALT, Key::Period), key(NONE, Key::ArrowRight)]),
    (Id::PreviousKey, &[key(NONE, Key::Comma)]),
    (Id::NextKey, &[key(NONE, Key::Period)]),
    (Id::SelectParent, &[key(NONE, Key::ArrowUp), key(NONE, Key::OpenBracket)]),
    (Id::SelectChild, &[key(NONE, Key::ArrowDown), key(NONE, Key::CloseBracket)]),
    (Id::Undo, &[key(CTRL, Key::Z), key(NONE, Key::Z)]),
    (Id::Redo, &[key(CTRL, Key::Y), key(SHIFT, Key::Z), key(CTRL.plus(SHIFT), Key::Z)]),
    (Id::FrameAll, &[key(NONE, Key::A)]),
    (Id::ShadeUnlit, &[key(NONE, Key::Num4)]),
    (Id::ShadeClay, &[key(NONE, Key::Num5)]),
    (Id::ShadeMaterial, &[key(NONE, Key::Num6)]),
    (Id::ToggleProjection, &[]),
];
